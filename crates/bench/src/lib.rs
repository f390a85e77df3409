//! What the firmware costs: instructions, time and memory of the shipped image on the emulated board, and its attitude
//! filter beside others on the same processor and the same motion.
//!
//! `program` runs one filter and counts, `motion` feeds it, `measure` does both for one filter, `scenarios` runs the
//! image, `work` does all of it on every core, `report` holds the figures against their limits.

pub mod filters;
pub mod functions;
pub mod image_size;
pub mod measure;
pub mod motion;
pub mod program;
pub mod report;
pub mod scenarios;
pub mod table;
pub mod work;
