//! Writes to standard output. The program that reads it may stop early, as `head` does.

use std::{
    fmt,
    io::{self, Write},
};

/// Standard output could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write to standard output: {0}")]
pub struct OutputError(io::Error);

/// True if nobody reads the output any more. This is no failure, but there is nothing left to do.
pub fn is_closed(error: &anyhow::Error) -> bool {
    let output = error.chain().find_map(|cause| cause.downcast_ref());
    matches!(output, Some(OutputError(cause)) if cause.kind() == io::ErrorKind::BrokenPipe)
}

/// Writes to standard output; [`say!`] and [`begin!`] call it.
pub fn write(text: fmt::Arguments<'_>) -> Result<(), OutputError> {
    let mut output = io::stdout().lock();
    let written = output.write_fmt(text).and_then(|()| output.flush());
    written.map_err(OutputError)
}

/// Clears the terminal and moves the cursor to its first place.
pub fn clear() -> Result<(), OutputError> {
    // A console of Windows takes control sequences only when told to; other systems have nothing to do here.
    anstyle_query::windows::enable_ansi_colors();
    write(format_args!("\x1b[2J\x1b[H"))
}

/// Prints like `println!`, but returns an error.
macro_rules! say {
    ($($text:tt)*) => {
        $crate::command::output::write(format_args!("{}\n", format_args!($($text)*)))
    };
}

/// Prints like `say!`, without the end of the line.
macro_rules! begin {
    ($($text:tt)*) => {
        $crate::command::output::write(format_args!($($text)*))
    };
}

pub(crate) use {begin, say};
