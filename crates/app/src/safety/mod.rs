//! Who may move: flags, verdict, arming, permit.

mod arming;
mod error_account;
mod flags;
mod permit;
mod policy;

pub use arming::{ArmedToken, Arming, ArmingBlockers, ArmingInputs, ArmingState, ArmingStatus};
pub use flags::SafetyFlags;
pub use permit::TorquePermit;
pub use policy::{SafetyInputs, SafetyPolicy, SafetyStatus, SafetyVerdict};
