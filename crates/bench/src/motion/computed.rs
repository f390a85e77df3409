//! A motion with known truth: for where there are no recordings, and for wheels, which recordings lack.

use std::f64::consts::TAU;

use super::{Motion, ROW_US, Row, Wheels};

const SECONDS: f64 = 90.0;
const ROW_S: f64 = ROW_US as f64 * 1e-6;
const GRAVITY_MPS2: f64 = 9.81;
/// East, north, up: a field of 49 µT that dips by 67°, as in Berlin.
const FIELD_UT: [f64; 3] = [0.0, 19.0, -45.0];
/// Of the gyro, 1 °/s on each axis.
const OFFSET_RPS: f64 = 0.0175;

type Vector = [f64; 3];
type Quaternion = [f64; 4];

impl Motion {
    /// Rest, slow turning, fast turning with thrusts, a magnet nearby, rest.
    pub fn computed(wheels: Wheels) -> Self {
        let mut q = [1.0, 0.0, 0.0, 0.0];
        let count = (SECONDS / ROW_S) as usize;
        let rows = (0..count).map(|index| row(&mut q, (index as f64 + 0.5) * ROW_S));
        Self {
            name: "computed motion".to_owned(),
            rows: rows.collect(),
            wheels,
        }
    }
}

/// `q`: at the row's beginning, then at its end. The rate is steady within the row.
fn row(q: &mut Quaternion, middle_s: f64) -> Row {
    let rate_rps = rate(middle_s);
    let half = rotation(rate_rps.map(|rate| rate * ROW_S / 2.0));
    let middle = product(*q, half);
    *q = product(middle, half);
    let push = thrust(middle_s);
    let accel = [push[0], push[1], push[2] + GRAVITY_MPS2];
    let magnet = magnet(middle_s);
    let field = [0, 1, 2].map(|axis| FIELD_UT[axis] + magnet[axis]);
    Row {
        gyro_rps: rate_rps.map(|rate| (rate + OFFSET_RPS) as f32),
        accel_mps2: into_body(middle, accel).map(|part| part as f32),
        mag_ut: into_body(middle, field).map(|part| part as f32),
        reference_wxyz: Some(*q),
    }
}

/// How fast the motion is at `t_s`, 0 … 1.
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

fn product(a: Quaternion, b: Quaternion) -> Quaternion {
    let ([aw, ax, ay, az], [bw, bx, by, bz]) = (a, b);
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]
}

fn into_body(q: Quaternion, [x, y, z]: Vector) -> Vector {
    let [w, a, b, c] = q;
    let conjugate = [w, -a, -b, -c];
    let [_, x, y, z] = product(product(conjugate, [0.0, x, y, z]), q);
    [x, y, z]
}
