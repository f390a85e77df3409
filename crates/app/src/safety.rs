//! Who may move: flags, verdict, arming, permit.

mod arming;
mod attitude_rest;
mod battery;
mod debounce;
mod error_account;
mod flags;
mod flash_permit;
mod heat;
mod latch;
mod motor_findings;
mod permit;
mod policy;
mod resume;
mod status;
mod stick_rest;
mod tilt;

pub use arming::{ArmedToken, Arming, ArmingBlockers, ArmingInputs, ArmingState, ArmingStatus};
pub use attitude_rest::AttitudeRest;
pub use flags::SafetyFlags;
pub use flash_permit::{FlashGrant, FlashPermit, FlashPermitInputs, WatchdogPeriod};
pub use motor_findings::MotorFindings;
pub use permit::TorquePermit;
pub use policy::{SafetyInputs, SafetyPolicy};
pub use status::{SafetyStatus, SafetyVerdict};
pub use stick_rest::StickRest;
