//! Settings that survive a power cut (ROBOT_CPP 5.2, docs/parameters.md).

mod status;

pub use status::{FlashRequest, ParamError, ParamState, ParamStatus};
