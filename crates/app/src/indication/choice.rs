//! Which of the things that are true now is shown: the first of the list that holds.

use crate::{
    bring_up::BringUpStep,
    domain::{CalibrationState, CalibrationStatus},
    params::{ParamState, ParamStatus},
    safety::{ArmingBlockers, ArmingState, ArmingStatus, SafetyFlags, SafetyStatus},
};

/// In order of priority, the most urgent first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Indication {
    /// The pilot threw the e-stop.
    EStop,
    /// Charge or change the battery; everything stopped.
    BatteryEmpty,
    /// A stop that stays until a human has looked and cleared it; nothing is armed.
    LatchedStop,
    /// No radio, or a bad one.
    RadioLost,
    /// Anything else that stops everything.
    Fault,
    /// Armed, but wheels, joints or a bus are stopped.
    ArmedInPart,
    /// Armed, and the battery is nearly empty: land it.
    ArmedBatteryLow,
    /// Bring-up, armed: a motor may move.
    BringUpArmed,
    Armed,
    /// The pilot has asked, and will be armed as soon as settings are written.
    Waiting,
    BringUp,
    BatteryLow,
    /// The package is not warm yet.
    WarmingUp,
    /// The start-up calibration needs a robot that stands still.
    HoldStill,
    Calibrating,
    /// Wheels, joints, a bus, the settings or a debugger forbid to arm.
    NotReady,
    /// The enable switch is on, but that does not arm: see why the request was refused.
    Refused,
    /// As `Ready`, but flash takes no settings: what was changed last goes with the power.
    NotSaved,
    /// The enable switch arms.
    Ready,
}

#[derive(Clone, Copy, Debug)]
pub struct IndicationInputs<'a> {
    pub arming: &'a ArmingStatus,
    pub safety: &'a SafetyStatus,
    pub calibration: &'a CalibrationStatus,
    pub bring_up: BringUpStep,
    pub params: &'a ParamStatus,
}

const RADIO: SafetyFlags = SafetyFlags::REMOTE_LOST
    .union(SafetyFlags::REMOTE_FAILSAFE)
    .union(SafetyFlags::REMOTE_QUALITY);

const NOT_READY: [ArmingBlockers; 7] = [
    ArmingBlockers::JOINT_TIMEOUT_UNSET,
    ArmingBlockers::DEBUGGER_CATCHES,
    ArmingBlockers::JOINTS_NOT_READY,
    ArmingBlockers::SETTINGS_REFUSED,
    ArmingBlockers::WHEEL_NEVER_HEARD,
    ArmingBlockers::WHEEL_DOUBTFUL,
    ArmingBlockers::JOINT_OUT_OF_LIMITS,
];

impl Indication {
    pub fn of(inputs: &IndicationInputs<'_>) -> Self {
        // Whatever stops the robot as well refuses the request.
        if inputs.arming.waiting {
            return Self::Waiting;
        }
        if let Some(stop) = stop(inputs) {
            return stop;
        }
        match inputs.arming.state {
            ArmingState::Armed => armed(inputs),
            ArmingState::Disarmed => disarmed(inputs),
        }
    }
}

fn stop(inputs: &IndicationInputs<'_>) -> Option<Indication> {
    let safety = inputs.safety;
    // Whoever goes near to look must not find that the other motors are live.
    let all_still = safety.global_stop || inputs.arming.state == ArmingState::Disarmed;
    let has = |flags| safety.flags.intersects(flags);
    // Without the radio nobody knows where the switch is.
    if has(SafetyFlags::E_STOP) && !has(SafetyFlags::REMOTE_LOST) {
        Some(Indication::EStop)
    } else if has(SafetyFlags::BATTERY_EMPTY) {
        Some(Indication::BatteryEmpty)
    } else if !safety.latched.is_empty() && all_still {
        Some(Indication::LatchedStop)
    } else if has(RADIO) {
        Some(Indication::RadioLost)
    } else if safety.global_stop {
        Some(Indication::Fault)
    } else {
        None
    }
}

fn armed(inputs: &IndicationInputs<'_>) -> Indication {
    if stops_in_part(inputs.safety) {
        Indication::ArmedInPart
    } else if inputs.safety.flags.intersects(SafetyFlags::BATTERY_LOW) {
        Indication::ArmedBatteryLow
    } else if inputs.bring_up != BringUpStep::Off {
        Indication::BringUpArmed
    } else {
        Indication::Armed
    }
}

fn disarmed(inputs: &IndicationInputs<'_>) -> Indication {
    let blockers = inputs.arming.blockers;
    let blocked_by = |blocker| blockers.contains(blocker);
    if inputs.bring_up != BringUpStep::Off {
        Indication::BringUp
    } else if inputs.safety.flags.intersects(SafetyFlags::BATTERY_LOW) {
        Indication::BatteryLow
    } else if blocked_by(ArmingBlockers::CALIBRATION_PENDING) {
        match inputs.calibration.state {
            CalibrationState::WaitingForTemperature => Indication::WarmingUp,
            CalibrationState::WaitingForStillness | CalibrationState::OffsetRefused => {
                Indication::HoldStill
            }
            CalibrationState::Measuring | CalibrationState::Done => Indication::Calibrating,
        }
    } else if stops_in_part(inputs.safety) || NOT_READY.into_iter().any(blocked_by) {
        Indication::NotReady
    } else if !blocked_by(ArmingBlockers::ENABLE_OFF) {
        Indication::Refused
    } else if cannot_save(inputs.params) {
        Indication::NotSaved
    } else {
        Indication::Ready
    }
}

fn cannot_save(params: &ParamStatus) -> bool {
    params.unsaved != 0 && params.state == ParamState::BackingOff
}

fn stops_in_part(safety: &SafetyStatus) -> bool {
    safety.wheels_stop || safety.joints_stop || safety.bus_stop.contains(&true)
}

#[cfg(test)]
mod tests;
