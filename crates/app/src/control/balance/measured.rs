//! The state of the robot in this tick, from sensors, motors and the estimate.

use super::tilt::Tilt;
use crate::{
    control::ChassisControllerInput,
    domain::{JointFeedback, JointState, LegGeometry, StateEstimate, WheelFeedback},
    kinematics::Leg,
    math::{Quaternion, scalar, vector},
};

/// Longest time in s over which a joint's angle is extrapolated from its report.
const MAX_AHEAD_S: f32 = 0.01;

/// Largest rate, speed, acceleration or torque in SI units.
const MAX_PLAUSIBLE: f32 = 1_000.0;

/// Angle of a thigh above the level in rad and its rate in rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thigh {
    pub rad: f32,
    pub rps: f32,
}

/// The state of the robot. Pairs are left, right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    pub tilt: Tilt,
    pub legs: [Leg; 2],
    /// Lean of each leg in rad and its rate in rad/s, positive with the hip ahead of the axle.
    pub lean_rad: [f32; 2],
    pub lean_rps: [f32; 2],
    /// Turn of each wheel in the world in rad/s, forward positive.
    pub wheel_rps: [f32; 2],
    /// Turn of each wheel's gear, against its shank, in rad/s, forward positive.
    pub gear_rps: [f32; 2],
    /// Ground speed of the axles' middle by the wheels in m/s.
    pub speed_mps: f32,
    /// The same by the estimate, in m/s.
    pub ground_mps: f32,
    /// Specific force along the vertical in m/s²; 9.8 at rest.
    pub up_mps2: f32,
    /// Torques of the hip joints as they report them, in N·m.
    pub hip_nm: [[f32; 2]; 2],
    /// Front and rear thigh of each leg.
    pub thighs: [[Thigh; 2]; 2],
    /// Everything above is known.
    pub known: bool,
}

impl Measured {
    pub fn new(geometry: &LegGeometry, input: &ChassisControllerInput<'_>) -> Self {
        let sensors = input.sensors;
        let [w, x, y, z] = input.estimate.q_wxyz;
        let gyro_rps = sensors.imu.gyro_dps.map(f32::to_radians);
        let rate_rps = vector::sub(gyro_rps, input.estimate.gyro_bias_rps);
        let tilt = Tilt::new(Quaternion { w, x, y, z }, rate_rps);
        let [left_front, left_rear, right_front, right_rear] = &sensors.motor.joints;
        let legs = [
            leg(geometry, left_front, left_rear),
            leg(geometry, right_front, right_rear),
        ];
        let odometry = input.wheel_odom_cfg;
        let [left_sign, right_sign] = odometry.rpm_signs();
        let [left, right] = &sensors.motor.wheels;
        let [left_leg, right_leg] = &legs;
        let rps = odometry.rps_per_rpm();
        let gear_rps = [
            f32::from(left.rpm) * left_sign * rps,
            f32::from(right.rpm) * right_sign * rps,
        ];
        let [left_gear_rps, right_gear_rps] = gear_rps;
        // The motor counts from its shank, which turns too.
        let wheel_rps = [
            left_gear_rps + left_leg.carrier_rps + rate_rps[1],
            right_gear_rps + right_leg.carrier_rps + rate_rps[1],
        ];
        let [left_rps, right_rps] = wheel_rps;
        let limit_us = input.wheel_ctrl_cfg.feedback_timeout_us;
        let heard = |wheel: &WheelFeedback| wheel.age_us <= limit_us;
        let ready = |joint: &JointFeedback| joint.state == JointState::Enabled;
        let mut measured = Self {
            ground_mps: ground_mps(input.estimate),
            lean_rad: legs.map(|leg| tilt.pitch_rad - leg.angle_rad),
            lean_rps: legs.map(|leg| tilt.pitch_rps - leg.angle_rps),
            wheel_rps,
            gear_rps,
            speed_mps: 0.5 * odometry.wheel_radius_m * (left_rps + right_rps),
            up_mps2: vector::dot(sensors.imu.accel_mps2, tilt.up),
            hip_nm: [
                [left_front.torque_nm, left_rear.torque_nm],
                [right_front.torque_nm, right_rear.torque_nm],
            ],
            thighs: [
                thighs(left_front, left_rear),
                thighs(right_front, right_rear),
            ],
            known: input.estimate.valid
                && sensors.motor.wheels.iter().all(heard)
                && sensors.motor.joints.iter().all(ready),
            tilt,
            legs,
        };
        measured.known &= measured.is_plausible();
        measured
    }

    /// False for what no robot does, NaN among it: filters would never forget it. `ground_mps` has to be a number; whether it
    /// can be used is the estimate's to say.
    fn is_plausible(&self) -> bool {
        let tilt = &self.tilt;
        let [left_rps, right_rps] = self.lean_rps;
        let [[left_front, left_rear], [right_front, right_rear]] = self.hip_nm;
        let motion = [
            tilt.pitch_rps,
            tilt.roll_rps,
            tilt.yaw_rps,
            left_rps,
            right_rps,
            self.speed_mps,
            self.up_mps2,
            left_front,
            left_rear,
            right_front,
            right_rear,
        ];
        motion.iter().all(|value| value.abs() < MAX_PLAUSIBLE) && self.ground_mps.is_finite()
    }

    /// Mean length of the legs in m.
    pub fn length_m(&self) -> f32 {
        let [left, right] = &self.legs;
        0.5 * (left.length_m + right.length_m)
    }

    /// Mean rate of the legs' length in m/s.
    pub fn length_mps(&self) -> f32 {
        let [left, right] = &self.legs;
        0.5 * (left.length_mps + right.length_mps)
    }

    /// Mean lean in rad.
    pub fn mean_lean_rad(&self) -> f32 {
        let [left, right] = self.lean_rad;
        0.5 * (left + right)
    }

    /// Mean rate of lean in rad/s.
    pub fn mean_lean_rps(&self) -> f32 {
        let [left, right] = self.lean_rps;
        0.5 * (left + right)
    }
}

#[cfg(test)]
impl Measured {
    /// A robot at rest, upright on both wheels. Its hips report no torque.
    pub fn at_rest() -> Self {
        let leg = Leg::new(
            &crate::domain::robots::FIVEBAR.balance.legs,
            [-0.4, 0.4],
            [0.0; 2],
        );
        let thigh = Thigh {
            rad: -0.4,
            rps: 0.0,
        };
        Self {
            tilt: Tilt::new(Quaternion::IDENTITY, [0.0; 3]),
            legs: [leg; 2],
            lean_rad: [0.0; 2],
            lean_rps: [0.0; 2],
            wheel_rps: [0.0; 2],
            gear_rps: [0.0; 2],
            speed_mps: 0.0,
            ground_mps: 0.0,
            up_mps2: 9.8,
            hip_nm: [[0.0; 2]; 2],
            thighs: [[thigh; 2]; 2],
            known: true,
        }
    }
}

/// Speed along the heading in m/s by the estimate.
fn ground_mps(estimate: &StateEstimate) -> f32 {
    let [w, x, y, z] = estimate.q_wxyz;
    let [east_mps, north_mps, _] = estimate.vel_mps;
    let (east, north) = (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z));
    (east_mps * east + north_mps * north) * scalar::inverse_sqrt(east * east + north * north)
}

/// A leg at the present time: its joints have moved on since they reported.
fn leg(geometry: &LegGeometry, front: &JointFeedback, rear: &JointFeedback) -> Leg {
    Leg::new(
        geometry,
        [angle_now_rad(front), angle_now_rad(rear)],
        [front.vel_rps, rear.vel_rps],
    )
}

fn thighs(front: &JointFeedback, rear: &JointFeedback) -> [Thigh; 2] {
    [
        Thigh {
            rad: front.pos_rad,
            rps: front.vel_rps,
        },
        Thigh {
            rad: -rear.pos_rad,
            rps: -rear.vel_rps,
        },
    ]
}

fn angle_now_rad(joint: &JointFeedback) -> f32 {
    let ahead_s = scalar::min(joint.age_us as f32 * 1e-6, MAX_AHEAD_S);
    joint.pos_rad + joint.vel_rps * ahead_s
}
