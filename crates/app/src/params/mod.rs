//! Settings that survive a power cut (ROBOT_CPP 5.2, docs/parameters.md).

mod sector;
mod slot;
mod status;
mod store;

pub use slot::{MAX_VALUES, Record, RecordId};
pub use status::{FlashRequest, ParamError, ParamState, ParamStatus};
pub use store::{MAX_RECORDS, Progress, Store, StoreReport};
