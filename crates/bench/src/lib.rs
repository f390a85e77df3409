//! Measures what the firmware costs: instructions, time and memory of the shipped image on the emulated board. It also
//! compares the attitude filter with others, on the same processor and the same motion.
//!
//! `program` runs one filter and counts its instructions. `motion` makes its input, and `measure` runs it over one
//! motion. `scenarios` runs the image. `work` does all of this on every core, and `report` compares the figures with
//! their limits.

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
