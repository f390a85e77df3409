//! How fast and where: the accelerometer carries the velocity on, the wheels correct it.
//!
//! World frame: ENU. The point meant is the middle of the axle. That the IMU sits elsewhere is not modelled: what it
//! feels for that reason counts as an offset of the accelerometer.

mod axes;
mod position;
mod slip;
mod standstill;
#[cfg(test)]
mod tests;
mod velocity_filter;
mod wheel_speed;
mod wheel_trust;
mod zero_velocity;

use self::{
    axes::Axes,
    position::Position,
    standstill::Standstill,
    velocity_filter::VelocityFilter,
    wheel_speed::{ForwardSpeeds, WheelSpeeds},
    wheel_trust::{InertialSurplus, WheelTrust, Word},
    zero_velocity::{WheelEvidence, ZeroVelocity},
};
use crate::{
    domain::{MotorFeedback, WheelOdomConfig},
    math::{Quaternion, Vector3, vector},
};

/// With nothing left to go by the robot is taken to come to rest with this time constant.
const LEAK_S: f32 = 0.5;
/// Velocity and position are carried past the last sample for at most this long.
const MAX_AHEAD_S: f32 = 0.01;

/// Wheels that have stood for so long do not accelerate a robot: it stands too, or somebody carries it.
const STANDING_S: f32 = 1.0;

/// How the body lies and turns now.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyPose {
    /// Body → world.
    pub orientation: Quaternion,
    /// In body axes, without offset.
    pub rate_rps: Vector3,
}

/// One IMU sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct AccelSample {
    /// Specific force in body axes, the mean over `dt_s`; none if it went beyond the sensor's range.
    pub accel_mps2: Option<Vector3>,
    /// Since the sample before, 0 if that is too long ago.
    pub dt_s: f32,
}

#[derive(Clone, Debug)]
pub(super) struct MotionEstimator {
    wheels: WheelSpeeds,
    trust: WheelTrust,
    zero_velocity: ZeroVelocity,
    standstill: Standstill,
    filter: VelocityFilter,
    position: Position,
    kinematic_mps2: Vector3,
    /// Since a wheel turned.
    wheels_stood_s: f32,
}

impl MotionEstimator {
    pub fn new(config: &WheelOdomConfig) -> Self {
        Self {
            wheels: WheelSpeeds::new(config),
            trust: WheelTrust::new(),
            zero_velocity: ZeroVelocity::new(),
            standstill: Standstill::new(),
            filter: VelocityFilter::new(),
            position: Position::new(),
            kinematic_mps2: [0.0; 3],
            wheels_stood_s: 0.0,
        }
    }

    /// Other wheels from now on; velocity and the way so far stay.
    pub fn set_config(&mut self, config: &WheelOdomConfig) {
        self.wheels = WheelSpeeds::new(config);
    }

    /// After a gap in time: the next wheel is believed at once. Velocity and the way so far stay.
    pub fn restart(&mut self) {
        self.trust = WheelTrust::new();
        self.zero_velocity = ZeroVelocity::new();
        self.standstill = Standstill::new();
    }

    /// Takes a new sample, which ended `age_s` ago; `pose` and `motor` are those of now.
    #[inline(never)]
    pub fn feed(
        &mut self,
        sample: &AccelSample,
        age_s: f32,
        pose: &BodyPose,
        motor: &MotorFeedback,
    ) {
        let axes = Axes::new(pose);
        let felt_mps2 = match sample.accel_mps2 {
            Some(accel_mps2) => {
                // The body has turned since the middle of the sample: the same force in the axes of now.
                let middle_s = age_s + 0.5 * sample.dt_s;
                let turn = vector::cross(pose.rate_rps, accel_mps2);
                vector::sub(accel_mps2, vector::scale(turn, middle_s))
            }
            None => self.filter.force_at_constant_speed(&axes),
        };
        let free_mps2 = self.filter.free_accel(felt_mps2, &axes);
        let speeds = self.wheels.forward_speeds(motor, &axes);
        let wheels = self.trust.evidence(speeds);
        let felt = (felt_mps2, free_mps2);
        let stood = self.standstill.lasts();
        self.kinematic_mps2 =
            if self
                .zero_velocity
                .feed(felt, pose.rate_rps, wheels, stood, sample.dt_s)
            {
                self.stand(free_mps2, speeds, wheels, &axes, sample.dt_s);
                [0.0; 3]
            } else {
                self.carry_on(free_mps2, speeds, &axes, age_s, sample.dt_s)
            };
        self.wheels_stood_s = if wheel_speed::any_turns(motor) {
            0.0
        } else {
            self.wheels_stood_s + sample.dt_s
        };
        if self.wheels_stood_s > STANDING_S {
            self.kinematic_mps2 = [0.0; 3];
        }
        self.filter.stay_plausible();
        let step_m = vector::scale(self.filter.velocity_after(-0.5 * sample.dt_s), sample.dt_s);
        self.position.add(step_m);
    }

    fn stand(
        &mut self,
        free_mps2: Vector3,
        speeds: ForwardSpeeds,
        wheels: WheelEvidence,
        axes: &Axes,
        dt_s: f32,
    ) {
        if wheels == WheelEvidence::Spinning {
            self.filter.stop(dt_s);
            self.trust.spin(speeds, dt_s);
            self.standstill
                .go_on(axes.forward(free_mps2), self.zero_velocity.is_quiet(), dt_s);
            return;
        }
        self.filter.hold_still(free_mps2, dt_s);
        if wheels == WheelEvidence::Standing {
            self.trust.confirm();
            self.standstill.begin();
        }
    }

    /// What accelerated the robot, in body axes; nothing if the velocity was set anew.
    fn carry_on(
        &mut self,
        free_mps2: Vector3,
        speeds: ForwardSpeeds,
        axes: &Axes,
        age_s: f32,
        dt_s: f32,
    ) -> Vector3 {
        let known = !self.trust.is_lost();
        self.filter
            .predict(if known { free_mps2 } else { [0.0; 3] }, axes, dt_s);
        let [forward_mps, left_mps, up_mps] = axes.flat(self.filter.velocity_after(age_s));
        let surplus = speeds.map(|speed| speed.map(|speed_mps| speed_mps - forward_mps));
        if self.standstill.counts() {
            let quiet = self.zero_velocity.is_quiet();
            self.standstill
                .leave(axes.forward(free_mps2), axes.yaw_rps(), quiet, dt_s);
        }
        let inertial = self.standstill.speed();
        let inertial = inertial.map(|speed| InertialSurplus::new(speeds, &speed));
        let word = self.trust.step(surplus, inertial, dt_s);
        let (forward, left) = match word {
            Word::Proven(surplus_mps) | Word::Believed(surplus_mps) => (surplus_mps, -left_mps),
            Word::Unheard => (0.0, -left_mps),
            Word::Sliding => (0.0, 0.0),
            Word::Anew(surplus_mps) => {
                let jump_mps = axes.flat_to_world([surplus_mps, -left_mps, 0.0]);
                self.filter.shift(jump_mps);
                return [0.0; 3];
            }
            Word::None => {
                self.filter.leak(dt_s / LEAK_S);
                return [0.0; 3];
            }
        };
        // What a standstill has shown of the offset is better than anything in the next seconds.
        let learning = matches!(word, Word::Proven(_)) && !self.standstill.counts();
        let innovation_mps = [forward, left, -up_mps];
        let gained_mps2 = self.filter.correct(innovation_mps, axes, dt_s, learning);
        match word {
            Word::Proven(_) => vector::add(free_mps2, gained_mps2),
            // The accelerometer is busy with the motion: all of the force but gravity as it is believed.
            Word::Sliding | Word::Unheard => vector::add(free_mps2, self.filter.accel_bias_mps2()),
            Word::Believed(_) | Word::Anew(_) | Word::None => [0.0; 3],
        }
    }

    /// `dt_s` more without a sample: the IMU is silent, and the velocity fades.
    #[cold]
    pub fn fade(&mut self, dt_s: f32) {
        self.restart();
        self.filter.leak(dt_s / LEAK_S);
        let step_m = vector::scale(self.filter.velocity_after(0.0), dt_s);
        self.position.add(step_m);
    }

    /// Velocity and position in the world frame, `ahead_s` after the last sample.
    pub fn after(&self, ahead_s: f32) -> (Vector3, Vector3) {
        let ahead_s = if ahead_s < MAX_AHEAD_S {
            ahead_s
        } else {
            MAX_AHEAD_S
        };
        let velocity_mps = self.filter.velocity_after(ahead_s);
        let way_m = vector::scale(velocity_mps, ahead_s);
        (velocity_mps, vector::add(self.position.total_m(), way_m))
    }

    /// What accelerated the robot over the last sample, in body axes: the part of a specific force that is not gravity.
    /// Zero while the velocity is not known or the wheels stand.
    pub const fn kinematic_mps2(&self) -> Vector3 {
        self.kinematic_mps2
    }

    /// Body axes.
    pub const fn accel_bias_mps2(&self) -> Vector3 {
        self.filter.accel_bias_mps2()
    }
}
