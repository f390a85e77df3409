//! What is wrong with a policy's files, and where.

use std::io;

/// Files that describe no policy.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// A file cannot be read.
    #[error("{file}: cannot be read: {error}")]
    Unreadable {
        /// The file.
        file: String,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// A file has not the form that it must have.
    #[error("{file}: {message}")]
    Malformed {
        /// The file.
        file: String,
        /// What is wrong, and the cure.
        message: String,
    },
    /// The value of a key cannot be used.
    #[error("{file}:{line}: {key}: {message}")]
    Key {
        /// The file.
        file: String,
        /// Line of the value, from 1.
        line: u64,
        /// The key.
        key: String,
        /// What is wrong, and the cure.
        message: String,
    },
    /// A key is in none of the files.
    #[error("{files}: {key} is missing: {message}")]
    Missing {
        /// The files.
        files: String,
        /// The key.
        key: String,
        /// What it is, or why it is needed.
        message: String,
    },
}
