//! Body clamped level on a stand, wheels in the air.

use super::{
    shaft::turn_shaft,
    wheels::{WHEEL_INERTIA_KGM2, WheelTorques},
};
use crate::{m3508::Friction, motion::Motion, physics::STANDARD_GRAVITY_MPS2};

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stand {
    wheel_rps: [f64; 2],
}

impl Stand {
    pub(crate) fn step(&mut self, torques_nm: WheelTorques, friction: Friction, dt_s: f64) {
        for (rps, torque_nm) in self.wheel_rps.iter_mut().zip(torques_nm) {
            *rps = turn_shaft(*rps, torque_nm, friction, WHEEL_INERTIA_KGM2, dt_s);
        }
    }

    pub(crate) fn wheel_rps(&self) -> [f64; 2] {
        self.wheel_rps
    }

    pub(crate) fn motion(&self) -> Motion {
        Motion {
            accel_mps2: [0.0, 0.0, STANDARD_GRAVITY_MPS2],
            gyro_rps: [0.0; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{m3508::M3508, robots};
    use robot_description::JointMotor;

    fn motor() -> M3508 {
        M3508::new(&robots::with_joints(JointMotor::Dm4310).wheels)
    }

    /// Runs one motor at a wanted current and supply until it is steady: (output rpm, current in A).
    fn steady_state(wanted_a: f64, supply_v: f64) -> (f64, f64) {
        let dt_s = 250e-6;
        let mut stand = Stand::default();
        let mut motor = motor();
        for _ in 0..40_000 {
            motor.step(wanted_a, stand.wheel_rps[0], supply_v, 0.22, dt_s);
            stand.step([motor.torque_nm(), 0.0], motor.friction(), dt_s);
        }
        let rpm = stand.wheel_rps[0] * 60.0 / std::f64::consts::TAU;
        (rpm, motor.current_a())
    }

    // M3508 datasheet: 482 rpm and 0.78 A without load at 24 V.
    #[test]
    fn full_command_without_load_ends_at_the_datasheet_speed_and_current() {
        let (rpm, current_a) = steady_state(20.0, 24.0);
        assert!((rpm - 482.0).abs() < 1.0, "{rpm} rpm");
        assert!((current_a - 0.78).abs() < 0.01, "{current_a} A");
        assert!((rpm * 3591.0 / 187.0 - 9_256.0).abs() < 30.0);
        let (reverse_rpm, _) = steady_state(-20.0, 24.0);
        assert!((reverse_rpm + rpm).abs() < 1e-6);
    }

    #[test]
    fn half_the_supply_gives_about_half_the_speed() {
        let (rpm, _) = steady_state(20.0, 12.0);
        assert!((rpm / 482.0 - 0.5).abs() < 0.01, "{rpm} rpm");
    }

    #[test]
    fn a_current_below_dry_friction_does_not_move_the_wheel() {
        assert_eq!(steady_state(0.4, 24.0).0, 0.0);
    }

    #[test]
    fn torque_accelerates_the_wheel_by_newtons_law() {
        // 1 N·m less friction on 0.0105 kg·m² for 0.1 s: 9.52 rad/s less 0.1404/0.0105·0.1 = 1.34 and viscous drag.
        let mut stand = Stand::default();
        for _ in 0..400 {
            stand.step([1.0, -1.0], motor().friction(), 250e-6);
        }
        assert!(
            (stand.wheel_rps[0] - 8.12).abs() < 0.08,
            "{}",
            stand.wheel_rps[0]
        );
        assert_eq!(stand.wheel_rps[0], -stand.wheel_rps[1]);
    }
}
