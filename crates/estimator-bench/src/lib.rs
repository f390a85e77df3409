//! Attitude filters as programs for the board, one filter each, so that an emulated Cortex-M4F can count what they cost.
//!
//! Each program waits at a breakpoint, where its runner writes a [`mailbox::Input`] into the mailbox. When resumed, the
//! program does one step of its filter, puts the attitude into the mailbox and returns to the breakpoint.

#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "board")]
pub mod board;
pub mod mailbox;
#[cfg(feature = "board")]
pub mod uf_ahrs;
