//! Velocity and position: the accelerometer predicts, the wheels correct.
//!
//! World frame: ENU. The point described is the middle of the axle. On a robot with moving legs the filter follows a point
//! of the body at the IMU's height above the hips, since that is what the accelerometer feels; legs and gyro lead from
//! there to the axle. The rest of the IMU's lever arm is not modelled; what it adds to the specific force counts as
//! accelerometer bias.

mod axes;
mod axle;
mod position;
mod slip;
mod standstill;
#[cfg(test)]
mod tests;
mod velocity_filter;
mod wheel_selection;
mod wheel_speed;
mod zero_velocity;

use self::{
    axes::Axes,
    position::Position,
    standstill::Standstill,
    velocity_filter::VelocityFilter,
    wheel_selection::{InertialInnovation, WheelAiding, WheelSelection},
    wheel_speed::{PerWheel, WheelSpeeds},
    zero_velocity::{WheelEvidence, ZeroVelocityDetector},
};
pub(super) use self::{axes::BodyPose, axle::AxlePath};
use crate::{
    domain::{MotorFeedback, WheelOdomConfig},
    math::{Vector3, vector},
};

/// Time constant with which the velocity decays while nothing measures it.
const DECAY_S: f32 = 0.5;
/// Velocity and position are extrapolated past the last sample for at most this long.
const MAX_AHEAD_S: f32 = 0.01;
/// Wheels that have stood for this long do not accelerate the robot: it stands, or somebody carries it.
const STANDING_S: f32 = 1.0;

/// One IMU sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct AccelSample {
    /// Specific force in body axes, the mean over `dt_s`. `None` if the sensor was saturated.
    pub accel_mps2: Option<Vector3>,
    /// Time since the sample before; 0 after a gap.
    pub dt_s: f32,
}

/// Estimates velocity, position and accelerometer bias.
#[derive(Clone, Debug)]
pub(super) struct MotionEstimator {
    wheels: WheelSpeeds,
    selection: WheelSelection,
    zero_velocity: ZeroVelocityDetector,
    standstill: Standstill,
    filter: VelocityFilter,
    position: Position,
    kinematic_mps2: Vector3,
    /// Time since a wheel last turned.
    wheels_stood_s: f32,
    /// The last sample showed a standstill, in which point and axle have the same velocity.
    pub stands: bool,
    /// Velocity of the point relative to the middle of the axle at the last sample, in ENU.
    over_axle_mps: Vector3,
}

impl MotionEstimator {
    pub fn new(config: &WheelOdomConfig) -> Self {
        Self {
            wheels: WheelSpeeds::new(config),
            selection: WheelSelection::new(),
            zero_velocity: ZeroVelocityDetector::new(),
            standstill: Standstill::new(),
            filter: VelocityFilter::new(),
            position: Position::new(),
            kinematic_mps2: [0.0; 3],
            wheels_stood_s: 0.0,
            stands: false,
            over_axle_mps: [0.0; 3],
        }
    }

    /// Changes the dimensions of the wheels. Velocity and position stay.
    pub fn set_config(&mut self, config: &WheelOdomConfig) {
        self.wheels = WheelSpeeds::new(config);
    }

    /// Goes on after a gap in time. Velocity and position stay, and the next wheel speed is used at once.
    pub fn restart(&mut self) {
        self.selection = WheelSelection::new();
        self.zero_velocity = ZeroVelocityDetector::new();
        self.standstill = Standstill::new();
    }

    /// Takes a sample that ended `age_s` ago. `pose`, `motor` and `legs` are those of the present.
    pub fn feed(
        &mut self,
        sample: &AccelSample,
        age_s: f32,
        pose: &BodyPose,
        motor: &MotorFeedback,
        legs: Option<&[AxlePath; 2]>,
    ) {
        let axes = Axes::new(pose);
        let over_axle_mps = match legs {
            Some(legs) => axes.over_axle(&AxlePath::mean(legs)),
            None => [0.0; 3],
        };
        let force_mps2 = match sample.accel_mps2 {
            Some(accel_mps2) => {
                // The body has rotated since the middle of the sample: transform the force to its present axes.
                let middle_s = age_s + 0.5 * sample.dt_s;
                let rotation = vector::cross(pose.rate_rps, accel_mps2);
                vector::sub(accel_mps2, vector::scale(rotation, middle_s))
            }
            None => {
                // A blow changed the speed by more than was measured. Wheels and legs show by how much.
                if legs.is_some() {
                    self.selection = WheelSelection::new();
                }
                self.filter.force_at_constant_speed(&axes)
            }
        };
        let free_mps2 = self.filter.free_accel(force_mps2, &axes);
        let speeds = self.wheels.forward_speeds(motor, &axes, legs);
        let wheels = self.selection.standstill_evidence(speeds);
        let forces = (force_mps2, free_mps2);
        let stood = self.standstill.persists();
        self.stands = self
            .zero_velocity
            .detect(forces, pose.rate_rps, wheels, stood, sample.dt_s);
        self.kinematic_mps2 = if self.stands {
            // A robot that balances creeps at a speed that only the wheels show.
            let creeping_mps = match legs {
                Some(_) => self.wheels.rolling_mps(motor, speeds),
                None => 0.0,
            };
            let rest_mps = axes.level_to_world([creeping_mps, 0.0, 0.0]);
            self.apply_standstill(free_mps2, speeds, wheels, rest_mps, &axes, sample.dt_s);
            [0.0; 3]
        } else {
            self.propagate(free_mps2, speeds, over_axle_mps, &axes, age_s, sample.dt_s)
        };
        self.wheels_stood_s = if wheel_speed::any_turns(motor) {
            0.0
        } else {
            self.wheels_stood_s + sample.dt_s
        };
        if self.wheels_stood_s > STANDING_S {
            self.kinematic_mps2 = [0.0; 3];
        }
        self.filter.limit();
        self.over_axle_mps = if self.stands {
            [0.0; 3]
        } else {
            axes.level_to_world(over_axle_mps)
        };
        let velocity_mps = self.axle_velocity_after(-0.5 * sample.dt_s);
        self.position.add(vector::scale(velocity_mps, sample.dt_s));
    }

    /// The robot stands: zero-velocity update.
    fn apply_standstill(
        &mut self,
        free_mps2: Vector3,
        speeds: PerWheel,
        wheels: WheelEvidence,
        rest_mps: Vector3,
        axes: &Axes,
        dt_s: f32,
    ) {
        if wheels == WheelEvidence::Spinning {
            self.filter.stop(dt_s);
            self.selection.spin(speeds, dt_s);
            let quiet = self.zero_velocity.is_quiet();
            self.standstill
                .prolong(axes.forward(free_mps2), quiet, dt_s);
            return;
        }
        self.filter.zero_velocity_update(free_mps2, rest_mps, dt_s);
        if wheels == WheelEvidence::Standing {
            self.selection.confirm_standstill();
            self.standstill.begin();
        }
    }

    /// The robot may move: prediction, and update with the wheels. Returns the robot's acceleration in body axes, or zero
    /// if the velocity was reset.
    fn propagate(
        &mut self,
        free_mps2: Vector3,
        speeds: PerWheel,
        [_, left_over_mps, up_over_mps]: Vector3,
        axes: &Axes,
        age_s: f32,
        dt_s: f32,
    ) -> Vector3 {
        let known = !self.selection.is_lost();
        self.filter
            .predict(if known { free_mps2 } else { [0.0; 3] }, axes, dt_s);
        let [forward_mps, left_mps, up_mps] = axes.to_level(self.filter.velocity_after(age_s));
        let innovation = speeds.map(|speed| speed.map(|speed_mps| speed_mps - forward_mps));
        let left_mps = left_over_mps - left_mps;
        if self.standstill.is_recent() {
            let quiet = self.zero_velocity.is_quiet();
            self.standstill
                .leave(axes.forward(free_mps2), axes.yaw_rps(), quiet, dt_s);
        }
        let inertial = self.standstill.inertial_speed();
        let inertial = inertial.map(|speed| InertialInnovation::new(speeds, &speed));
        let aiding = self.selection.step(innovation, inertial, dt_s);
        let (forward, left) = match aiding {
            WheelAiding::Trusted(innovation_mps) | WheelAiding::Provisional(innovation_mps) => {
                (innovation_mps, left_mps)
            }
            WheelAiding::Silent => (0.0, left_mps),
            WheelAiding::Slipping => (0.0, 0.0),
            WheelAiding::Reset(innovation_mps) => {
                let jump_mps = axes.level_to_world([innovation_mps, left_mps, 0.0]);
                self.filter.shift(jump_mps);
                return [0.0; 3];
            }
            WheelAiding::Lost => {
                self.filter.decay(dt_s / DECAY_S);
                return [0.0; 3];
            }
        };
        // A standstill has shown the bias better than the next seconds can.
        let update_bias = matches!(aiding, WheelAiding::Trusted(_)) && !self.standstill.is_recent();
        let innovation_mps = [forward, left, up_over_mps - up_mps];
        let correction_mps2 = self.filter.update(innovation_mps, axes, dt_s, update_bias);
        match aiding {
            WheelAiding::Trusted(_) => vector::add(free_mps2, correction_mps2),
            // The accelerometer alone: all of the force but gravity is motion.
            WheelAiding::Slipping | WheelAiding::Silent => {
                vector::add(free_mps2, self.filter.accel_bias_mps2())
            }
            WheelAiding::Provisional(_) | WheelAiding::Reset(_) | WheelAiding::Lost => [0.0; 3],
        }
    }

    /// Lets the velocity decay for another `dt_s` without an IMU sample.
    #[cold]
    pub fn decay(&mut self, dt_s: f32) {
        self.restart();
        self.filter.decay(dt_s / DECAY_S);
        self.over_axle_mps = [0.0; 3];
        let step_m = vector::scale(self.filter.velocity_after(0.0), dt_s);
        self.position.add(step_m);
    }

    fn axle_velocity_after(&self, ahead_s: f32) -> Vector3 {
        vector::sub(self.filter.velocity_after(ahead_s), self.over_axle_mps)
    }

    /// Velocity and position of the middle of the axle in ENU, extrapolated to `ahead_s` after the last sample.
    pub fn extrapolate(&self, ahead_s: f32) -> (Vector3, Vector3) {
        let ahead_s = if ahead_s < MAX_AHEAD_S {
            ahead_s
        } else {
            MAX_AHEAD_S
        };
        let velocity_mps = self.axle_velocity_after(ahead_s);
        let step_m = vector::scale(velocity_mps, ahead_s);
        (velocity_mps, vector::add(self.position.total_m(), step_m))
    }

    /// The robot's acceleration over the last sample, in body axes: the part of the specific force that is not gravity.
    /// Zero while the velocity is not known or the wheels stand.
    pub const fn kinematic_mps2(&self) -> Vector3 {
        self.kinematic_mps2
    }

    /// Accelerometer bias in body axes.
    pub const fn accel_bias_mps2(&self) -> Vector3 {
        self.filter.accel_bias_mps2()
    }
}
