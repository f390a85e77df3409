//! Settings in flash, on the shipped image (docs/parameters.md).

#[path = "../support/mod.rs"]
mod support;

#[path = "../support/flash_image/mod.rs"]
mod flash_image;

mod arming_during_an_erase;
mod at_rest_only;
mod boot_time;
mod cells;
mod damage;
mod foreign_records;
mod power_cuts;
mod refusals;
mod robot;
mod settings;
mod wear;
mod worn_flash;
