//! A signal that the soak needs and cannot find.

/// The image or the world does not show a signal of this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct MissingSignal(pub String);
