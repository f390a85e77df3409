//! Writes to standard output. The program that reads it may stop early, as `head` does, which is an error like others.

/// Prints like `println!`, but returns an error.
macro_rules! say {
    ($($text:tt)*) => {
        $crate::command::output::write(format_args!("{}\n", format_args!($($text)*)))
    };
}

pub(crate) use say;

use std::{
    fmt,
    io::{self, Write},
};

/// Writes to standard output; [`say!`] calls it.
pub fn write(text: fmt::Arguments<'_>) -> io::Result<()> {
    let mut output = io::stdout().lock();
    output.write_fmt(text)?;
    output.flush()
}
