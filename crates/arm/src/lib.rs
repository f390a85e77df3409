//! Arms of serial bus servos, such as the SO-101.
//!
//! | place | does |
//! |---|---|
//! | [`bus`] | talks to STS3215 servos: frames, registers, time-outs, tries |
//! | [`kinematics`] | where the tool is for given joint angles, and how it moves with them |
//! | [`ik`] | joint angles that bring the tool to a pose |
#![forbid(unsafe_code)]

pub mod bus;
pub mod ik;
pub mod kinematics;
