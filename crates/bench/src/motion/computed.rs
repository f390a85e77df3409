//! Motions computed in closed form. They stand in for missing recordings and have wheels, which no recording has.

use std::f64::consts::TAU;

use robot_plant::attitude::{self, Quaternion, multiply};
use robot_replay::Sample;

use super::{Motion, TICK_US, TICKS_A_SAMPLE, Wheels};

const SECONDS: f64 = 90.0;
const SAMPLE_US: u64 = TICKS_A_SAMPLE * TICK_US;
const SAMPLE_S: f64 = SAMPLE_US as f64 * 1e-6;
/// The magnetometer is read at 50 Hz.
const SAMPLES_A_FIELD: u64 = 4;
const GRAVITY_MPS2: f64 = 9.81;
/// The field in east, north, up: 49 µT with a dip of 67°, as in Berlin.
const FIELD_UT: [f64; 3] = [0.0, 19.0, -45.0];
/// The gyro's offset: 1 °/s on each axis.
const OFFSET_RPS: f64 = 0.0175;

type Vector = [f64; 3];

impl Motion {
    /// Has phases of rest, slow turning, fast turning with thrusts, a magnet nearby, and rest.
    pub fn computed(wheels: Wheels) -> Self {
        let mut q = [1.0, 0.0, 0.0, 0.0];
        let count = (SECONDS / SAMPLE_S) as u64;
        let samples = (0..count).map(|index| sample(&mut q, index));
        Self::Computed {
            samples: samples.collect(),
            wheels,
        }
    }
}

/// `q`: at the beginning of the sample's 5 ms, then at their end. The rate is steady in between.
fn sample(q: &mut Quaternion, index: u64) -> Sample {
    let middle_s = (index as f64 + 0.5) * SAMPLE_S;
    let rate_rps = rate(middle_s);
    let half = rotation(rate_rps.map(|rate| rate * SAMPLE_S / 2.0));
    let middle = multiply(*q, half);
    *q = multiply(middle, half);
    let [x, y, z] = thrust(middle_s);
    let accel = attitude::to_body(middle, [x, y, z + GRAVITY_MPS2]);
    let magnet = magnet(middle_s);
    let field = attitude::to_body(middle, [0, 1, 2].map(|axis| FIELD_UT[axis] + magnet[axis]));
    Sample {
        end_us: (index + 1) * SAMPLE_US,
        motion: Some(robot_replay::Motion {
            gyro_rps: rate_rps.map(|rate| (rate + OFFSET_RPS) as f32),
            accel_mps2: accel.map(|part| part as f32),
            saturated: false,
            gyro_clipped_ms: [0; 3],
        }),
        field_ut: index
            .is_multiple_of(SAMPLES_A_FIELD)
            .then(|| field.map(|part| part as f32)),
    }
}

/// Returns how fast the motion is at `t_s`, from 0 to 1.
fn vigour(t_s: f64) -> f64 {
    match t_s {
        5.0..30.0 => 0.15,
        30.0..60.0 => 1.0,
        60.0..80.0 => 0.4,
        _ => 0.0,
    }
}

fn rate(t_s: f64) -> Vector {
    let axis = |hz: f64, phase: f64| 7.0 * vigour(t_s) * (TAU * hz * t_s + phase).sin();
    [axis(0.31, 0.0), axis(0.43, 1.0), axis(0.23, 2.0)]
}

fn thrust(t_s: f64) -> Vector {
    let axis = |hz: f64| 6.0 * vigour(t_s) * (TAU * hz * t_s).sin();
    [axis(0.9), axis(1.3), axis(1.1)]
}

fn magnet(t_s: f64) -> Vector {
    if (65.0..75.0).contains(&t_s) {
        [25.0, -10.0, 15.0]
    } else {
        [0.0; 3]
    }
}

fn rotation(angle_rad: Vector) -> Quaternion {
    let length = angle_rad.iter().map(|part| part * part).sum::<f64>().sqrt();
    let share = if length > 0.0 {
        (length / 2.0).sin() / length
    } else {
        0.5
    };
    let [x, y, z] = angle_rad.map(|part| part * share);
    [(length / 2.0).cos(), x, y, z]
}
