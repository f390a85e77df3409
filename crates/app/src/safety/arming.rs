//! The arming state machine. The robot stays disarmed until the pilot flips the enable switch while nothing blocks
//! arming (docs/safety.md#the-rules, 1).
//!
//! The switch requests arming when it goes from off to on. The request is answered at once: the robot arms, or
//! refuses. A refused request is used up, and disarming for any reason uses up the request as well. The switch must
//! then go off and on again; otherwise the robot could start when nobody expects it. A request waits in one case
//! only: while settings are written to flash, and while the attitude settles after the chip has stood still for that.

use super::{SafetyFlags, SafetyStatus, SafetyVerdict, motor_readiness::MotorReadiness};
use crate::domain::{OperatorState, ParamStatus, SafetyConfig};

/// A frame counts under new settings if it is at least this much younger than their change.
pub(super) const SETTINGS_LAG_US: u64 = 5_000;

/// Whether the robot is armed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ArmingState {
    /// No torque leaves the board.
    #[default]
    Disarmed = 0,
    /// Torque may leave the board as far as the safety policy allows.
    Armed = 1,
}

/// The reasons that block arming, as bits whose positions never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct ArmingBlockers(u32);

bitflags::bitflags! {
    impl ArmingBlockers: u32 {
        /// No fresh remote frame.
        const REMOTE_NOT_FRESH = 1 << 0;
        /// The enable switch is off.
        const ENABLE_OFF = 1 << 1;
        /// The enable switch is on but must go off and on again: it was on at boot, or its request is used up.
        const ENABLE_NOT_CYCLED = 1 << 2;
        /// A stick is off centre, or was within the last 0.2 s.
        const STICKS_NOT_CENTRED = 1 << 3;
        /// The attitude estimate is not valid.
        const ESTIMATE_INVALID = 1 << 4;
        /// The start-up calibration has not finished.
        const CALIBRATION_PENDING = 1 << 5;
        /// `SafetyPolicy` demands a stop, even a partial one; see its flags.
        const SAFETY_STOP = 1 << 6;
        /// A joint does not answer, is not set up, or reports a fault.
        const JOINTS_NOT_READY = 1 << 7;
        /// Bring-up is in its read-only step, in which nothing may move.
        const BRING_UP_READ_ONLY = 1 << 8;
        /// The battery is low, or not measured.
        const BATTERY_LOW = 1 << 9;
        /// Settings are being written to flash, or a sector is erased for them. A request waits until this ends.
        const FLASH_BUSY = 1 << 10;
        /// A saved setting was refused at boot, and its default may not fit this robot.
        const SETTINGS_REFUSED = 1 << 11;
        /// A debugger would halt the core where it has to send zero frames, and this cannot be undone.
        const DEBUGGER_CATCHES = 1 << 12;
        /// A wheel has not reported since boot.
        const WHEEL_NEVER_HEARD = 1 << 13;
        /// A wheel's angle contradicts its speed: two speed controllers have the same number, or the sensor is broken.
        const WHEEL_DOUBTFUL = 1 << 14;
        /// A joint reads an angle beyond its soft limits: its zero is not set, or it is off by a turn. This does not
        /// block arming while bring-up tests motors, which limits the torque.
        const JOINT_OUT_OF_LIMITS = 1 << 15;
        /// IMU samples were rejected within the last half second.
        const ATTITUDE_UNSETTLED = 1 << 16;

        /// A joint motor would keep its last command when the bus falls silent, unless its time-out has been set by hand.
        /// No setting confirms that it has.
        const JOINT_TIMEOUT_UNSET = 1 << 17;
    }
}

impl ArmingBlockers {
    /// The empty set.
    pub const NONE: Self = Self(0);

    fn add_if(&mut self, blocker: Self, active: bool) {
        if active {
            self.insert(blocker);
        }
    }

    /// Names of the blockers in the set, lowest bit first.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        BLOCKER_NAMES
            .iter()
            .filter(move |(blocker, _)| self.contains(*blocker))
            .map(|(_, name)| *name)
    }

    /// Name of a bit, or `None` for an unused one.
    pub fn name_of_bit(bit: u8) -> Option<&'static str> {
        let mut names = BLOCKER_NAMES.iter();
        let found = names.find(|(blocker, _)| blocker.0.trailing_zeros() == u32::from(bit));
        found.map(|(_, name)| *name)
    }
}

/// A static rather than a constant, as tools read the names of the bits from the image.
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

/// State of arming, for diagnostics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct ArmingStatus {
    /// Armed or disarmed.
    pub state: ArmingState,
    /// The pilot has requested arming. The robot arms when the blockers end by themselves.
    pub waiting: bool,
    /// The blockers of arming, empty while armed.
    pub blockers: ArmingBlockers,
    /// Why the last request was refused, empty since the robot was last armed.
    pub refused: ArmingBlockers,
}

/// Why the robot was last disarmed: what blocked arming in that tick, and the safety flags. Empty since boot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct DriveEnd {
    /// The blockers that disarmed the robot.
    pub blockers: ArmingBlockers,
    /// The flags of that tick.
    pub flags: SafetyFlags,
}

impl DriveEnd {
    /// Whether the pilot asked for the stop: the enable switch, the e-stop, or the read-only step of bring-up. A stop
    /// that came in the same tick for another reason was not asked for.
    pub fn was_asked_for(&self) -> bool {
        let asked = ArmingBlockers::ENABLE_OFF
            .union(ArmingBlockers::ENABLE_NOT_CYCLED)
            .union(ArmingBlockers::BRING_UP_READ_ONLY)
            .union(ArmingBlockers::SAFETY_STOP);
        let failures = SafetyFlags::GLOBAL_STOP.difference(SafetyFlags::E_STOP);
        asked.contains(self.blockers) && !self.flags.intersects(failures)
    }
}

/// Proof that the robot is armed in this tick. It can be made only here, and cannot be copied.
#[derive(Debug)]
pub struct ArmedToken(());

/// Inputs of the arming state machine.
#[derive(Clone, Copy, Debug)]
pub struct ArmingInputs<'a> {
    /// Limits and times.
    pub config: &'a SafetyConfig,
    /// The pilot's sticks are centred; see `CentredSticks`.
    pub sticks_centred: bool,
    /// Age of the last frame received over the air, in µs.
    pub remote_age_us: u32,
    /// The pilot's switches.
    pub operator: &'a OperatorState,
    /// The attitude estimate is valid.
    pub estimate_valid: bool,
    /// See `AttitudeSettling`.
    pub attitude_settled: bool,
    /// The start-up calibration has finished.
    pub calibrated: bool,
    /// Motors that block arming.
    pub motor: &'a MotorReadiness,
    /// Bring-up is in its read-only step.
    pub read_only: bool,
    /// Bring-up is in a step that tests motors.
    pub tests_motors: bool,
    /// See `FlashPermit`, which grants nothing to an armed robot.
    pub flash_busy: bool,
    /// State of the parameter store.
    pub params: &'a ParamStatus,
    /// See `DebugProbe::catches`.
    pub debugger_catches: bool,
    /// See [`ArmingBlockers::JOINT_TIMEOUT_UNSET`].
    pub joint_timeout_unset: bool,
    /// Flags and stops of this tick.
    pub safety: &'a SafetyStatus,
}

/// The request made by the enable switch, since boot or since the last disarming.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Request {
    /// The switch has not yet been seen off.
    #[default]
    SwitchMustGoOff,
    /// The switch is off. Switching it on makes a request.
    Ready,
    Pending {
        since_us: u64,
    },
}

/// Holds the arming state and the pilot's request. It starts disarmed.
#[derive(Clone, Debug, Default)]
pub struct Arming {
    state: ArmingState,
    request: Request,
    refused: ArmingBlockers,
    drive_end: DriveEnd,
    /// Flash was being written, and the attitude has not settled since.
    unsettled: bool,
    /// Frames older than this do not move the switch.
    trusted_from_us: u64,
}

impl Arming {
    /// Restarts after a change of settings. Another channel may have become the enable switch, so it must be seen off
    /// in frames that came after the change.
    pub fn settings_changed(&mut self, now_us: u64) {
        self.request = Request::SwitchMustGoOff;
        self.trusted_from_us = now_us.saturating_add(SETTINGS_LAG_US);
    }

    /// Advances by one tick. Returns a token if the robot is armed.
    pub fn step(
        &mut self,
        inputs: &ArmingInputs<'_>,
        now_us: u64,
    ) -> (ArmingStatus, Option<ArmedToken>) {
        let fresh = inputs.remote_age_us <= inputs.config.remote_timeout_us;
        let settled = inputs.estimate_valid && inputs.attitude_settled;
        self.unsettled = inputs.flash_busy || self.unsettled && !settled;
        self.update_request(fresh, inputs, now_us);
        let mut blockers = self.disarming_blockers(fresh, inputs);
        match self.state {
            ArmingState::Disarmed => {
                blockers = self.handle_request(blockers, fresh, inputs, now_us)
            }
            ArmingState::Armed => {
                if !blockers.is_empty() {
                    self.drive_end = DriveEnd {
                        blockers,
                        flags: inputs.safety.flags,
                    };
                    self.disarm();
                    blockers = self.disarming_blockers(fresh, inputs);
                }
            }
        }
        let armed = self.state == ArmingState::Armed;
        let status = ArmingStatus {
            state: self.state,
            waiting: !armed && matches!(self.request, Request::Pending { .. }),
            blockers,
            refused: self.refused,
        };
        (status, armed.then_some(ArmedToken(())))
    }

    /// Why the robot was last disarmed.
    pub const fn drive_end(&self) -> &DriveEnd {
        &self.drive_end
    }

    /// Handles the pilot's request: arms, waits or refuses. `disarming_blockers` are the blockers that also disarm. Returns
    /// all blockers.
    #[inline(never)]
    fn handle_request(
        &mut self,
        disarming_blockers: ArmingBlockers,
        fresh: bool,
        inputs: &ArmingInputs<'_>,
        now_us: u64,
    ) -> ArmingBlockers {
        let blockers = disarming_blockers.union(arming_only_blockers(inputs));
        if blockers.is_empty() {
            self.state = ArmingState::Armed;
            self.refused = ArmingBlockers::NONE;
        } else if let Request::Pending { since_us } = self.request
            && !self.may_wait(since_us, blockers, inputs, now_us)
        {
            self.request = Request::SwitchMustGoOff;
            self.refused = blockers;
            return blockers.union(self.disarming_blockers(fresh, inputs));
        }
        blockers
    }

    fn disarm(&mut self) {
        self.state = ArmingState::Disarmed;
        if matches!(self.request, Request::Pending { .. }) {
            self.request = Request::SwitchMustGoOff;
        }
    }

    /// Moves the switch only while the remote is fresh, as old values do not show the pilot's intent.
    fn update_request(&mut self, fresh: bool, inputs: &ArmingInputs<'_>, now_us: u64) {
        let operator = inputs.operator;
        if !fresh || operator.ts_us < self.trusted_from_us {
            return;
        }
        if operator.disabled {
            self.request = Request::Ready;
            return;
        }
        self.request = match (self.request, operator.enabled) {
            (Request::Ready, true) => Request::Pending { since_us: now_us },
            (Request::Pending { .. }, false) => Request::SwitchMustGoOff,
            (request, _) => request,
        };
    }

    /// Whether all blockers result from writing to flash, and the request has not waited too long.
    #[cold]
    fn may_wait(
        &self,
        since_us: u64,
        blockers: ArmingBlockers,
        inputs: &ArmingInputs<'_>,
        now_us: u64,
    ) -> bool {
        let caused_by_flash = ArmingBlockers::FLASH_BUSY
            .union(ArmingBlockers::ESTIMATE_INVALID)
            .union(ArmingBlockers::ATTITUDE_UNSETTLED)
            .union(ArmingBlockers::SAFETY_STOP);
        let unsettled = SafetyFlags::ESTIMATE_INVALID.union(SafetyFlags::IMU_STALE);
        let waited_us = now_us.saturating_sub(since_us);
        self.unsettled
            && caused_by_flash.contains(blockers)
            && inputs.safety.would_run_without(unsettled)
            && waited_us <= u64::from(inputs.config.arm_request_us)
    }

    /// Blockers that also disarm.
    fn disarming_blockers(&self, fresh: bool, inputs: &ArmingInputs<'_>) -> ArmingBlockers {
        let mut blockers = ArmingBlockers::NONE;
        blockers.add_if(ArmingBlockers::REMOTE_NOT_FRESH, !fresh);
        blockers.add_if(ArmingBlockers::ENABLE_OFF, !inputs.operator.enabled);
        blockers.add_if(
            ArmingBlockers::ENABLE_NOT_CYCLED,
            inputs.operator.enabled && !matches!(self.request, Request::Pending { .. }),
        );
        blockers.add_if(ArmingBlockers::ESTIMATE_INVALID, !inputs.estimate_valid);
        blockers.add_if(ArmingBlockers::CALIBRATION_PENDING, !inputs.calibrated);
        blockers.add_if(ArmingBlockers::SAFETY_STOP, inputs.safety.global_stop);
        blockers.add_if(ArmingBlockers::BRING_UP_READ_ONLY, inputs.read_only);
        blockers
    }
}

/// Blockers that do not disarm an armed robot. A partial stop affects only its part, and a robot that stands on its
/// legs should not fall because its battery gets low.
fn arming_only_blockers(inputs: &ArmingInputs<'_>) -> ArmingBlockers {
    let mut blockers = ArmingBlockers::NONE;
    blockers.add_if(ArmingBlockers::STICKS_NOT_CENTRED, !inputs.sticks_centred);
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
        motor.joints_outside != 0 && !inputs.tests_motors,
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
