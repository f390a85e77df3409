//! Arms of serial bus servos, such as the SO-101: the bus, its servos, calibration, kinematics.
#![forbid(unsafe_code)]
