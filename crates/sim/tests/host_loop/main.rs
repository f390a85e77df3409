//! The image does what the app does on the host: in each tick bit for bit where the inputs are the same, and over a whole run of
//! a balancing robot within tolerances, as the image reads its sensors and its radio at other instants than the host loop.

#[expect(dead_code, reason = "the machine is run tick by tick here")]
#[path = "../support/mod.rs"]
mod support;

mod course;
mod image;
mod numbers;
mod ticks;
mod whole_run;
