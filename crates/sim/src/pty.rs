//! CAN buses of the emulated board on pseudo-terminals, where a PC's tools find them as LAWICEL (slcan) adapters.

mod can_port;
mod frame_text;
mod lawicel;
mod terminal;

pub use can_port::{CanPort, PortStats};
