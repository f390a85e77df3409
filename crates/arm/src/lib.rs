//! Arms of serial bus servos, such as the SO-101.
//!
//! | place | does |
//! |---|---|
//! | [`bus`] | talks to STS3215 servos: frames, registers, time-outs, tries |
#![forbid(unsafe_code)]

pub mod bus;
