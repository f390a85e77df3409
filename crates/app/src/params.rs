//! The parameter store: settings that survive a power cut (docs/parameters.md).

mod record;
mod save_scheduler;
mod sector;
mod service;
mod slot;
mod store;

pub use service::ParamService;
pub use slot::{MAX_VALUES, Record, RecordId};
pub use store::{MAX_RECORDS, Progress, Store, StoreReport};
