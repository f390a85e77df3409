//! What is done in the air.

use super::{Goal, Ground, Law, motion};
use crate::{
    control::balance::{catch::Catch, measured::Measured, support::Support, virtual_leg::LegForce},
    domain::{BalanceProfile, WheelOdomConfig},
    math::scalar,
};

/// Stiffness and damping of a leg's lean in the air in N·m/rad and N·m·s/rad.
const AIR_NM_PER_RAD: f32 = 12.0;
const AIR_NMS_PER_RAD: f32 = 0.6;
/// Factor of both where the robot has left the ground by itself. At an edge its wheels must go on with its body.
const LEFT_FACTOR: f32 = 2.0;
/// Damping of a wheel in the air in N·m·s/rad.
const AIR_DAMPING: f32 = 0.05;

impl Law {
    /// In the air the legs keep their length, and the robot its attitude.
    pub(super) fn in_air(
        &mut self,
        profile: &BalanceProfile,
        odometry: &WheelOdomConfig,
        measured: &Measured,
        goal: &Goal,
    ) -> ([f32; 2], [LegForce; 2]) {
        self.reference.let_go();
        self.catch = Catch::default();
        self.trim.restart(motion(measured));
        let wanted_rps = self.reference.speed_mps / scalar::max(odometry.wheel_radius_m, 0.01);
        let lean_rad = self.trim.offset_m / scalar::max(profile.limits.max_length_m, 0.05);
        let push_n = self.contact.push_n();
        let trim_nm = self.trim.leg_nm * self.support.share(&profile.mass, push_n);
        let factor = match goal.ground {
            Ground::Left => LEFT_FACTOR,
            Ground::Touched | Ground::Felt => 1.0,
        };
        let lean_nm = |rad: f32, rps: f32| {
            trim_nm + factor * (AIR_NM_PER_RAD * (lean_rad - rad) - AIR_NMS_PER_RAD * rps)
        };
        let ([left_rad, right_rad], [left_rps, right_rps]) = (measured.lean_rad, measured.lean_rps);
        let [left_n, right_n] = Support::in_air(
            &profile.mass,
            odometry.wheel_track_m,
            &goal.length,
            measured,
        );
        // Wheels are too light to turn the robot by their inertia. They keep the speed of the ground.
        let wheels_nm = measured
            .wheel_rps
            .map(|rps| AIR_DAMPING * (wanted_rps - rps));
        (
            wheels_nm,
            [
                LegForce {
                    push_n: left_n,
                    lean_nm: lean_nm(left_rad, left_rps),
                },
                LegForce {
                    push_n: right_n,
                    lean_nm: lean_nm(right_rad, right_rps),
                },
            ],
        )
    }
}
