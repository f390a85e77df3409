//! Who may move: flags, verdict, arming, permit.

mod arming;
mod battery;
mod debounce;
mod error_account;
mod flags;
mod flash_permit;
mod heat;
mod latch;
mod permit;
mod policy;
mod status;
mod tilt;

pub use arming::{ArmedToken, Arming, ArmingBlockers, ArmingInputs, ArmingState, ArmingStatus};
pub use flags::SafetyFlags;
pub use flash_permit::{FlashGrant, FlashPermit, FlashPermitInputs, WatchdogPeriod};
pub use permit::TorquePermit;
pub use policy::{SafetyInputs, SafetyPolicy};
pub use status::{SafetyStatus, SafetyVerdict};
