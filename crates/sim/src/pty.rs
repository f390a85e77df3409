//! CAN buses of the emulated board on pseudo-terminals, where a PC's tools find them as LAWICEL (slcan) adapters.

mod frame_text;
mod lawicel;
mod slcan_port;
mod terminal;

pub use slcan_port::SlcanPort;
