//! The two wheels: 0 = left, 1 = right.

/// Inertia of a wheel with the reflected rotor on the robots that cannot fall, kg·m². An assumption: published values
/// spread widely (docs/hardware.md#robot-body).
pub(super) const WHEEL_INERTIA_KGM2: f64 = 0.0105;

/// Torque of each motor on its wheel in N·m, right-hand about the body's y axis: positive drives forward.
pub(super) type WheelTorques = [f64; 2];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots::{JointMotor, with_joints};

    #[test]
    fn robots_that_cannot_fall_have_wheels_like_those_of_the_files() {
        for motor in [JointMotor::Dm4310, JointMotor::Rs00] {
            let wheels = &with_joints(motor).wheels;
            let filed_kgm2 = wheels.inertia_kgm2 + wheels.rotor_inertia_kgm2;
            let share = WHEEL_INERTIA_KGM2 / filed_kgm2;
            assert!((0.9..1.1).contains(&share), "{share}");
        }
    }
}
