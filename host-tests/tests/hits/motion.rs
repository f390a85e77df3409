//! A robot that stands or drives, is hit and is righted, in double precision with one row a millisecond.

use std::f64::consts::PI;

use robot_test_support::{Random, Rotation, Vector, add, scale};

const GRAVITY_MPS2: f64 = 9.81;
/// East, north, up.
const EARTH_UT: Vector = [0.0, 20.0, -44.0];
const DT_S: f64 = 1e-3;
/// Time from the end of an impact until the robot starts to right itself.
const LYING_S: f64 = 0.15;
const MAX_RIGHTING_DPS: f64 = 90.0;
/// Tilt below which the robot counts as upright. It is larger while driving, where the robot nods.
const UPRIGHT_RAD: f64 = 0.002;
const NODDING_RAD: f64 = 0.04;

#[derive(Clone, Copy, Debug)]
pub struct Impact {
    pub at_s: f64,
    /// Body frame, right-hand rule.
    pub axis: Vector,
    pub peak_dps: f64,
    pub ms: f64,
    /// A step, or half a sine.
    pub abrupt: bool,
    /// Acceleration during the impact, body frame.
    pub accel_mps2: Vector,
}

impl Impact {
    fn share(&self, t_s: f64) -> Option<f64> {
        let share = (t_s - self.at_s) / (self.ms * 1e-3);
        (0.0..1.0).contains(&share).then_some(share)
    }

    fn rate_dps(&self, t_s: f64) -> Vector {
        let Some(share) = self.share(t_s) else {
            return [0.0; 3];
        };
        let form = if self.abrupt { 1.0 } else { (PI * share).sin() };
        scale(self.axis, form * self.peak_dps)
    }

    pub fn end_s(&self) -> f64 {
        self.at_s + self.ms * 1e-3
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    Standing,
    /// Rotates about the vertical at this rate.
    Turning {
        dps: i32,
    },
    /// Weaves, accelerates, brakes and nods.
    Driving,
}

impl Base {
    /// Starts from rest, which the start-up calibration needs, within a second.
    fn rate_dps(self, t_s: f64) -> Vector {
        scale(self.full_rate_dps(t_s), begun(t_s))
    }

    fn full_rate_dps(self, t_s: f64) -> Vector {
        match self {
            Self::Standing => [0.0; 3],
            Self::Turning { dps } => [0.0, 0.0, f64::from(dps)],
            Self::Driving => [
                8.0 * wave(0.9, t_s),
                12.0 * wave(1.3, t_s),
                60.0 * wave(0.4, t_s),
            ],
        }
    }

    /// Along the nose, and to the left.
    fn accel_mps2(self, t_s: f64) -> [f64; 2] {
        self.full_accel_mps2(t_s).map(|part| begun(t_s) * part)
    }

    fn full_accel_mps2(self, t_s: f64) -> [f64; 2] {
        match self {
            Self::Standing | Self::Turning { .. } => [0.0; 2],
            Self::Driving => [1.5 * wave(0.5, t_s), 0.5 * wave(0.4, t_s + 0.3)],
        }
    }
}

fn begun(t_s: f64) -> f64 {
    (t_s - 2.0).clamp(0.0, 1.0)
}

fn wave(hz: f64, t_s: f64) -> f64 {
    (2.0 * PI * hz * t_s).sin()
}

#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub gyro_rps: Vector,
    pub accel_mps2: Vector,
    pub field_ut: Vector,
    /// Body → ENU.
    pub q_wxyz: [f64; 4],
}

/// The rows, and the time from which on the robot is upright.
pub fn rows(base: Base, impacts: &[Impact], seconds: f64, seed: u64) -> (Vec<Row>, f64) {
    let mut noise = Random::new(seed);
    let mut attitude = Rotation::default();
    let mut rows = Vec::new();
    let (mut fallen, mut upright_s) = (false, 0.0);
    for step in 0..(seconds / DT_S).round() as u32 {
        let t_s = f64::from(step) * DT_S;
        let mut dps = base.rate_dps(t_s);
        for impact in impacts {
            dps = add(dps, impact.rate_dps(t_s));
        }
        let dazed = impacts
            .iter()
            .any(|impact| (impact.at_s..impact.end_s() + LYING_S).contains(&t_s));
        let (righting_dps, tilt_rad) = righting(attitude);
        fallen = dazed
            || fallen
                && tilt_rad
                    > if base == Base::Driving {
                        NODDING_RAD
                    } else {
                        UPRIGHT_RAD
                    };
        if fallen {
            upright_s = t_s;
        }
        if fallen && !dazed {
            dps = add(dps, righting_dps);
        }
        let rate_rps = dps.map(f64::to_radians);
        attitude = attitude.then_in_body(Rotation::by(scale(rate_rps, DT_S)));
        let mut force = force_mps2(base, attitude, t_s);
        for impact in impacts {
            if impact.share(t_s).is_some() {
                force = add(force, impact.accel_mps2);
            }
        }
        rows.push(Row {
            gyro_rps: add(rate_rps, noise.vector(0.15_f64.to_radians())),
            accel_mps2: add(force, noise.vector(0.06)),
            field_ut: add(attitude.seen_from_body(EARTH_UT), noise.vector(0.4)),
            q_wxyz: attitude.to_wxyz(),
        });
    }
    (rows, upright_s)
}

/// The rate that rights the robot, and its tilt.
fn righting(attitude: Rotation) -> (Vector, f64) {
    let [x, y, z] = attitude.seen_from_body([0.0, 0.0, 1.0]);
    let tilt_rad = x.hypot(y).atan2(z);
    // Up is (x, y, z) in the body frame. Rotation about (−y, x, 0) moves the z axis there.
    let axis = [-y, x, 0.0];
    let length = x.hypot(y);
    if length < 1e-9 {
        return ([0.0; 3], tilt_rad);
    }
    let dps = (tilt_rad.to_degrees() * 8.0).min(MAX_RIGHTING_DPS);
    (scale(axis, dps / length), tilt_rad)
}

fn force_mps2(base: Base, attitude: Rotation, t_s: f64) -> Vector {
    let [along, left] = base.accel_mps2(t_s);
    let [w, x, y, z] = attitude.to_wxyz();
    let yaw = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
    let (sin, cos) = yaw.sin_cos();
    attitude.seen_from_body([
        cos * along - sin * left,
        sin * along + cos * left,
        GRAVITY_MPS2,
    ])
}
