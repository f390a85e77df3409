//! Why the parameters are not kept by sequential-storage 8.0.2: what it loses when the power goes.
//!
//! These tests assert the losses: a version of the crate that makes one of them fail is worth a second look
//! (docs/decisions/parameter-log.md). The robot's own store goes through the same saves and cuts and loses nothing.

mod erase_inside_save;
mod flash;
mod own_store;
mod phantom_record;
mod power_cuts;
mod settings;
mod the_crate;
