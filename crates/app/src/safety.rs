//! The safety stage decides what may move: flags, verdict, arming, and the torque permit.

mod arming;
mod attitude_settling;
mod battery_limits;
mod centred_sticks;
mod debounce;
mod fall_detector;
mod flags;
mod flash_permit;
mod latch;
mod leaky_bucket;
mod motor_readiness;
mod pc_interlock;
mod permit;
mod policy;
mod resume_interlock;
mod standing;
mod status;
mod temperature_limits;

pub use arming::{
    ArmedToken, Arming, ArmingBlockers, ArmingInputs, ArmingState, ArmingStatus, DriveEnd,
};
pub use attitude_settling::AttitudeSettling;
pub use centred_sticks::CentredSticks;
pub use flags::SafetyFlags;
pub use flash_permit::{FlashGrant, FlashPermit, FlashPermitInputs, WatchdogPeriod};
pub use motor_readiness::MotorReadiness;
pub use pc_interlock::PcInputs;
pub use permit::TorquePermit;
pub use policy::{SafetyInputs, SafetyPolicy};
pub use status::{SafetyStatus, SafetyVerdict};
