//! The free robot as the world sees it: mechanics, full turns, what its wheels shake, and the IMU at its place.

use std::f64::consts::{PI, TAU};

use robot_description::Robot;

use super::{BodyInputs, Floor, pose::Pose, shove::Shove, vibration::Vibration};
use crate::{
    attitude::{Quaternion, roll_pitch_yaw_rad, to_earth},
    free::{FreeBody, FreeInputs, FreeSetup, FreeState, Hold},
    motion::Motion,
};

/// What water on ice leaves of the ground's friction.
const SLIPPERY: f64 = 0.06;

/// A robot that nothing holds.
#[derive(Clone)]
pub(crate) struct Loose {
    body: FreeBody,
    imu_m: [f64; 3],
    vibration: Vibration,
    shove: Shove,
    pose: Pose,
    attitude: Quaternion,
    motion: Motion,
}

impl Loose {
    pub(super) fn new(robot: &Robot, setup: &FreeSetup) -> Self {
        let body = FreeBody::new(robot, setup);
        let mut loose = Self {
            shove: Shove::new(body.mass_kg()),
            imu_m: robot.imu.place_m,
            vibration: Vibration::new(robot.wheels.gear_ratio),
            pose: Pose::default(),
            attitude: body.state().attitude,
            motion: Motion {
                accel_mps2: [0.0; 3],
                gyro_rps: [0.0; 3],
            },
            body,
        };
        loose.look(0.0);
        loose
    }

    pub(super) fn step(&mut self, inputs: &BodyInputs, dt_s: f64) {
        let shoved = self.shove.step(inputs.stance, self.pose.yaw_rad, dt_s);
        let inputs = FreeInputs {
            wheel_nm: inputs.wheel_nm,
            joint_nm: inputs.joint_nm,
            wheel_dry_nm: inputs.wheel_friction.dry_nm,
            wheel_viscous_nm_per_rps: inputs.wheel_friction.viscous_nm_per_rps,
            joint_dry_nm: inputs.joint_friction_nm,
            push: inputs.outside.or(shoved),
            grip: match inputs.floor {
                Floor::Clean => 1.0,
                Floor::Slippery => SLIPPERY,
            },
            ..FreeInputs::default()
        };
        self.body.step(&inputs, dt_s);
        self.look(dt_s);
    }

    /// Takes pose and motion from the mechanics, after a step of this length.
    fn look(&mut self, dt_s: f64) {
        let state = self.body.state();
        self.attitude = state.attitude;
        let [.., yaw_rad] = roll_pitch_yaw_rad(state.attitude);
        let turned_rad = (yaw_rad - self.pose.yaw_rad + PI).rem_euclid(TAU) - PI;
        let heading_rad = self.pose.yaw_rad + turned_rad;
        let (sin, cos) = heading_rad.sin_cos();
        let [vx, vy, vz] = state.velocity_mps;
        let forward_mps = cos * vx + sin * vy;
        let [.., wz_rps] = to_earth(state.attitude, state.rate_rps);
        let [x_m, y_m, z_m] = state.position_m;
        self.pose = Pose {
            x_m,
            y_m,
            z_m,
            yaw_rad: heading_rad,
            path_m: self.pose.path_m + forward_mps * dt_s,
            vx_mps: forward_mps,
            vy_mps: cos * vy - sin * vx,
            vz_mps: vz,
            wz_rps,
        };
        let shaken = self.vibration.accel_mps2(state.wheel_rad, state.wheel_rps);
        let force = self.body.specific_force_at(self.imu_m);
        self.motion = Motion {
            accel_mps2: std::array::from_fn(|axis| force[axis] + shaken[axis]),
            gyro_rps: state.rate_rps,
        };
    }

    /// Puts the robot into a state, held or not.
    pub(super) fn place(&mut self, state: &FreeState, hold: Hold) {
        self.body.set_hold(hold);
        self.body.set_state(state);
        self.look(0.0);
    }

    /// The mechanics.
    pub(crate) fn mechanics(&self) -> &FreeBody {
        &self.body
    }

    pub(super) fn pose(&self) -> Pose {
        self.pose
    }

    pub(super) fn attitude(&self) -> Quaternion {
        self.attitude
    }

    pub(super) fn motion(&self) -> Motion {
        self.motion
    }
}
