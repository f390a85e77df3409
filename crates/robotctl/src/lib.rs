//! The PC's side of the robot: calibration of its sensors and its tuning channel.
//!
//! | place | does |
//! |---|---|
//! | [`recording`] | files → samples of a sensor |
//! | [`calibration`] | samples → corrections the firmware applies |
//! | [`report`] | a correction → an HTML page |
//! | [`parameter_file`] | parameters by name, in TOML |

pub mod calibration;
pub mod parameter_file;
pub mod recording;
pub mod report;
