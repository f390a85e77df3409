//! The robots of `robots/*.toml`, and the one that this image is for. They are made when this crate is built.

use super::{
    BalanceLimits, BalanceProfile, Carrier, GainSchedule, LegGeometry, MassModel, MountingConfig,
    Orientation, RobotProfile, WheelOdomConfig,
};

include!(concat!(env!("OUT_DIR"), "/profiles.rs"));
