//! The PC link: a serial line on which a computer reads the robot's state and steers it (docs/pc-link.md).
//!
//! Every frame is a header, a payload and a CRC-8. Both sides use this module: the robot sends [`Uplink`] and receives
//! through [`RobotReceiver`], a computer sends [`Downlink`] or [`DriveFrame`] and receives through [`PcReceiver`]. [`Tunnelled`] carries
//! CAN frames of the tuning channel both ways.

mod composition;
mod crc8;
mod downlink;
mod drive;
mod fields;
mod keys;
mod pc_receiver;
mod robot_receiver;
mod scale;
mod scanner;
mod tunnel;
mod uplink;

pub use composition::Observation;
pub use crc8::crc8;
pub use downlink::{DOWNLINK_LEN, Downlink};
pub use drive::DriveFrame;
pub use keys::{Keys, Sticks};
pub use pc_receiver::{Heard, PcReceiver};
pub use robot_receiver::{Received, RobotReceiver};
pub use scanner::ScanCounters;
pub use tunnel::{TUNNEL_LEN, Tunnelled};
pub use uplink::{MotorState, UPLINK_LEN, Uplink};

/// Speed of the line in bits per second: 8 data bits, no parity, 1 stop bit.
pub const BAUD: u32 = 460_800;
/// First byte of state and command frames.
const HEADER: u8 = 0xFE;
/// First byte of tunnelled CAN frames.
const TUNNEL_HEADER: u8 = 0xFD;
/// First byte of drive frames.
const DRIVE_HEADER: u8 = 0xFC;
