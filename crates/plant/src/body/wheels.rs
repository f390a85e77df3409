//! The two wheels: 0 = left, 1 = right.

/// Inertia of a wheel with the reflected rotor on the robots that cannot fall, kg·m². An assumption: published values
/// spread widely (docs/hardware.md#robot-body).
pub(super) const WHEEL_INERTIA_KGM2: f64 = 0.0105;

/// Torque of each motor on its wheel in N·m, right-hand about the body's y axis: positive drives forward.
pub(super) type WheelTorques = [f64; 2];
