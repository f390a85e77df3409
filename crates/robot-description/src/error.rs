//! What is wrong with a file, and where.

use std::{fmt, io};

/// A complaint about one field of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Located {
    /// The file, as it was named by the caller.
    pub file: String,
    /// Line of the field, from 1.
    pub line: usize,
    /// The field, such as `legs.thigh.mass_kg`. It is empty if the text is no TOML.
    pub field: String,
    /// What is wrong, and the cure.
    pub message: String,
}

impl fmt::Display for Located {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            line,
            field,
            message,
        } = self;
        write!(f, "{file}:{line}: ")?;
        if !field.is_empty() {
            write!(f, "{field}: ")?;
        }
        f.write_str(message)
    }
}

/// A robot's file that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RobotError {
    /// The file cannot be read.
    #[error("{file}: cannot be read: {error}")]
    Unreadable {
        /// The file.
        file: String,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// The text is no TOML, lacks a field, has an unknown one, or a value of another type.
    #[error("{0}")]
    Malformed(Located),
    /// The figures are of no robot that could be built or would work.
    #[error("{}", lines(.0))]
    Unsound(Vec<Located>),
}

fn lines(complaints: &[Located]) -> String {
    let lines: Vec<_> = complaints.iter().map(ToString::to_string).collect();
    lines.join("\n")
}
