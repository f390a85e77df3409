//! Selects what is shown: the most urgent condition that holds.

use crate::{
    bring_up::BringUpStep,
    domain::{CalibrationState, CalibrationStatus, ParamState, ParamStatus},
    safety::{ArmingBlockers, ArmingState, ArmingStatus, SafetyFlags, SafetyStatus},
};

/// What LED and buzzer show, in order of priority with the most urgent first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Indication {
    /// The pilot has thrown the e-stop.
    EStop,
    /// Everything has stopped because the battery is empty: charge or change it.
    BatteryEmpty,
    /// Something latched a stop. It stays until a person has looked and cleared it. Nothing is armed.
    LatchedStop,
    /// The radio is lost, in failsafe, or of poor quality.
    RadioLost,
    /// Everything has stopped for another reason.
    Fault,
    /// The robot is armed, but its wheels, its joints or one bus are stopped.
    ArmedInPart,
    /// The robot is armed and the battery is nearly empty: bring it to rest.
    ArmedBatteryLow,
    /// The robot is armed in bring-up: one motor may move.
    BringUpArmed,
    /// The robot is armed and may stand up or stands: it moves by itself.
    Standing,
    /// The robot is armed.
    Armed,
    /// The pilot has asked to arm. The robot arms as soon as the settings are written.
    Waiting,
    /// The robot is disarmed in bring-up.
    BringUp,
    /// The battery is low, which forbids arming.
    BatteryLow,
    /// The inertial sensor is not warm yet.
    WarmingUp,
    /// The start-up calibration waits for the robot to stand still.
    HoldStill,
    /// The start-up calibration is measuring.
    Calibrating,
    /// Wheels, joints, a bus, the settings or a debugger forbid arming.
    NotReady,
    /// The enable switch is on, but the robot did not arm. Diagnostics name the reason.
    Refused,
    /// As `Ready`, but the flash accepts no settings: the last changes will be lost at power-off.
    NotSaved,
    /// The enable switch arms the robot.
    Ready,
}

/// What the selection looks at.
#[derive(Clone, Copy, Debug)]
pub struct IndicationInputs<'a> {
    /// State and blockers of arming.
    pub arming: &'a ArmingStatus,
    /// The safety policy's flags and stops.
    pub safety: &'a SafetyStatus,
    /// Progress of the start-up calibration.
    pub calibration: &'a CalibrationStatus,
    /// Step of bring-up.
    pub bring_up: BringUpStep,
    /// State of the parameter store.
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
    /// Selects the most urgent indication.
    pub fn select(inputs: &IndicationInputs<'_>) -> Self {
        // A request to arm that waits for flash comes first: a stop would have refused it.
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
    // A latched stop is shown only when nothing can move. People come near to look, and other motors must not be
    // live.
    let all_still = safety.global_stop || inputs.arming.state == ArmingState::Disarmed;
    let has = |flags| safety.flags.intersects(flags);
    // Without the radio the position of the switch is unknown.
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
    } else if inputs.safety.stand.permits() {
        Indication::Standing
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
