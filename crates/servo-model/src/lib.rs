//! Serial bus servos as a program on the bus meets them: six of the STS3215 kind make an SO-101 arm.
//!
//! Written from the manufacturer's memory table for magnetic encoder STS servos, the manufacturer's SDK and LeRobot's driver, and
//! from no code of this project: a driver and its model must not share a misunderstanding.
//!
//! | folder | what |
//! |---|---|
//! | `frame` | requests and answers as bytes |
//! | `servo` | registers, motion, protection, answers of one servo |
//! | `fault` | what can go wrong, by name |
//! | `bus` | host and servos on one wire, bit by bit, with faults |
//! | `so101` | the arm that six servos make, and its weight |
//! | `wire` | the host's end in simulated time, for tests |
//! | `pty` | the host's end in real time, as a serial port |
//!
//! A test puts [`VirtualWire`] where its serial port would be:
//!
//! ```
//! use robot_servo_model::{Bus, Fault, Servo, Version, VirtualWire};
//!
//! let servos = (1..=6).map(|id| Servo::new(Version::Volts12, 2048.0).with_id(id));
//! let mut wire = VirtualWire::new(Bus::new(servos.collect(), 7));
//! // Sync read of the present position of all six.
//! wire.write(&[0xFF, 0xFF, 0xFE, 10, 0x82, 56, 2, 1, 2, 3, 4, 5, 6, 0x26]);
//! let mut answers = [0; 48];
//! let read = wire.read(&mut answers, wire.now_ns() + 10_000_000);
//! assert_eq!(read, 48);
//! // From now on one packet in a hundred is corrupted.
//! wire.bus().start(Fault::CorruptPacket { probability: 0.01 });
//! ```

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod bus;
mod fault;
mod frame;
#[cfg(unix)]
mod pty;
mod servo;
mod so101;
mod wire;

pub use bus::{Body, Bus, FaultId, Injected};
pub use fault::{Fault, NAMES as FAULT_NAMES, UnknownFault};
#[cfg(unix)]
pub use pty::{Port, PortError};
pub use servo::{Load, Servo, Version, View, status};
pub use so101::{JOINTS as SO101_JOINTS, So101, so101_servos};
pub use wire::VirtualWire;
