//! The PC's tools for the robot: they calibrate its sensors, and tune, watch, record and drive it over CAN or the PC link.
//!
//! | place | does |
//! |---|---|
//! | [`recording`] | reads samples of a sensor from files |
//! | [`calibration`] | finds the corrections that the firmware applies |
//! | [`report`] | shows a correction as an HTML page |
//! | [`mounting`] | finds how the sensors are mounted while the user tilts the robot |
//! | [`radio`] | finds the channel of each control of a transmitter while the pilot moves it |
//! | [`settings`] | names the robot's settings and puts their values into words |
//! | [`parameter_file`] | reads and writes parameters in TOML |
//! | [`can_link`] | reaches a CAN bus through an slcan adapter, SocketCAN or a gateway to Ethernet |
//! | [`pc_link`] | reaches the robot through the PC link |
//! | [`transport`] | chooses between the two |
//! | [`can_recorder`] | records all frames of a bus as MCAP |
//! | [`link_recorder`] | records the state from the PC link as MCAP |
//! | [`mcap_file`] | writes MCAP files of JSON messages |
//! | [`plot`] | shows a recording as an HTML page |
//! | [`drive`] | steers the robot by keyboard or joystick |
//! | [`tuning`] | reads and changes the robot's settings over CAN, and reads its live values |
//! | [`status`] | shows live values as words or JSON |
//! | [`black_box`] | downloads the black box, tells its events, and writes them as MCAP |
//! | [`recorder`] | records the robot's samples over CAN into a table |
//! | [`first_board`] | makes the checks of a first board and writes their report |

pub mod black_box;
pub mod calibration;
pub mod can_link;
pub mod can_recorder;
pub mod drive;
pub mod first_board;
pub mod link_recorder;
pub mod mcap_file;
pub mod mounting;
pub mod parameter_file;
pub mod pc_link;
pub mod plot;
pub mod radio;
pub mod recorder;
pub mod recording;
pub mod report;
pub mod settings;
mod statistics;
pub mod status;
pub mod transport;
pub mod tuning;
