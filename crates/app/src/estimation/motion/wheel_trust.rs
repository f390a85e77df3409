//! Which wheel to believe, and how long to do without any.

use super::{
    slip::Grip,
    standstill::InertialSpeed,
    wheel_speed::{self, ForwardSpeeds},
    zero_velocity::WheelEvidence,
};

/// How long the accelerometer carries on alone: with the horizon 1° off the velocity is 0.34 m/s off by then.
const MAX_COAST_S: f32 = 2.0;
/// Wheels that rolled for so long without a break are proven.
const PROOF_S: f32 = 1.0;
/// Wheels that both roll agree with the gyro on how the robot turns, and so with each other within this, …
const DISAGREE_MPS: f32 = 0.3;
/// … unless one of them spins: the other is as fast as the robot within this.
const AGREE_MPS: f32 = 0.1;
/// A rim slower than this stands.
const STANDING_MPS: f32 = 0.02;

/// What the wheels say, as how much faster they run than the robot, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Word {
    /// At least one wheel rolls, and has for long enough to show what the accelerometer's offset is.
    Proven(f32),
    /// At least one wheel rolls, for now.
    Believed(f32),
    /// All that are heard slip, so they do not hold sideways either; the accelerometer carries on.
    Sliding,
    /// None is heard; the accelerometer carries on.
    Unheard,
    /// At least one wheel rolls again, or they slipped for so long that the accelerometer is no better: from here on the
    /// robot rolls straight on at this speed.
    Anew(f32),
    /// None is heard, and the accelerometer no longer counts either.
    None,
}

/// Wheel speeds less what the accelerometer says since a standstill.
#[derive(Clone, Copy, Debug)]
pub(super) struct InertialSurplus {
    surplus: ForwardSpeeds,
    tolerance_mps: f32,
}

impl InertialSurplus {
    pub fn new(speeds: ForwardSpeeds, inertial: &InertialSpeed) -> Self {
        Self {
            surplus: speeds.map(|speed| speed.map(|mps| mps - inertial.forward_mps)),
            tolerance_mps: inertial.tolerance_mps,
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct WheelTrust {
    grip: [Grip; 2],
    /// Since a wheel was last believed.
    coasting_s: f32,
    /// Since then without a break.
    rolling_s: f32,
}

impl WheelTrust {
    /// Has never heard a wheel.
    pub const fn new() -> Self {
        Self {
            grip: [Grip::Rolling; 2],
            coasting_s: MAX_COAST_S,
            rolling_s: 0.0,
        }
    }

    /// Too long without wheels for the accelerometer to count.
    pub fn is_lost(&self) -> bool {
        self.coasting_s >= MAX_COAST_S
    }

    /// `surplus`: wheel speeds less the robot's, and less what it can be after a standstill.
    pub fn step(
        &mut self,
        surplus: ForwardSpeeds,
        inertial: Option<InertialSurplus>,
        dt_s: f32,
    ) -> Word {
        if let Some(inertial) = inertial {
            self.leave_standstill(&inertial);
        }
        self.compare(surplus);
        let mut rolling = surplus;
        for (grip, surplus) in self.grip.iter_mut().zip(&mut rolling) {
            *grip = surplus.map_or(Grip::Rolling, |mps| grip.step(mps, dt_s));
            if !grip.rolls() {
                *surplus = None;
            }
        }
        if self.is_lost() {
            return self.start_over(surplus);
        }
        if let Some(surplus_mps) = wheel_speed::mean(rolling) {
            return self.roll(surplus_mps, dt_s);
        }
        self.rolling_s = 0.0;
        self.coasting_s += dt_s;
        if surplus == [None; 2] {
            Word::Unheard
        } else {
            Word::Sliding
        }
    }

    /// A wheel that the accelerometer has not seen speed up spins.
    fn leave_standstill(&mut self, inertial: &InertialSurplus) {
        for (grip, surplus) in self.grip.iter_mut().zip(inertial.surplus) {
            if grip.rolls() && surplus.is_some_and(|mps| mps.abs() > inertial.tolerance_mps) {
                *grip = Grip::SLIPPING;
            }
        }
    }

    /// Of two wheels that contradict the gyro the one that is as fast as the robot rolls, if there is one.
    fn compare(&mut self, surplus: ForwardSpeeds) {
        let both_roll = self.grip.iter().all(|grip| grip.rolls());
        if !both_roll || !contradict(surplus) {
            return;
        }
        for (grip, mps) in self.grip.iter_mut().zip(surplus) {
            if mps.is_some_and(|mps| mps.abs() > AGREE_MPS) {
                *grip = Grip::SLIPPING;
            }
        }
    }

    fn roll(&mut self, surplus_mps: f32, dt_s: f32) -> Word {
        if self.coasting_s > 0.0 {
            self.coasting_s = 0.0;
            return Word::Anew(surplus_mps);
        }
        if self.rolling_s < PROOF_S {
            self.rolling_s += dt_s;
            return Word::Believed(surplus_mps);
        }
        Word::Proven(surplus_mps)
    }

    fn start_over(&mut self, surplus: ForwardSpeeds) -> Word {
        let Some(surplus_mps) = wheel_speed::mean(nearer(surplus)) else {
            return Word::None;
        };
        self.grip = [Grip::Rolling; 2];
        self.coasting_s = 0.0;
        self.rolling_s = 0.0;
        Word::Anew(surplus_mps)
    }

    /// The robot stands still: wheels that stand say so rightly.
    pub fn confirm(&mut self) {
        self.coasting_s = 0.0;
        self.rolling_s = PROOF_S;
    }

    /// The robot stands still, its wheels spin.
    pub fn spin(&mut self, speeds: ForwardSpeeds, dt_s: f32) {
        for (grip, speed) in self.grip.iter_mut().zip(speeds) {
            *grip = speed.map_or(Grip::Rolling, |mps| grip.step_beside_rest(mps, dt_s));
        }
    }

    /// What the wheels say about standing still.
    pub fn evidence(&self, speeds: ForwardSpeeds) -> WheelEvidence {
        if speeds == [None; 2] {
            return WheelEvidence::Silent;
        }
        let mut evidence = WheelEvidence::Standing;
        for (speed, grip) in speeds.into_iter().zip(self.grip) {
            match speed {
                Some(_) if !grip.rolls() => evidence = WheelEvidence::Spinning,
                Some(mps) if mps.abs() > STANDING_MPS => return WheelEvidence::Turning,
                _ => {}
            }
        }
        evidence
    }
}

/// Two wheels that the gyro says cannot both roll.
fn contradict(surplus: ForwardSpeeds) -> bool {
    match surplus {
        [Some(left), Some(right)] => (left - right).abs() > DISAGREE_MPS,
        _ => false,
    }
}

/// Of two that contradict the gyro the one nearer to the speed known so far, unless that is far too.
fn nearer(surplus: ForwardSpeeds) -> ForwardSpeeds {
    if !contradict(surplus) {
        return surplus;
    }
    let near = |speed: Option<f32>| speed.filter(|mps| mps.abs() <= DISAGREE_MPS);
    match surplus.map(near) {
        [Some(left), Some(right)] if left.abs() <= right.abs() => [Some(left), None],
        [Some(_), Some(right)] => [None, Some(right)],
        one => one,
    }
}
