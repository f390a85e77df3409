//! A recorded trial made up here: a robot with wrong sensors on six sides and some slants, and then turned through all
//! attitudes.

use std::{
    f64::consts::TAU,
    fs::{self, File},
    io::Write,
    path::{Path, PathBuf},
};

use flate2::{Compression, write::GzEncoder};
use serde_json::json;

pub type Vector = [f64; 3];

pub const ROWS_A_SECOND: usize = 200;
const HOLD_S: f64 = 1.8;
/// The first position is held longer: the tool has begun to record before it ends.
const FIRST_HOLD_S: f64 = 3.4;
const TUMBLE_S: f64 = 8.0;
/// And the first again at the end: on a busy computer the tool begins late.
const LAST_HOLD_S: f64 = 2.5;
pub const GRAVITY_MPS2: f64 = 9.806_65;
const FIELD_UT: f64 = 48.0;
/// Upwards in the body frame; the first is how the robot boots.
const POSITIONS: [Vector; 9] = [
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.6, 0.0, 0.8],
    [0.0, -0.6, 0.8],
    [-0.48, 0.6, -0.64],
];

/// measured acceleration = true / gain + offset; measured field = iron · true + magnet.
pub struct SensorErrors {
    pub accel_offset_mps2: Vector,
    pub accel_gain: Vector,
    pub magnet_ut: Vector,
    pub iron: [Vector; 3],
}

impl Default for SensorErrors {
    fn default() -> Self {
        Self {
            accel_offset_mps2: [0.15, -0.19, 0.12],
            accel_gain: [1.008, 0.996, 0.993],
            magnet_ut: [22.0, -31.0, 12.0],
            iron: [[1.1, 0.04, 0.0], [0.04, 0.95, -0.03], [0.0, -0.03, 1.02]],
        }
    }
}

impl SensorErrors {
    fn accel(&self, true_mps2: Vector) -> Vector {
        std::array::from_fn(|axis| {
            true_mps2[axis] / self.accel_gain[axis] + self.accel_offset_mps2[axis]
        })
    }

    fn field(&self, true_ut: Vector) -> Vector {
        std::array::from_fn(|axis| {
            let turned: f64 = (0..3).map(|k| self.iron[axis][k] * true_ut[k]).sum();
            turned + self.magnet_ut[axis]
        })
    }
}

/// Rows of the trial, column by column.
#[derive(Default)]
pub struct Columns {
    rows: usize,
    gyro_rps: [Vec<f32>; 3],
    accel_mps2: [Vec<f32>; 3],
    field_ut: [Vec<f32>; 3],
    noise: u32,
}

impl Columns {
    fn push(&mut self, accel_mps2: Vector, field_ut: Vector) {
        self.push_turning([0.0; 3], accel_mps2, field_ut);
    }

    pub fn push_turning(&mut self, gyro_rps: Vector, accel_mps2: Vector, field_ut: Vector) {
        for axis in 0..3 {
            // A sensor without any noise counts as frozen.
            let gyro_rps = gyro_rps[axis] + 0.001 * self.noise();
            let accel_mps2 = accel_mps2[axis] + 0.02 * self.noise();
            self.gyro_rps[axis].push(gyro_rps as f32);
            self.accel_mps2[axis].push(accel_mps2 as f32);
            self.field_ut[axis].push(field_ut[axis] as f32);
        }
        self.rows += 1;
    }

    /// Evenly within ±1: the generator of Numerical Recipes.
    fn noise(&mut self) -> f64 {
        self.noise = self
            .noise
            .wrapping_mul(1_664_525)
            .wrapping_add(1_013_904_223);
        f64::from(self.noise) / f64::from(u32::MAX) * 2.0 - 1.0
    }
}

fn scaled(vector: Vector, factor: f64) -> Vector {
    vector.map(|part| part * factor)
}

fn rows(seconds: f64) -> usize {
    (seconds * ROWS_A_SECOND as f64) as usize
}

/// Writes the trial into `directory` and returns its header.
pub fn write(directory: &Path, errors: &SensorErrors) -> PathBuf {
    let mut columns = Columns::default();
    let hold = |columns: &mut Columns, up: Vector, seconds: f64| {
        let accel = errors.accel(scaled(up, GRAVITY_MPS2));
        let field = errors.field(scaled(up, -FIELD_UT));
        for _ in 0..rows(seconds) {
            columns.push(accel, field);
        }
    };
    for (number, up) in POSITIONS.into_iter().enumerate() {
        let hold_s = if number == 0 { FIRST_HOLD_S } else { HOLD_S };
        hold(&mut columns, up, hold_s);
    }
    // Fifteen turns while the field's direction goes from pole to pole.
    let count = rows(TUMBLE_S);
    for row in 0..count {
        let share = row as f64 / count as f64;
        let (height, turn) = (1.0 - 2.0 * share, 15.0 * TAU * share);
        let radius = (1.0 - height * height).sqrt();
        let direction = [radius * turn.cos(), radius * turn.sin(), height];
        let accel = errors.accel(scaled(direction, GRAVITY_MPS2));
        columns.push(accel, errors.field(scaled(direction, FIELD_UT)));
    }
    hold(&mut columns, POSITIONS[0], LAST_HOLD_S);
    save(directory, "sides", &columns)
}

pub fn save(directory: &Path, name: &str, columns: &Columns) -> PathBuf {
    fs::create_dir_all(directory).expect("the test's own directory");
    let header = directory.join(name).with_extension("json");
    let text = json!({
        "rows": columns.rows,
        "columns": [
            "gx", "gy", "gz", "ax", "ay", "az", "mx", "my", "mz", "qw", "qx", "qy", "qz", "mov",
        ],
        "rate_num": ROWS_A_SECOND,
        "rate_den": 1,
    });
    fs::write(&header, text.to_string()).expect("the header");
    // The attitude is unknown: gaps of the reference.
    let unknown = vec![f32::NAN; columns.rows];
    let still = vec![0.0; columns.rows];
    let measured = columns
        .gyro_rps
        .iter()
        .chain(&columns.accel_mps2)
        .chain(&columns.field_ut);
    let all = measured.chain([&unknown, &unknown, &unknown, &unknown, &still]);
    let file = File::create(header.with_extension("f32.gz")).expect("the columns");
    let mut file = GzEncoder::new(file, Compression::fast());
    for value in all.flatten() {
        file.write_all(&value.to_le_bytes()).expect("a column");
    }
    file.finish().expect("the end");
    header
}
