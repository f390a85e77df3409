//! Upright body on flat ground: planar motion and yaw, two wheels whose grip is limited by friction.
//!
//! Balance is taken for granted: pitch and roll stay zero.

use super::{
    floor::Floor,
    pose::Pose,
    shaft::turn_shaft,
    wheels::{WHEEL_INERTIA_KGM2, WheelTorques},
};
use robot_description::Wheels;

use crate::{m3508::Friction, motion::Motion, physics::STANDARD_GRAVITY_MPS2};

/// Robot with legs and wheels, kg (docs/hardware.md#robot-body).
const MASS_KG: f64 = 9.0;
/// About z: a 0.3 m square body of 7.5 kg and two wheels of 0.75 kg at half the track.
const YAW_INERTIA_KGM2: f64 = 0.18;
/// Assumed share of the grip per unit of slip ratio: 10 % slip uses the full grip.
const SLIP_STIFFNESS: f64 = 10.0;
/// Least reference speed of the slip ratio, which keeps it finite at rest.
const SLIP_REFERENCE_MPS: f64 = 0.1;
/// Assumed rolling resistance per newton of load.
const ROLLING_RESISTANCE: f64 = 0.015;
const LOAD_N: f64 = MASS_KG * STANDARD_GRAVITY_MPS2 / 2.0;
/// Assumed place of the IMU relative to the middle of the axle, m: x forward, y left.
const IMU_M: [f64; 2] = [0.05, 0.02];

#[derive(Clone, Copy, Debug)]
pub(crate) struct Rolling {
    radius_m: f64,
    track_m: f64,
    pose: Pose,
    wheel_rps: [f64; 2],
    /// Acceleration of the axle's middle in body axes over the last step.
    accel_mps2: [f64; 2],
    yaw_accel_rps2: f64,
}

impl Rolling {
    /// At rest on these wheels.
    pub(crate) fn new(wheels: &Wheels) -> Self {
        Self {
            radius_m: wheels.radius_m,
            track_m: wheels.track_m,
            pose: Pose::default(),
            wheel_rps: [0.0; 2],
            accel_mps2: [0.0; 2],
            yaw_accel_rps2: 0.0,
        }
    }

    pub(crate) fn step(
        &mut self,
        torques_nm: WheelTorques,
        friction: Friction,
        floor: Floor,
        dt_s: f64,
    ) {
        let rolling_friction = Friction {
            dry_nm: friction.dry_nm + ROLLING_RESISTANCE * LOAD_N * self.radius_m,
            ..friction
        };
        let forces: [[f64; 2]; 2] = std::array::from_fn(|wheel| self.ground_force_n(wheel, floor));
        for wheel in 0..2 {
            self.wheel_rps[wheel] = turn_shaft(
                self.wheel_rps[wheel],
                torques_nm[wheel] - forces[wheel][0] * self.radius_m,
                rolling_friction,
                WHEEL_INERTIA_KGM2,
                dt_s,
            );
        }
        self.accel_mps2 = [
            (forces[0][0] + forces[1][0]) / MASS_KG,
            (forces[0][1] + forces[1][1]) / MASS_KG,
        ];
        self.yaw_accel_rps2 = (forces[1][0] - forces[0][0]) * self.track_m / 2.0 / YAW_INERTIA_KGM2;
        self.integrate(dt_s);
    }

    /// Force of the ground on one wheel, forward and left, from its slip.
    fn ground_force_n(&self, wheel: usize, floor: Floor) -> [f64; 2] {
        let side = if wheel == 0 { -1.0 } else { 1.0 };
        let over_ground_mps = self.pose.vx_mps + side * self.pose.wz_rps * self.track_m / 2.0;
        let rim_mps = self.wheel_rps[wheel] * self.radius_m;
        let reference_mps = rim_mps
            .abs()
            .max(over_ground_mps.abs())
            .max(SLIP_REFERENCE_MPS);
        let slip = [
            (rim_mps - over_ground_mps) / reference_mps,
            -self.pose.vy_mps / reference_mps,
        ];
        let magnitude = slip[0].hypot(slip[1]);
        if magnitude == 0.0 {
            return [0.0; 2];
        }
        let force_n = floor.grip() * LOAD_N * (SLIP_STIFFNESS * magnitude).min(1.0);
        slip.map(|component| component / magnitude * force_n)
    }

    fn integrate(&mut self, dt_s: f64) {
        let pose = &mut self.pose;
        // Body axes turn under the velocity, hence the cross terms.
        let (vx, vy, wz) = (pose.vx_mps, pose.vy_mps, pose.wz_rps);
        pose.vx_mps += (self.accel_mps2[0] + wz * vy) * dt_s;
        pose.vy_mps += (self.accel_mps2[1] - wz * vx) * dt_s;
        pose.wz_rps += self.yaw_accel_rps2 * dt_s;
        pose.yaw_rad += pose.wz_rps * dt_s;
        pose.path_m += pose.vx_mps * dt_s;
        let (sin, cos) = pose.yaw_rad.sin_cos();
        pose.x_m += (pose.vx_mps * cos - pose.vy_mps * sin) * dt_s;
        pose.y_m += (pose.vx_mps * sin + pose.vy_mps * cos) * dt_s;
    }

    pub(crate) fn wheel_rps(&self) -> [f64; 2] {
        self.wheel_rps
    }

    pub(crate) fn pose(&self) -> Pose {
        self.pose
    }

    /// Motion at the IMU: that of the axle, with the tangential and centripetal terms of the lever.
    pub(crate) fn motion(&self) -> Motion {
        let [rx, ry] = IMU_M;
        let wz = self.pose.wz_rps;
        Motion {
            accel_mps2: [
                self.accel_mps2[0] - self.yaw_accel_rps2 * ry - wz * wz * rx,
                self.accel_mps2[1] + self.yaw_accel_rps2 * rx - wz * wz * ry,
                STANDARD_GRAVITY_MPS2,
            ],
            gyro_rps: [0.0, 0.0, wz],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots;
    use robot_description::JointMotor;

    const DT_S: f64 = 250e-6;
    const FRICTIONLESS: Friction = Friction {
        dry_nm: 0.0,
        viscous_nm_per_rps: 0.0,
    };

    fn rolling() -> Rolling {
        Rolling::new(&robots::with_joints(JointMotor::Dm4310).wheels)
    }

    fn drive(rolling: &mut Rolling, seconds: f64, torques: impl Fn(&Rolling) -> WheelTorques) {
        for _ in 0..(seconds / DT_S).round() as usize {
            let torques_nm = torques(rolling);
            rolling.step(torques_nm, FRICTIONLESS, Floor::Clean, DT_S);
        }
    }

    /// Torques of a stiff speed loop, so that the wheels run at the given rim speeds in m/s.
    fn hold(rim_mps: [f64; 2]) -> impl Fn(&Rolling) -> WheelTorques {
        move |rolling| {
            std::array::from_fn(|wheel| {
                5.0 * (rim_mps[wheel] / rolling.radius_m - rolling.wheel_rps[wheel])
            })
        }
    }

    #[test]
    fn equal_torques_accelerate_straight_by_newtons_law() {
        let mut rolling = rolling();
        drive(&mut rolling, 1.0, |_| [0.6, 0.6]);
        // (2·0.6/0.075 − 2·0.015·44.13) N on 9 kg and two reflected wheel inertias of 0.0105/0.075² = 1.867 kg.
        let expected = (16.0 - 1.324) / (9.0 + 3.733);
        assert!(
            (rolling.pose.vx_mps - expected).abs() < 0.02,
            "{}",
            rolling.pose.vx_mps
        );
        assert!(rolling.pose.y_m.abs() < 1e-9 && rolling.pose.wz_rps.abs() < 1e-9);
        assert!((rolling.pose.x_m - 0.5 * expected).abs() < 0.02);
    }

    #[test]
    fn wheel_speed_difference_over_track_is_the_yaw_rate() {
        let mut rolling = rolling();
        drive(&mut rolling, 3.0, hold([0.4, 0.6]));
        // 0.2 m/s over 0.42 m = 0.476 rad/s to the left at 0.5 m/s.
        assert!(
            (rolling.pose.wz_rps - 0.476).abs() < 0.01,
            "{}",
            rolling.pose.wz_rps
        );
        assert!((rolling.pose.vx_mps - 0.5).abs() < 0.01);
        // Three seconds less the run-up, at speeds whose ratio is the radius of the circle.
        let pose = rolling.pose;
        assert!((1.35..1.5).contains(&pose.path_m), "{}", pose.path_m);
        assert!((pose.path_m / pose.yaw_rad - 0.5 / 0.476).abs() < 0.05);
        let motion = rolling.motion();
        assert!((motion.gyro_rps[2] - rolling.pose.wz_rps).abs() < 1e-12);
        // Centripetal: v·wz to the left plus the lever −wz²·0.02; −wz²·0.05 backward.
        assert!((motion.accel_mps2[1] - (0.5 * 0.476 - 0.0045)).abs() < 0.01);
        assert!((motion.accel_mps2[0] + 0.0113).abs() < 0.01);
        assert_eq!(motion.accel_mps2[2], 9.80665);
    }

    #[test]
    fn full_torque_spins_the_wheels_and_grip_limits_the_body() {
        let mut rolling = rolling();
        drive(&mut rolling, 0.3, |_| [6.0, 6.0]);
        // µ·g = 7.85 m/s² is the most the ground gives.
        assert!((rolling.pose.vx_mps - 0.3 * 0.8 * 9.80665).abs() < 0.05);
        assert!(rolling.wheel_rps[0] * rolling.radius_m > 2.0 * rolling.pose.vx_mps);
    }

    #[test]
    fn energy_never_grows_while_coasting_and_the_robot_comes_to_rest() {
        let mut rolling = rolling();
        drive(&mut rolling, 2.0, hold([0.9, 1.1]));
        let energy = |r: &Rolling| {
            0.5 * MASS_KG * (r.pose.vx_mps.powi(2) + r.pose.vy_mps.powi(2))
                + 0.5 * YAW_INERTIA_KGM2 * r.pose.wz_rps.powi(2)
                + 0.5 * WHEEL_INERTIA_KGM2 * r.wheel_rps.iter().map(|w| w * w).sum::<f64>()
        };
        let mut before = energy(&rolling);
        for _ in 0..80 {
            drive(&mut rolling, 0.5, |_| [0.0, 0.0]);
            assert!(energy(&rolling) <= before + 1e-9);
            before = energy(&rolling);
        }
        assert!(before < 1e-3, "{before} J left");
    }
}
