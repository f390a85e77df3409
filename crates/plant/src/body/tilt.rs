//! A body that falls forward about its axle or is struck, and is put upright again.

use crate::{
    attitude::{self, Quaternion},
    motion::Motion,
};

const DEG: f64 = std::f64::consts::PI / 180.0;
const FALL_RPS: f64 = 2.0;
/// Pitch of a body that lies on the floor.
const LYING_RAD: f64 = 80.0 * DEG;
/// Beyond the range of a gyro of ±2000 °/s.
const BLOW_RPS: f64 = 3_500.0 * DEG;
const STRUCK_RAD: f64 = 35.0 * DEG;

/// The pose towards which the body moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stance {
    Upright,
    Fallen,
    Struck,
}

impl Stance {
    const fn goal_rad(self) -> f64 {
        match self {
            Self::Upright => 0.0,
            Self::Fallen => LYING_RAD,
            Self::Struck => STRUCK_RAD,
        }
    }

    const fn speed_rps(self) -> f64 {
        match self {
            Self::Upright | Self::Fallen => FALL_RPS,
            Self::Struck => BLOW_RPS,
        }
    }
}

/// Pitch on top of the mechanics, about the body's y axis, nose down positive. The body is taken to turn about the IMU itself,
/// so a fall adds a rate and no force.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tilt {
    pitch_rad: f64,
    rate_rps: f64,
}

impl Tilt {
    pub(crate) fn step(&mut self, stance: Stance, dt_s: f64) {
        let way_rad = stance.goal_rad() - self.pitch_rad;
        let max_rad = stance.speed_rps() * dt_s;
        let moved_rad = way_rad.clamp(-max_rad, max_rad);
        self.pitch_rad += moved_rad;
        self.rate_rps = moved_rad / dt_s;
    }

    /// Motion in the axes of the pitched body, from that of the level body.
    pub(crate) fn apply(&self, level: Motion) -> Motion {
        if self.pitch_rad == 0.0 && self.rate_rps == 0.0 {
            return level;
        }
        let (sin, cos) = self.pitch_rad.sin_cos();
        let pitched = |[x, y, z]: [f64; 3]| [cos * x - sin * z, y, sin * x + cos * z];
        let [wx, wy, wz] = pitched(level.gyro_rps);
        Motion {
            accel_mps2: pitched(level.accel_mps2),
            gyro_rps: [wx, wy + self.rate_rps, wz],
        }
    }

    pub(crate) fn attitude(&self, yaw_rad: f64) -> Quaternion {
        attitude::from_yaw_pitch(yaw_rad, self.pitch_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEVEL: Motion = Motion {
        accel_mps2: [0.0, 0.0, 9.80665],
        gyro_rps: [0.0, 0.0, 0.3],
    };

    #[test]
    fn it_falls_to_80_degrees_at_2_rad_a_second_and_comes_back() {
        let mut tilt = Tilt::default();
        for _ in 0..2_000 {
            tilt.step(Stance::Fallen, 250e-6);
        }
        // Half a second: 1 rad. Gravity's reaction points to the tail and up: −sin 1, cos 1; the turn about the
        // earth's vertical likewise.
        let pitched = tilt.apply(LEVEL);
        let expected = [-8.25196, 0.0, 5.29855, -0.252_441, 2.0, 0.162_091];
        let got = [pitched.accel_mps2, pitched.gyro_rps].concat();
        for (got, expected) in got.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-4, "{pitched:?}");
        }
        for _ in 0..2_000 {
            tilt.step(Stance::Fallen, 250e-6);
        }
        let lying = tilt.apply(LEVEL);
        assert!((lying.accel_mps2[2] - 9.80665 * 0.173_648).abs() < 1e-4);
        assert_eq!(lying.gyro_rps[1], 0.0);
        for _ in 0..4_000 {
            tilt.step(Stance::Upright, 250e-6);
        }
        assert_eq!(tilt.apply(LEVEL).accel_mps2, LEVEL.accel_mps2);
    }

    /// 35° at 3500 °/s are 10 ms.
    #[test]
    fn a_blow_is_faster_than_a_gyro_can_see() {
        let mut tilt = Tilt::default();
        for _ in 0..38 {
            tilt.step(Stance::Struck, 250e-6);
            assert!((tilt.apply(LEVEL).gyro_rps[1] - 61.087).abs() < 0.1);
        }
        for _ in 0..4 {
            tilt.step(Stance::Struck, 250e-6);
        }
        let struck = tilt.apply(LEVEL);
        assert!((struck.accel_mps2[2] - 9.80665 * 0.819_152).abs() < 1e-4);
    }

    /// The attitude turns the earth's upward gravity reaction into what the accelerometer measures.
    #[test]
    fn attitude_and_gravity_agree() {
        let tilt = Tilt {
            pitch_rad: 1.1,
            rate_rps: 0.0,
        };
        let up = attitude::to_body(tilt.attitude(0.7), [0.0, 0.0, 9.80665]);
        let pitched = tilt.apply(LEVEL).accel_mps2;
        for (up, pitched) in up.iter().zip(pitched) {
            assert!((up - pitched).abs() < 1e-9, "{up} {pitched}");
        }
    }
}
