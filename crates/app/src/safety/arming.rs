//! Disarmed until the pilot flips the enable switch and nothing speaks against it (design.md section 3, rule 1).
//!
//! The switch asks for arming when it goes from off to on; the request lives a few seconds and dies with the switch.
//! Being disarmed for any reason uses the request up: the switch must go off and on again.

use super::{SafetyStatus, SafetyVerdict};
use crate::domain::{OperatorState, RemoteState, SafetyConfig};

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
    /// The enable switch is on but must go off and on again: it was on at boot, or its request is used up or too old.
    pub const ENABLE_NOT_CYCLED: Self = Self(1 << 2);
    pub const STICKS_NOT_CENTRED: Self = Self(1 << 3);
    pub const ESTIMATE_INVALID: Self = Self(1 << 4);
    pub const CALIBRATION_PENDING: Self = Self(1 << 5);
    /// `SafetyPolicy` wants a stop; see its flags.
    pub const SAFETY_STOP: Self = Self(1 << 6);

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

    fn set(&mut self, blocker: Self, active: bool) {
        if active {
            self.0 |= blocker.0;
        }
    }
}

/// Not a constant: tools read the names of the bits out of the image.
static BLOCKER_NAMES: [(ArmingBlockers, &str); 7] = [
    (ArmingBlockers::REMOTE_NOT_FRESH, "remote-not-fresh"),
    (ArmingBlockers::ENABLE_OFF, "enable-off"),
    (ArmingBlockers::ENABLE_NOT_CYCLED, "enable-not-cycled"),
    (ArmingBlockers::STICKS_NOT_CENTRED, "sticks-not-centred"),
    (ArmingBlockers::ESTIMATE_INVALID, "estimate-invalid"),
    (ArmingBlockers::CALIBRATION_PENDING, "calibration-pending"),
    (ArmingBlockers::SAFETY_STOP, "safety-stop"),
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
    /// Empty while armed.
    pub blockers: ArmingBlockers,
}

/// Exists only while armed; cannot be made anywhere else, copied or kept for the next tick's permit by accident.
#[derive(Debug)]
pub struct ArmedToken(());

/// All arming looks at.
#[derive(Clone, Copy, Debug)]
pub struct ArmingInputs<'a> {
    pub remote: &'a RemoteState,
    /// Age of the last frame that came over the air.
    pub remote_age_us: u32,
    pub operator: &'a OperatorState,
    pub estimate_valid: bool,
    pub calibrated: bool,
    pub safety: &'a SafetyStatus,
}

/// The enable switch as seen since boot or since the last disarming.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Request {
    /// Not yet seen off.
    MustGoOff,
    /// Off: the next time it goes on is a request.
    Ready,
    Asked {
        since_us: u64,
    },
}

#[derive(Clone, Debug)]
pub struct Arming {
    config: SafetyConfig,
    state: ArmingState,
    request: Request,
}

impl Arming {
    pub const fn new(config: SafetyConfig) -> Self {
        Self {
            config,
            state: ArmingState::Disarmed,
            request: Request::MustGoOff,
        }
    }

    /// A token for this tick if the robot is armed.
    pub fn step(
        &mut self,
        inputs: &ArmingInputs<'_>,
        now_us: u64,
    ) -> (ArmingStatus, Option<ArmedToken>) {
        let fresh = inputs.remote_age_us <= self.config.remote_timeout_us;
        self.follow_switch(fresh, inputs.operator, now_us);
        let mut blockers = self.blockers(fresh, inputs);
        match self.state {
            ArmingState::Disarmed => {
                blockers.set(
                    ArmingBlockers::STICKS_NOT_CENTRED,
                    !self.sticks_centred(inputs.remote),
                );
                if blockers.is_empty() {
                    self.state = ArmingState::Armed;
                }
            }
            ArmingState::Armed => {
                if !blockers.is_empty() {
                    self.disarm();
                    blockers = self.blockers(fresh, inputs);
                }
            }
        }
        let status = ArmingStatus {
            state: self.state,
            blockers,
        };
        let token = (self.state == ArmingState::Armed).then_some(ArmedToken(()));
        (status, token)
    }

    fn disarm(&mut self) {
        self.state = ArmingState::Disarmed;
        if matches!(self.request, Request::Asked { .. }) {
            self.request = Request::MustGoOff;
        }
    }

    /// Only a fresh remote moves the switch: old values are no sign of the pilot's will.
    fn follow_switch(&mut self, fresh: bool, operator: &OperatorState, now_us: u64) {
        if !fresh {
            return;
        }
        if operator.disabled {
            self.request = Request::Ready;
            return;
        }
        self.request = match (self.request, operator.enabled) {
            (Request::Ready, true) => Request::Asked { since_us: now_us },
            (Request::Asked { .. }, false) => Request::MustGoOff,
            (Request::Asked { since_us }, true)
                if self.state == ArmingState::Disarmed
                    && now_us.saturating_sub(since_us) > u64::from(self.config.arm_request_us) =>
            {
                Request::MustGoOff
            }
            (request, _) => request,
        };
    }

    fn blockers(&self, fresh: bool, inputs: &ArmingInputs<'_>) -> ArmingBlockers {
        let mut blockers = ArmingBlockers::NONE;
        blockers.set(ArmingBlockers::REMOTE_NOT_FRESH, !fresh);
        blockers.set(ArmingBlockers::ENABLE_OFF, !inputs.operator.enabled);
        blockers.set(
            ArmingBlockers::ENABLE_NOT_CYCLED,
            inputs.operator.enabled && !matches!(self.request, Request::Asked { .. }),
        );
        blockers.set(ArmingBlockers::ESTIMATE_INVALID, !inputs.estimate_valid);
        blockers.set(ArmingBlockers::CALIBRATION_PENDING, !inputs.calibrated);
        blockers.set(ArmingBlockers::SAFETY_STOP, self.stopped(inputs.safety));
        blockers
    }

    /// A stopped bus forbids arming but does not disarm: only its actuators stop.
    fn stopped(&self, safety: &SafetyStatus) -> bool {
        match safety.verdict {
            SafetyVerdict::Run => false,
            SafetyVerdict::BusStop => self.state == ArmingState::Disarmed,
            SafetyVerdict::GlobalStop => true,
        }
    }

    fn sticks_centred(&self, remote: &RemoteState) -> bool {
        [remote.vx, remote.wz]
            .iter()
            .all(|stick| stick.abs() <= self.config.stick_centre)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Bench {
        arming: Arming,
        now_us: u64,
        enabled: bool,
        disabled: bool,
        calibrated: bool,
        safety: SafetyStatus,
    }

    impl Bench {
        fn new() -> Self {
            Self {
                arming: Arming::new(SafetyConfig::default()),
                now_us: 1_000_000,
                enabled: false,
                disabled: true,
                calibrated: true,
                safety: SafetyStatus {
                    verdict: SafetyVerdict::Run,
                    ..SafetyStatus::default()
                },
            }
        }

        fn flip_on(&mut self) {
            (self.enabled, self.disabled) = (true, false);
        }

        fn run(&mut self, milliseconds: u64) -> ArmingStatus {
            let mut status = ArmingStatus::default();
            for _ in 0..milliseconds {
                self.now_us += 1_000;
                let inputs = ArmingInputs {
                    remote: &RemoteState::default(),
                    remote_age_us: 5_000,
                    operator: &OperatorState {
                        enabled: self.enabled,
                        disabled: self.disabled,
                        e_stop: false,
                        ..OperatorState::default()
                    },
                    estimate_valid: true,
                    calibrated: self.calibrated,
                    safety: &self.safety,
                };
                let (now, token) = self.arming.step(&inputs, self.now_us);
                assert_eq!(token.is_some(), now.state == ArmingState::Armed);
                status = now;
            }
            status
        }
    }

    #[test]
    fn off_then_on_arms_at_once() {
        let mut bench = Bench::new();
        assert_eq!(bench.run(1).blockers, ArmingBlockers::ENABLE_OFF);
        bench.flip_on();
        assert_eq!(bench.run(1).state, ArmingState::Armed);
    }

    #[test]
    fn a_request_waits_a_while_for_the_calibration_but_not_for_ever() {
        let mut bench = Bench::new();
        bench.calibrated = false;
        bench.run(1);
        bench.flip_on();
        assert_eq!(
            bench.run(2_000).blockers,
            ArmingBlockers::CALIBRATION_PENDING
        );
        bench.calibrated = true;
        assert_eq!(bench.run(1).state, ArmingState::Armed);

        let mut late = Bench::new();
        late.calibrated = false;
        late.run(1);
        late.flip_on();
        late.run(3_100);
        late.calibrated = true;
        assert_eq!(late.run(1).blockers, ArmingBlockers::ENABLE_NOT_CYCLED);
    }

    #[test]
    fn a_stopped_bus_forbids_arming_but_does_not_disarm() {
        let mut bench = Bench::new();
        bench.safety.verdict = SafetyVerdict::BusStop;
        bench.run(1);
        bench.flip_on();
        assert_eq!(bench.run(1).blockers, ArmingBlockers::SAFETY_STOP);
        bench.safety.verdict = SafetyVerdict::Run;
        assert_eq!(bench.run(1).state, ArmingState::Armed);
        bench.safety.verdict = SafetyVerdict::BusStop;
        assert_eq!(bench.run(10).state, ArmingState::Armed);
        bench.safety.verdict = SafetyVerdict::GlobalStop;
        assert_eq!(bench.run(1).state, ArmingState::Disarmed);
    }

    #[test]
    fn a_moment_of_doubt_disarms_and_is_no_flip_of_the_switch() {
        let mut bench = Bench::new();
        bench.run(1);
        bench.flip_on();
        assert_eq!(bench.run(1).state, ArmingState::Armed);
        bench.enabled = false;
        assert_eq!(bench.run(1).blockers, ArmingBlockers::ENABLE_OFF);
        bench.enabled = true;
        assert_eq!(bench.run(10).blockers, ArmingBlockers::ENABLE_NOT_CYCLED);
        (bench.enabled, bench.disabled) = (false, true);
        bench.run(1);
        bench.flip_on();
        assert_eq!(bench.run(1).state, ArmingState::Armed);
    }
}
