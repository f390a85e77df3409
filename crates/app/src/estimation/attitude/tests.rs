//! The complete attitude filter over hours of rest and motion.

mod legs;

use super::{covariance::Covariance, error_state::STATES, *};
use crate::math::testing::{rotation_of, to_f32};
use robot_test_support::{Random, Rotation};

const DT_S: f64 = 0.005;
const HOURS: u32 = 2;
const MINUTES: u32 = HOURS * 60;
const EARTH_UT: [f64; 3] = [0.0, 20.0, -45.0];
const NEVER: Saturation = Saturation {
    any: false,
    gyro_ms: [0; 3],
};

/// A robot that alternates between a minute of rest and a minute of being carried about.
struct World {
    random: Random,
    attitude: Rotation,
    rate_rps: [f64; 3],
    sample: u32,
    /// How often the filter found that it had diverged.
    jumps: u32,
}

impl World {
    fn new() -> Self {
        Self {
            random: Random::new(29),
            attitude: Rotation::by([0.1, -0.1, 0.5]),
            rate_rps: [0.0; 3],
            sample: 0,
            jumps: 0,
        }
    }

    fn minute(&mut self, filter: &mut AttitudeFilter, resting: bool) {
        for _ in 0..12_000 {
            self.sample += 1;
            self.choose_rate(resting);
            self.imu(filter, resting);
            if self.sample.is_multiple_of(4) {
                let noise = self.random.vector(0.3);
                let seen = self.attitude.seen_from_body(EARTH_UT);
                let seen = std::array::from_fn(|axis| seen[axis] + noise[axis]);
                filter.feed_mag(to_f32(seen), 0.0);
            }
        }
    }

    /// A random rate of about 1 rad/s with a correlation time of half a second.
    fn choose_rate(&mut self, resting: bool) {
        let push = self.random.vector(if resting { 0.0 } else { 0.14 });
        self.rate_rps = std::array::from_fn(|axis| 0.99 * self.rate_rps[axis] + push[axis]);
    }

    fn imu(&mut self, filter: &mut AttitudeFilter, resting: bool) {
        let half = Rotation::by(self.rate_rps.map(|rate| 0.5 * DT_S * rate));
        let middle = self.attitude.then_in_body(half);
        self.attitude = middle.then_in_body(half);
        let [noise, shake] = [
            self.random.vector(0.05_f64.to_radians()),
            self.random.vector(if resting { 0.02 } else { 1.0 }),
        ];
        let gyro_rps: [f64; 3] = std::array::from_fn(|axis| {
            self.rate_rps[axis] * (1.0 + SCALE[axis]) + BIAS_DPS[axis].to_radians() + noise[axis]
        });
        let [x, y, z] = shake;
        let accel_mps2 = middle.seen_from_body([x, y, z + f64::from(GRAVITY_MPS2)]);
        if !filter.feed_imu(to_f32(gyro_rps), to_f32(accel_mps2), NEVER, DT_S as f32) {
            self.jumps += 1;
        }
    }
}

/// True rate = measured − bias − scale · measured, to first order.
const BIAS_DPS: [f64; 3] = [0.3, -0.5, 0.2];
const SCALE: [f64; 3] = [0.003, -0.002, 0.001];

fn bias_error_dps(filter: &AttitudeFilter) -> f64 {
    let errors = filter.bias_rps().into_iter().zip(BIAS_DPS);
    let squares = errors.map(|(found, real)| (f64::from(found).to_degrees() - real).powi(2));
    squares.sum::<f64>().sqrt()
}

/// Asserts that the correlation matrix is symmetric and positive definite, so that it has a Cholesky decomposition.
fn assert_valid(covariance: &Covariance, minute: u32) {
    let entry = |row: usize, column: usize| f64::from(covariance.rows[row][column]);
    let share = |row: usize, column: usize| {
        entry(row, column) / (entry(row, row) * entry(column, column)).sqrt()
    };
    let mut factor = [[0.0; STATES]; STATES];
    for row in 0..STATES {
        assert!(entry(row, row) > 0.0, "minute {minute}: variance {row}");
        for column in 0..=row {
            let skew = share(row, column) - share(column, row);
            assert!(
                skew.abs() < 1e-3,
                "minute {minute}: {row} and {column}: {skew}"
            );
            let sum: f64 = (0..column)
                .map(|k| factor[row][k] * factor[column][k])
                .sum();
            let left = share(row, column) - sum;
            factor[row][column] = if row == column {
                assert!(left > 1e-4, "minute {minute}: {row} is left with {left}");
                left.sqrt()
            } else {
                left / factor[column][column]
            };
        }
    }
}

#[test]
fn hours_of_rest_and_motion_keep_the_covariance_valid() {
    let mut world = World::new();
    let mut filter = AttitudeFilter::new();
    let (mut worst_deg, mut worst_bias_dps) = (0.0_f64, 0.0_f64);
    for minute in 0..MINUTES {
        let resting = minute % 2 == 0;
        world.minute(&mut filter, resting);
        assert_valid(&filter.filter.covariance, minute);
        let variances = filter.filter.covariance.variances(BIAS);
        let sure = variances.iter().all(|variance| variance.sqrt() < 0.5 * DEG);
        assert!(sure, "minute {minute}: reset: {variances:?}");
        if minute > 3 {
            let attitude = rotation_of(filter.orientation(0.0));
            worst_deg = worst_deg.max(attitude.angle_to_deg(world.attitude));
            worst_bias_dps = worst_bias_dps.max(bias_error_dps(&filter));
        }
    }
    // The bias is unknown at the start.
    assert!(world.jumps <= 1, "{} jumps", world.jumps);
    println!("worst {worst_deg:.2}°, bias {worst_bias_dps:.3}°/s");
    assert!(worst_deg < 2.0, "{worst_deg}");
    assert!(worst_bias_dps < 0.05, "{worst_bias_dps}");
    let found = filter.strapdown.gyro.misalignment;
    for axis in 0..3 {
        let off = f64::from(found[axis][axis]) - SCALE[axis];
        assert!(off.abs() < 0.001, "scale of axis {axis}: {off}");
    }
}

/// A robot that rotates in place. `heading_rad` is counted from east.
struct Turntable {
    filter: AttitudeFilter,
    rate_rps: f64,
    heading_rad: f64,
    sample: u32,
}

impl Turntable {
    fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds / DT_S).round() as u32 {
            self.sample += 1;
            self.heading_rad += self.rate_rps * DT_S;
            let (gyro_rps, up) = ([0.0, 0.0, self.rate_rps as f32], [0.0, 0.0, GRAVITY_MPS2]);
            assert!(self.filter.feed_imu(gyro_rps, up, NEVER, DT_S as f32));
            if self.sample.is_multiple_of(4) {
                let seen = self.truth().seen_from_body(EARTH_UT);
                self.filter.feed_mag(to_f32(seen), 0.0);
            }
        }
    }

    fn truth(&self) -> Rotation {
        Rotation::by([0.0, 0.0, self.heading_rad])
    }

    fn error_deg(&self) -> f64 {
        rotation_of(self.filter.orientation(0.0)).angle_to_deg(self.truth())
    }
}

/// The heading and the reference field have drifted by 11°. Both are corrected together while the robot rotates, so
/// that the field does not seem delayed.
#[test]
fn a_heading_correction_rotates_the_reference_field() {
    for rate_rps in [2.0, -2.0] {
        let mut table = Turntable {
            filter: AttitudeFilter::new(),
            rate_rps,
            heading_rad: 0.4,
            sample: 0,
        };
        table.run(20.0);
        assert!(table.error_deg() < 0.5, "{}", table.error_deg());
        let drift = [0.0, 0.0, 0.2];
        table.filter.strapdown.rotate_world(drift);
        table.filter.magnetic.rotate_world(drift);
        table.filter.filter.covariance.add_variances(2, &[0.1]);
        table.run(10.0);
        assert!(table.error_deg() < 1.0, "{}", table.error_deg());
        let late_ms = 1e3 * table.filter.magnetic.delay_s();
        assert!(late_ms.abs() < 1.0, "{rate_rps}: {late_ms} ms");
    }
}
