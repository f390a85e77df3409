//! Arms of serial bus servos, such as the SO-101.
//!
//! | place | does |
//! |---|---|
//! | [`bus`] | talks to STS3215 servos: frames, registers, time-outs, tries |
//! | [`calibration`] | files that say which servo is which joint, its home and its limits |
//! | [`controller`] | an arm: joints by name, home, limits, torque, recovery |
//! | [`motion`] | recorded motions as JSON and MCAP, and another arm's pose as this one's |
//! | [`kinematics`] | where the tool is for given joint angles, and how it moves with them |
//! | [`ik`] | joint angles that bring the tool to a pose |
//!
//! With the feature `python`, which maturin turns on, all of it is the Python package `jiling_arm`.
// PyO3 writes unsafe code for the Python module, and none is written by hand.
#![cfg_attr(not(feature = "python"), forbid(unsafe_code))]

pub mod bus;
pub mod calibration;
pub mod controller;
pub mod ik;
pub mod kinematics;
pub mod motion;
#[cfg(feature = "python")]
mod python;
