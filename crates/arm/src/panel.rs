//! What the screens of `joints` and `cartesian` do with keys, without a terminal.

pub mod cartesian;
pub mod joints;
pub mod key;
