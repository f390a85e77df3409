//! How fast a robot can be that stood a moment ago, by the accelerometer alone.
//!
//! At a standstill horizon and offset of the accelerometer are taken out together, so for the next seconds its sum tells
//! the speed as well as ever. Wheels that run away from that spin: on ice, or in the air.

/// The sum counts for so long after the standstill, …
const COUNTS_S: f32 = 2.0;
/// … or until the robot has turned so far: the offset turns with it, the horizon that it was taken out with does not.
const COUNTS_RAD: f32 = 0.35;
/// A wheel further off spins …
const SPIN_MPS: f32 = 0.15;
/// … and by so much more for each second, in which the horizon may tilt by 0.3°.
const DRIFT_MPS2: f32 = 0.05;
/// A robot that still stands is this slow by the accelerometer, …
const STANDING_MPS: f32 = 0.15;
/// … which forgets while it goes on standing beside its spinning wheels.
const MEMORY_S: f32 = 2.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct Standstill {
    /// What is used up of the time that it counts.
    since_s: f32,
    forward_mps: f32,
    /// Nothing has shaken or turned it since.
    quiet: bool,
}

/// Where the wheels should be.
#[derive(Clone, Copy, Debug)]
pub(super) struct InertialSpeed {
    pub forward_mps: f32,
    pub tolerance_mps: f32,
}

impl Standstill {
    pub const fn new() -> Self {
        Self {
            since_s: COUNTS_S,
            forward_mps: 0.0,
            quiet: false,
        }
    }

    /// It stands, as wheels, gyro and accelerometer agree.
    pub fn begin(&mut self) {
        *self = Self {
            since_s: 0.0,
            forward_mps: 0.0,
            quiet: true,
        };
    }

    /// It stands, but its wheels spin.
    pub fn go_on(&mut self, forward_mps2: f32, quiet: bool, dt_s: f32) {
        self.forward_mps += forward_mps2 * dt_s - self.forward_mps * dt_s / MEMORY_S;
        self.quiet &= quiet;
    }

    /// It may be moving.
    pub fn leave(&mut self, forward_mps2: f32, yaw_rps: f32, quiet: bool, dt_s: f32) {
        self.since_s += dt_s + (COUNTS_S / COUNTS_RAD) * yaw_rps.abs() * dt_s;
        self.forward_mps += forward_mps2 * dt_s;
        self.quiet &= quiet;
    }

    pub fn counts(&self) -> bool {
        self.since_s < COUNTS_S
    }

    /// None if the last standstill is too long ago.
    pub fn speed(&self) -> Option<InertialSpeed> {
        self.counts().then_some(InertialSpeed {
            forward_mps: self.forward_mps,
            tolerance_mps: SPIN_MPS + DRIFT_MPS2 * self.since_s,
        })
    }

    /// Nothing but its wheels speaks against its standing still.
    pub fn lasts(&self) -> bool {
        self.counts() && self.quiet && self.forward_mps.abs() < STANDING_MPS
    }
}
