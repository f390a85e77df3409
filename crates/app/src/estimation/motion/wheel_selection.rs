//! Selects the wheels that aid the velocity, and limits the time for which the accelerometer works without them.

use super::{
    slip::SlipState,
    standstill::InertialSpeed,
    wheel_speed::{self, PerWheel},
    zero_velocity::WheelEvidence,
};

/// Longest time without wheel aiding. A tilt error of 1° makes 0.34 m/s by then.
const MAX_UNAIDED_S: f32 = 2.0;
/// Time of rolling without interruption after which wheels are trusted.
const TRUSTED_AFTER_S: f32 = 1.0;
/// Largest difference of two rolling wheels, after the yaw rate is taken into account.
const MAX_DIFFERENCE_MPS: f32 = 0.3;
/// If two wheels differ by more, one whose speed is within this of the filter's still rolls.
const AGREE_MPS: f32 = 0.1;
/// A wheel slower than this counts as standing.
const STANDING_MPS: f32 = 0.02;

/// How the wheels aid the velocity filter. The innovations are wheel speed less predicted speed, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum WheelAiding {
    /// At least one wheel has rolled for long enough to correct the accelerometer bias too.
    Trusted(f32),
    /// At least one wheel rolls, but not for long.
    Provisional(f32),
    /// All wheels that report slip, so nothing holds the robot sideways either. The accelerometer works alone.
    Slipping,
    /// No wheel reports. The accelerometer works alone.
    Silent,
    /// The wheels are used again, because one rolls or because the accelerometer is no better by now. The forward speed
    /// is set to theirs, the speed to the left to zero.
    Reset(f32),
    /// No wheel reports, and the accelerometer alone is no longer accurate enough.
    Lost,
}

/// Innovation of the wheel speeds against the inertial speed since a standstill.
#[derive(Clone, Copy, Debug)]
pub(super) struct InertialInnovation {
    innovation: PerWheel,
    tolerance_mps: f32,
}

impl InertialInnovation {
    pub fn new(speeds: PerWheel, inertial: &InertialSpeed) -> Self {
        Self {
            innovation: speeds.map(|speed| speed.map(|mps| mps - inertial.forward_mps)),
            tolerance_mps: inertial.tolerance_mps,
        }
    }
}

/// Follows both wheels and decides what they contribute.
#[derive(Clone, Copy, Debug)]
pub(super) struct WheelSelection {
    slip: [SlipState; 2],
    /// Time since a wheel last aided the filter.
    unaided_s: f32,
    /// Time for which wheels have aided it without interruption.
    rolling_s: f32,
}

impl WheelSelection {
    /// The state before any wheel has reported.
    pub const fn new() -> Self {
        Self {
            slip: [SlipState::Rolling; 2],
            unaided_s: MAX_UNAIDED_S,
            rolling_s: 0.0,
        }
    }

    /// True if the accelerometer has been alone for too long.
    pub fn is_lost(&self) -> bool {
        self.unaided_s >= MAX_UNAIDED_S
    }

    /// Takes the innovations of the wheels against the filter's speed and, soon after a standstill, against the inertial
    /// speed.
    pub fn step(
        &mut self,
        innovation: PerWheel,
        inertial: Option<InertialInnovation>,
        dt_s: f32,
    ) -> WheelAiding {
        if let Some(inertial) = inertial {
            self.gate_after_standstill(&inertial);
        }
        self.reject_inconsistent(innovation);
        let mut rolling = innovation;
        for (slip, innovation) in self.slip.iter_mut().zip(&mut rolling) {
            *slip = innovation.map_or(SlipState::Rolling, |mps| slip.step(mps, dt_s));
            if !slip.is_rolling() {
                *innovation = None;
            }
        }
        if self.is_lost() {
            return self.reinitialise(innovation);
        }
        if let Some(innovation_mps) = wheel_speed::mean(rolling) {
            return self.roll(innovation_mps, dt_s);
        }
        self.rolling_s = 0.0;
        self.unaided_s += dt_s;
        if matches!(innovation, [None, None]) {
            WheelAiding::Silent
        } else {
            WheelAiding::Slipping
        }
    }

    /// Marks wheels as slipping whose acceleration the accelerometer has not measured.
    fn gate_after_standstill(&mut self, inertial: &InertialInnovation) {
        for (slip, innovation) in self.slip.iter_mut().zip(inertial.innovation) {
            let spins = innovation.is_some_and(|mps| mps.abs() > inertial.tolerance_mps);
            if slip.is_rolling() && spins {
                *slip = SlipState::SLIPPING;
            }
        }
    }

    /// If two wheels contradict the yaw rate, only one that agrees with the filter's speed still rolls.
    fn reject_inconsistent(&mut self, innovation: PerWheel) {
        let both_roll = self.slip.iter().all(|slip| slip.is_rolling());
        if !both_roll || !are_inconsistent(innovation) {
            return;
        }
        for (slip, mps) in self.slip.iter_mut().zip(innovation) {
            if mps.is_some_and(|mps| mps.abs() > AGREE_MPS) {
                *slip = SlipState::SLIPPING;
            }
        }
    }

    fn roll(&mut self, innovation_mps: f32, dt_s: f32) -> WheelAiding {
        if self.unaided_s > 0.0 {
            self.unaided_s = 0.0;
            return WheelAiding::Reset(innovation_mps);
        }
        if self.rolling_s < TRUSTED_AFTER_S {
            self.rolling_s += dt_s;
            return WheelAiding::Provisional(innovation_mps);
        }
        WheelAiding::Trusted(innovation_mps)
    }

    fn reinitialise(&mut self, innovation: PerWheel) -> WheelAiding {
        let Some(innovation_mps) = wheel_speed::mean(consistent(innovation)) else {
            return WheelAiding::Lost;
        };
        self.slip = [SlipState::Rolling; 2];
        self.unaided_s = 0.0;
        self.rolling_s = 0.0;
        WheelAiding::Reset(innovation_mps)
    }

    /// The robot stands and so do its wheels, which makes them trusted.
    pub fn confirm_standstill(&mut self) {
        self.unaided_s = 0.0;
        self.rolling_s = TRUSTED_AFTER_S;
    }

    /// The robot stands, but its wheels spin.
    pub fn spin(&mut self, speeds: PerWheel, dt_s: f32) {
        for (slip, speed) in self.slip.iter_mut().zip(speeds) {
            *slip = speed.map_or(SlipState::Rolling, |mps| slip.step_at_standstill(mps, dt_s));
        }
    }

    /// The wheels' evidence of a standstill.
    pub fn standstill_evidence(&self, speeds: PerWheel) -> WheelEvidence {
        if matches!(speeds, [None, None]) {
            return WheelEvidence::Silent;
        }
        let mut evidence = WheelEvidence::Standing;
        for (speed, slip) in speeds.into_iter().zip(self.slip) {
            match speed {
                Some(_) if !slip.is_rolling() => evidence = WheelEvidence::Spinning,
                Some(mps) if mps.abs() > STANDING_MPS => return WheelEvidence::Turning,
                _ => {}
            }
        }
        evidence
    }
}

/// True for two wheels that cannot both roll at the measured yaw rate.
fn are_inconsistent(innovation: PerWheel) -> bool {
    match innovation {
        [Some(left), Some(right)] => (left - right).abs() > MAX_DIFFERENCE_MPS,
        _ => false,
    }
}

/// Keeps the one of two inconsistent wheels that is nearer to the filter's speed, or none if both are far from it.
fn consistent(innovation: PerWheel) -> PerWheel {
    if !are_inconsistent(innovation) {
        return innovation;
    }
    let near = |speed: Option<f32>| speed.filter(|mps| mps.abs() <= MAX_DIFFERENCE_MPS);
    match innovation.map(near) {
        [Some(left), Some(right)] if left.abs() <= right.abs() => [Some(left), None],
        [Some(_), Some(right)] => [None, Some(right)],
        one => one,
    }
}
