//! The PC's tools for the robot: they calibrate its sensors, and tune and watch it over CAN.
//!
//! | place | does |
//! |---|---|
//! | [`recording`] | files → samples of a sensor |
//! | [`calibration`] | samples → corrections the firmware applies |
//! | [`report`] | a correction → an HTML page |
//! | [`mounting`] | a robot tilted by hand → how its sensors sit |
//! | [`radio`] | a transmitter's controls, moved one by one → which channel is which |
//! | [`settings`] | the robot's settings by name, and their values in words |
//! | [`parameter_file`] | parameters by name, in TOML |
//! | [`can_link`] | a CAN bus through an slcan adapter or SocketCAN |
//! | [`tuning`] | the settings of the robot on a bus, and its live values |
//! | [`status`] | live values → words and JSON |
//! | [`recorder`] | samples of the robot on a bus → a table |
//! | [`first_board`] | the checks of a first board, and their report |

pub mod calibration;
pub mod can_link;
pub mod first_board;
pub mod mounting;
pub mod parameter_file;
pub mod radio;
pub mod recorder;
pub mod recording;
pub mod report;
pub mod settings;
mod statistics;
pub mod status;
pub mod tuning;
