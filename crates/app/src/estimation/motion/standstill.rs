//! Inertial speed since the last standstill.
//!
//! A standstill removes tilt error and accelerometer bias together. For the next seconds the integrated acceleration is
//! therefore as good a speed as the accelerometer ever gives. Wheels that differ from it spin, on ice or in the air.

/// Time after a standstill for which the inertial speed is used.
const VALID_S: f32 = 2.0;
/// Yaw angle that uses up the same time: the bias turns with the body, the tilt error does not.
const VALID_RAD: f32 = 0.35;
/// Tolerance of a wheel's speed against the inertial one, at the standstill.
const SPIN_MPS: f32 = 0.15;
/// Growth of that tolerance with time: a tilt error of 0.3°.
const DRIFT_MPS2: f32 = 0.05;
/// Largest inertial speed of a robot that still stands.
const STANDING_MPS: f32 = 0.15;
/// Time constant with which the inertial speed decays while the robot stands and its wheels spin.
const DECAY_S: f32 = 2.0;

/// What is known since the last standstill.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standstill {
    /// Time since the standstill, plus an equivalent for the yaw angle.
    since_s: f32,
    forward_mps: f32,
    /// Gyro and accelerometer have been quiet since.
    quiet: bool,
}

/// The speed that the wheels should show.
#[derive(Clone, Copy, Debug)]
pub(super) struct InertialSpeed {
    pub forward_mps: f32,
    pub tolerance_mps: f32,
}

impl Standstill {
    pub const fn new() -> Self {
        Self {
            since_s: VALID_S,
            forward_mps: 0.0,
            quiet: false,
        }
    }

    /// The robot stands by wheels, gyro and accelerometer.
    pub fn begin(&mut self) {
        *self = Self {
            since_s: 0.0,
            forward_mps: 0.0,
            quiet: true,
        };
    }

    /// The robot still stands, but its wheels spin.
    pub fn prolong(&mut self, forward_mps2: f32, quiet: bool, dt_s: f32) {
        self.forward_mps += forward_mps2 * dt_s - self.forward_mps * dt_s / DECAY_S;
        self.quiet &= quiet;
    }

    /// The robot may be moving.
    pub fn leave(&mut self, forward_mps2: f32, yaw_rps: f32, quiet: bool, dt_s: f32) {
        self.since_s += dt_s + (VALID_S / VALID_RAD) * yaw_rps.abs() * dt_s;
        self.forward_mps += forward_mps2 * dt_s;
        self.quiet &= quiet;
    }

    /// True while the inertial speed is good enough to be used.
    pub fn is_recent(&self) -> bool {
        self.since_s < VALID_S
    }

    /// `None` if the last standstill is too long ago.
    pub fn inertial_speed(&self) -> Option<InertialSpeed> {
        self.is_recent().then_some(InertialSpeed {
            forward_mps: self.forward_mps,
            tolerance_mps: SPIN_MPS + DRIFT_MPS2 * self.since_s,
        })
    }

    /// True while nothing but the wheels contradicts a standstill.
    pub fn persists(&self) -> bool {
        self.is_recent() && self.quiet && self.forward_mps.abs() < STANDING_MPS
    }
}
