//! Why the parameters are not kept by sequential-storage 8.0.2: what it loses when the power goes.
//!
//! These tests assert the losses. A version of the crate that makes one of them fail is worth a second look
//! (docs/parameters.md).

mod erase_inside_save;
mod flash;
mod phantom_record;
mod power_cuts;
mod settings;
