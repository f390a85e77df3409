//! Disarmed until the pilot flips the enable switch and nothing speaks against it (docs/safety.md#the-rules, 1).
//!
//! The switch asks for arming when it goes from off to on, and is answered at once: the robot arms, or refuses. A refused
//! request is used up, as is that of a robot that is disarmed for any reason: the switch must go off and on again, or
//! the robot would start when nobody expects it any more. Only one thing ends by itself and is waited for: settings
//! being written to flash, and the attitude that settles anew when the chip has stood still for it.

use super::{SafetyFlags, SafetyStatus, SafetyVerdict, motor_findings::MotorFindings};
use crate::domain::{OperatorState, ParamStatus, SafetyConfig};

/// Settings count from the first frame that is this much younger than their change.
const SETTINGS_LAG_US: u64 = 5_000;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ArmingState {
    #[default]
    Disarmed = 0,
    Armed = 1,
}

/// What speaks against being armed, as bits whose positions never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct ArmingBlockers(u32);

impl ArmingBlockers {
    pub const NONE: Self = Self(0);
    /// No fresh remote frame.
    pub const REMOTE_NOT_FRESH: Self = Self(1 << 0);
    /// The enable switch is off.
    pub const ENABLE_OFF: Self = Self(1 << 1);
    /// The enable switch is on but must go off and on again: it was on at boot, or its request is used up.
    pub const ENABLE_NOT_CYCLED: Self = Self(1 << 2);
    /// A stick is off centre, or was within the last 0.2 s.
    pub const STICKS_NOT_CENTRED: Self = Self(1 << 3);
    pub const ESTIMATE_INVALID: Self = Self(1 << 4);
    pub const CALIBRATION_PENDING: Self = Self(1 << 5);
    /// `SafetyPolicy` wants a stop, be it of a part only; see its flags.
    pub const SAFETY_STOP: Self = Self(1 << 6);
    /// A joint does not answer, is not set up, or reports a fault.
    pub const JOINTS_NOT_READY: Self = Self(1 << 7);
    /// Bring-up is in the step in which nothing may move.
    pub const BRING_UP_READ_ONLY: Self = Self(1 << 8);
    /// Low, or not measured.
    pub const BATTERY_LOW: Self = Self(1 << 9);
    /// Settings are being written to flash, or room is made for them. A request waits for the end.
    pub const FLASH_BUSY: Self = Self(1 << 10);
    /// A saved setting was refused at boot; its default need not fit this robot.
    pub const SETTINGS_REFUSED: Self = Self(1 << 11);
    /// A debugger halts the core where it should send zero frames, and does not let that be undone.
    pub const DEBUGGER_CATCHES: Self = Self(1 << 12);
    /// A wheel has not been heard since boot.
    pub const WHEEL_NEVER_HEARD: Self = Self(1 << 13);
    /// A wheel's angle does not move as its speed says: two speed controllers have one number, or its sensor is broken.
    pub const WHEEL_DOUBTFUL: Self = Self(1 << 14);
    /// A joint reads an angle beyond its soft limits: its zero is not set, or it is wrong by a turn. Not while bring-up
    /// tries out motors, which gives one of them little torque.
    pub const JOINT_OUT_OF_LIMITS: Self = Self(1 << 15);
    /// Samples of the IMU were rejected within the last half second.
    pub const ATTITUDE_UNSETTLED: Self = Self(1 << 16);

    /// A joint motor keeps its last command for ever when the bus falls silent, unless somebody has set its time-out, and
    /// nobody says so.
    pub const JOINT_TIMEOUT_UNSET: Self = Self(1 << 17);

    pub const fn bits(self) -> u32 {
        self.0
    }

    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    pub const fn contains(self, blocker: Self) -> bool {
        self.0 & blocker.0 != 0
    }

    /// Names of the blockers in the set, lowest bit first.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        BLOCKER_NAMES
            .iter()
            .filter(move |(blocker, _)| self.contains(*blocker))
            .map(|(_, name)| *name)
    }

    /// `None` for a bit that stands for nothing.
    pub fn name_of_bit(bit: u8) -> Option<&'static str> {
        let mut names = BLOCKER_NAMES.iter();
        let found = names.find(|(blocker, _)| blocker.0.trailing_zeros() == u32::from(bit));
        found.map(|(_, name)| *name)
    }

    /// True if the set has nothing that `other` has not.
    const fn is_within(self, other: Self) -> bool {
        self.0 & !other.0 == 0
    }

    const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    fn add_if(&mut self, blocker: Self, active: bool) {
        if active {
            self.0 |= blocker.0;
        }
    }
}

/// Not a constant: tools read the names of the bits out of the image.
static BLOCKER_NAMES: [(ArmingBlockers, &str); 18] = [
    (ArmingBlockers::REMOTE_NOT_FRESH, "remote-not-fresh"),
    (ArmingBlockers::ENABLE_OFF, "enable-off"),
    (ArmingBlockers::ENABLE_NOT_CYCLED, "enable-not-cycled"),
    (ArmingBlockers::STICKS_NOT_CENTRED, "sticks-not-centred"),
    (ArmingBlockers::ESTIMATE_INVALID, "estimate-invalid"),
    (ArmingBlockers::CALIBRATION_PENDING, "calibration-pending"),
    (ArmingBlockers::SAFETY_STOP, "safety-stop"),
    (ArmingBlockers::JOINTS_NOT_READY, "joints-not-ready"),
    (ArmingBlockers::BRING_UP_READ_ONLY, "bring-up-read-only"),
    (ArmingBlockers::BATTERY_LOW, "battery-low"),
    (ArmingBlockers::FLASH_BUSY, "flash-busy"),
    (ArmingBlockers::SETTINGS_REFUSED, "settings-refused"),
    (ArmingBlockers::DEBUGGER_CATCHES, "debugger-catches"),
    (ArmingBlockers::WHEEL_NEVER_HEARD, "wheel-never-heard"),
    (ArmingBlockers::WHEEL_DOUBTFUL, "wheel-doubtful"),
    (ArmingBlockers::JOINT_OUT_OF_LIMITS, "joint-out-of-limits"),
    (ArmingBlockers::ATTITUDE_UNSETTLED, "attitude-unsettled"),
    (ArmingBlockers::JOINT_TIMEOUT_UNSET, "joint-timeout-unset"),
];

#[cfg(feature = "defmt")]
impl defmt::Format for ArmingBlockers {
    fn format(&self, f: defmt::Formatter<'_>) {
        if self.is_empty() {
            defmt::write!(f, "none");
        }
        for name in self.names() {
            defmt::write!(f, "{=str} ", name);
        }
    }
}

/// For diagnostics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct ArmingStatus {
    pub state: ArmingState,
    /// The pilot has asked, and will be armed when what blocks arming has ended by itself.
    pub waiting: bool,
    /// Empty while armed.
    pub blockers: ArmingBlockers,
    /// Why the last request was refused; empty since the robot was armed.
    pub refused: ArmingBlockers,
}

/// Exists only while armed; cannot be made anywhere else, copied or kept for the next tick's permit by accident.
#[derive(Debug)]
pub struct ArmedToken(());

/// All arming looks at.
#[derive(Clone, Copy, Debug)]
pub struct ArmingInputs<'a> {
    pub config: &'a SafetyConfig,
    /// See `StickRest`.
    pub sticks_rest: bool,
    /// Age of the last frame that came over the air.
    pub remote_age_us: u32,
    pub operator: &'a OperatorState,
    pub estimate_valid: bool,
    /// See `AttitudeRest`.
    pub attitude_settled: bool,
    pub calibrated: bool,
    pub motor: &'a MotorFindings,
    /// Bring-up is in the step in which nothing may move.
    pub read_only: bool,
    /// Bring-up is in a step in which motors are tried out.
    pub tries_motors: bool,
    /// See `FlashPermit`, which grants nothing to an armed robot.
    pub flash_busy: bool,
    pub params: &'a ParamStatus,
    /// See `DebugProbe::catches`.
    pub debugger_catches: bool,
    /// See [`ArmingBlockers::JOINT_TIMEOUT_UNSET`].
    pub joint_timeout_unset: bool,
    pub safety: &'a SafetyStatus,
}

/// The enable switch as seen since boot or since the last disarming.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Request {
    /// Not yet seen off.
    #[default]
    MustGoOff,
    /// Off: the next time it goes on is a request.
    Ready,
    Asked {
        since_us: u64,
    },
}

/// Starts disarmed.
#[derive(Clone, Debug, Default)]
pub struct Arming {
    state: ArmingState,
    request: Request,
    refused: ArmingBlockers,
    /// Flash was being written, and the attitude has not settled since.
    unsettled: bool,
    /// The switch as older frames had it does not count.
    trusted_from_us: u64,
}

impl Arming {
    /// A channel may be the enable switch now that was not before: it must be seen off by frames that came after.
    pub fn settings_changed(&mut self, now_us: u64) {
        self.request = Request::MustGoOff;
        self.trusted_from_us = now_us.saturating_add(SETTINGS_LAG_US);
    }

    /// A token for this tick if the robot is armed.
    pub fn step(
        &mut self,
        inputs: &ArmingInputs<'_>,
        now_us: u64,
    ) -> (ArmingStatus, Option<ArmedToken>) {
        let fresh = inputs.remote_age_us <= inputs.config.remote_timeout_us;
        let settled = inputs.estimate_valid && inputs.attitude_settled;
        self.unsettled = inputs.flash_busy || self.unsettled && !settled;
        self.follow_switch(fresh, inputs, now_us);
        let mut blockers = self.disarming(fresh, inputs);
        match self.state {
            ArmingState::Disarmed => blockers = self.answer(blockers, fresh, inputs, now_us),
            ArmingState::Armed => {
                if !blockers.is_empty() {
                    self.disarm();
                    blockers = self.disarming(fresh, inputs);
                }
            }
        }
        let armed = self.state == ArmingState::Armed;
        let status = ArmingStatus {
            state: self.state,
            waiting: !armed && matches!(self.request, Request::Asked { .. }),
            blockers,
            refused: self.refused,
        };
        (status, armed.then_some(ArmedToken(())))
    }

    /// Arms, waits or refuses, if the pilot asks. `disarming` blocks it at least; all that blocks comes back.
    #[inline(never)]
    fn answer(
        &mut self,
        disarming: ArmingBlockers,
        fresh: bool,
        inputs: &ArmingInputs<'_>,
        now_us: u64,
    ) -> ArmingBlockers {
        let blockers = disarming.union(only_forbidding(inputs));
        if blockers.is_empty() {
            self.state = ArmingState::Armed;
            self.refused = ArmingBlockers::NONE;
        } else if let Request::Asked { since_us } = self.request
            && !self.may_wait(since_us, blockers, inputs, now_us)
        {
            self.request = Request::MustGoOff;
            self.refused = blockers;
            return blockers.union(self.disarming(fresh, inputs));
        }
        blockers
    }

    fn disarm(&mut self) {
        self.state = ArmingState::Disarmed;
        if matches!(self.request, Request::Asked { .. }) {
            self.request = Request::MustGoOff;
        }
    }

    /// Only a fresh remote moves the switch: old values are no sign of the pilot's will.
    fn follow_switch(&mut self, fresh: bool, inputs: &ArmingInputs<'_>, now_us: u64) {
        let operator = inputs.operator;
        if !fresh || operator.ts_us < self.trusted_from_us {
            return;
        }
        if operator.disabled {
            self.request = Request::Ready;
            return;
        }
        self.request = match (self.request, operator.enabled) {
            (Request::Ready, true) => Request::Asked { since_us: now_us },
            (Request::Asked { .. }, false) => Request::MustGoOff,
            (request, _) => request,
        };
    }

    /// True if all that blocks arming comes of the writing to flash, and not for too long yet.
    #[cold]
    fn may_wait(
        &self,
        since_us: u64,
        blockers: ArmingBlockers,
        inputs: &ArmingInputs<'_>,
        now_us: u64,
    ) -> bool {
        let by_flash = ArmingBlockers::FLASH_BUSY
            .union(ArmingBlockers::ESTIMATE_INVALID)
            .union(ArmingBlockers::ATTITUDE_UNSETTLED)
            .union(ArmingBlockers::SAFETY_STOP);
        let unsettled = SafetyFlags::ESTIMATE_INVALID.union(SafetyFlags::IMU_STALE);
        let waited_us = now_us.saturating_sub(since_us);
        self.unsettled
            && blockers.is_within(by_flash)
            && inputs.safety.would_run_without(unsettled)
            && waited_us <= u64::from(inputs.config.arm_request_us)
    }

    /// What forbids arming and ends it.
    fn disarming(&self, fresh: bool, inputs: &ArmingInputs<'_>) -> ArmingBlockers {
        let mut blockers = ArmingBlockers::NONE;
        blockers.add_if(ArmingBlockers::REMOTE_NOT_FRESH, !fresh);
        blockers.add_if(ArmingBlockers::ENABLE_OFF, !inputs.operator.enabled);
        blockers.add_if(
            ArmingBlockers::ENABLE_NOT_CYCLED,
            inputs.operator.enabled && !matches!(self.request, Request::Asked { .. }),
        );
        blockers.add_if(ArmingBlockers::ESTIMATE_INVALID, !inputs.estimate_valid);
        blockers.add_if(ArmingBlockers::CALIBRATION_PENDING, !inputs.calibrated);
        blockers.add_if(ArmingBlockers::SAFETY_STOP, inputs.safety.global_stop);
        blockers.add_if(ArmingBlockers::BRING_UP_READ_ONLY, inputs.read_only);
        blockers
    }
}

/// What forbids arming, but does not end it: a stop of a part stops only that part, and a robot that stands on its
/// legs should not fall because its battery gets low.
fn only_forbidding(inputs: &ArmingInputs<'_>) -> ArmingBlockers {
    let mut blockers = ArmingBlockers::NONE;
    blockers.add_if(ArmingBlockers::STICKS_NOT_CENTRED, !inputs.sticks_rest);
    blockers.add_if(ArmingBlockers::ATTITUDE_UNSETTLED, !inputs.attitude_settled);
    blockers.add_if(
        ArmingBlockers::SAFETY_STOP,
        inputs.safety.verdict != SafetyVerdict::Run,
    );
    let motor = inputs.motor;
    for (blocker, motors) in [
        (ArmingBlockers::JOINTS_NOT_READY, motor.joints_unready),
        (ArmingBlockers::WHEEL_NEVER_HEARD, motor.wheels_unheard),
        (ArmingBlockers::WHEEL_DOUBTFUL, motor.wheels_doubtful),
    ] {
        blockers.add_if(blocker, motors != 0);
    }
    blockers.add_if(
        ArmingBlockers::JOINT_TIMEOUT_UNSET,
        inputs.joint_timeout_unset,
    );
    blockers.add_if(
        ArmingBlockers::JOINT_OUT_OF_LIMITS,
        motor.joints_outside != 0 && !inputs.tries_motors,
    );
    blockers.add_if(ArmingBlockers::FLASH_BUSY, inputs.flash_busy);
    blockers.add_if(ArmingBlockers::SETTINGS_REFUSED, inputs.params.refused != 0);
    blockers.add_if(ArmingBlockers::DEBUGGER_CATCHES, inputs.debugger_catches);
    blockers.add_if(
        ArmingBlockers::BATTERY_LOW,
        inputs.safety.flags.intersects(SafetyFlags::BATTERY_LOW),
    );
    blockers
}

#[cfg(test)]
mod tests;
