//! Lines of the emulated board on pseudo-terminals: CAN buses, where a PC's tools find them as LAWICEL (slcan) adapters,
//! and the PC link.

mod frame_text;
mod lawicel;
mod link_port;
mod lockstep;
mod slcan_port;

pub use link_port::{LinkPort, LinkStats};
pub use slcan_port::SlcanPort;
