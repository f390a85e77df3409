//! Attitude filters as programs for the board, one filter each, so that an emulated Cortex-M4F can count what they cost.
//!
//! Each program waits in a breakpoint; meanwhile whoever runs it writes a [`mailbox::Input`] into the mailbox. Let go,
//! it does one step of its filter, leaves the attitude in the mailbox and comes back to the breakpoint.

#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "board")]
pub mod board;
pub mod mailbox;
#[cfg(feature = "board")]
pub mod uf_ahrs;
