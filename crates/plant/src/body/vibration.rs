//! What the wheels' gears and rotors shake the board with.

/// Amplitude per speed of the wheel. An assumption: nobody has published what a board on such a robot measures. 0.3 m/s² at
/// 50 rad/s is a fifth of what the legs themselves do to it.
const MPS2_PER_RPS: f64 = 0.006;
/// Share of it along the robot; the rest of the direction is upward.
const ALONG: f64 = 0.5;

/// A vibration at the frequency of each wheel's rotor, whose amplitude grows with its speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vibration {
    gear: f64,
}

impl Vibration {
    /// `gear` is rotor turns per wheel turn.
    pub(super) fn new(gear: f64) -> Self {
        Self { gear }
    }

    /// Acceleration in body axes for wheels at these angles and speeds against their motors.
    pub(super) fn accel_mps2(&self, angles_rad: [f64; 2], speeds_rps: [f64; 2]) -> [f64; 3] {
        let mut accel_mps2 = [0.0; 3];
        for (angle_rad, rps) in angles_rad.into_iter().zip(speeds_rps) {
            let (sin, cos) = (self.gear * angle_rad).sin_cos();
            accel_mps2[0] += ALONG * MPS2_PER_RPS * rps * cos;
            accel_mps2[2] += MPS2_PER_RPS * rps * sin;
        }
        accel_mps2
    }
}
