//! Attitude filters as programs for the board. Each program has one filter, whose cost an emulated Cortex-M4F counts.
//!
//! Each program waits in a breakpoint, and the host writes a [`mailbox::Input`] into the mailbox. Then the program does
//! one step of its filter, writes the attitude into the mailbox and returns to the breakpoint.

#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "board")]
pub mod board;
pub mod mailbox;
#[cfg(feature = "board")]
pub mod uf_ahrs;
