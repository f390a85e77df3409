//! The estimator on motions known by hand or by double-precision kinematics.

use robot_app::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig},
    estimation::InsEstimator,
};

const GRAVITY_MPS2: f32 = 9.806_65;
const LEVEL: [f32; 3] = [0.0, 0.0, GRAVITY_MPS2];
/// Central Europe: 20 µT to the north, 45 µT down.
const FACING_EAST_UT: [f32; 3] = [0.0, 20.0, -45.0];
const FACING_NORTH_UT: [f32; 3] = [20.0, 0.0, -45.0];

/// An estimator with made-up sensors.
struct Bench {
    estimator: InsEstimator,
    now_us: u64,
    /// The sample that would be measured now.
    imu: ImuState,
    mag: MagState,
    imu_sends: bool,
    imu_sample: ImuState,
    mag_sample: MagState,
    motor: MotorFeedback,
    estimate: StateEstimate,
}

impl Bench {
    /// Level, at rest, without magnetometer and wheel feedback.
    fn new() -> Self {
        Self {
            estimator: InsEstimator::new(WheelOdomConfig {
                wheel_radius_m: 0.06,
                ..WheelOdomConfig::default()
            }),
            now_us: 1_000_000,
            imu: ImuState {
                accel_mps2: LEVEL,
                ..ImuState::default()
            },
            mag: MagState::default(),
            imu_sends: true,
            imu_sample: ImuState::default(),
            mag_sample: MagState::default(),
            motor: MotorFeedback::default(),
            estimate: StateEstimate::default(),
        }
    }

    /// After a second at rest, when the estimate is valid.
    fn settled() -> Self {
        let mut bench = Self::new();
        bench.run(1.0);
        assert!(bench.estimate.valid);
        bench
    }

    /// One tick. IMU samples come every 5 ms, field samples every 20 ms.
    fn tick(&mut self) {
        self.now_us += 1_000;
        if self.imu_sends && self.now_us.is_multiple_of(5_000) {
            self.imu_sample = ImuState {
                ts_us: self.now_us,
                ..self.imu
            };
        }
        if self.mag.mag_ut != [0.0; 3] && self.now_us.is_multiple_of(20_000) {
            self.mag_sample = MagState {
                ts_us: self.now_us,
                ..self.mag
            };
        }
        let (imu, mag) = (&self.imu_sample, &self.mag_sample);
        self.estimator
            .step(imu, mag, &self.motor, self.now_us, &mut self.estimate);
    }

    fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds * 1_000.0).round() as u32 {
            self.tick();
        }
    }

    fn yaw_rad(&self) -> f32 {
        self.estimate.rpy_rad[2]
    }

    /// Tilt of a robot that should stand level. NaN fails every comparison.
    fn tilt_rad(&self) -> f32 {
        let [_, x, y, _] = self.estimate.q_wxyz;
        2.0 * x.hypot(y)
    }

    /// Sets the rotor speeds (left, right), each in its motor's own sense.
    fn wheels_turn(&mut self, rpm: [i16; 2]) {
        for (wheel, rpm) in self.motor.wheels.iter_mut().zip(rpm) {
            wheel.rpm = rpm;
            wheel.age_us = 1_000;
        }
    }

    /// Accelerates along the nose for 0.3 s, from this speed of the left rotor.
    fn accelerate(&mut self, accel_mps2: f32, from_rpm: i16) {
        const RPM_PER_MPS: f32 = 1_834.0 / 0.6;
        self.imu.accel_mps2 = [accel_mps2, 0.0, GRAVITY_MPS2];
        for ms in 1..=300 {
            let gained_mps = accel_mps2 * ms as f32 * 1e-3;
            let rpm = from_rpm + (gained_mps * RPM_PER_MPS).round() as i16;
            self.wheels_turn([rpm, -rpm]);
            self.tick();
        }
        self.imu.accel_mps2 = LEVEL;
    }
}

fn assert_close(got: [f32; 3], expected: [f32; 3], tolerance: f32) {
    for (got_part, part) in got.iter().zip(expected) {
        let close = (got_part - part).abs() < tolerance;
        assert!(close, "{got:?} instead of {expected:?}");
    }
}

/// In ENU axes, yaw is the counter-clockwise angle from east to the nose.
#[test]
fn the_field_shows_where_the_nose_points() {
    let cases = [
        (FACING_EAST_UT, 0.0),
        (FACING_NORTH_UT, 90.0f32),
        ([0.0, -20.0, -45.0], 180.0),
        ([-20.0, 0.0, -45.0], -90.0),
    ];
    for (mag_ut, yaw_deg) in cases {
        let mut bench = Bench::new();
        bench.mag.mag_ut = mag_ut;
        bench.run(2.0);
        let error_deg = (bench.yaw_rad().to_degrees() - yaw_deg).rem_euclid(360.0);
        assert!(!(0.1..=359.9).contains(&error_deg), "{yaw_deg}°");
        assert!(bench.tilt_rad() < 1e-4);
    }
}

/// Half of gravity along an axis is 30°. Nose up is negative pitch, left side up is positive roll.
#[test]
fn gravity_shows_roll_and_pitch() {
    let (half, rest) = (0.5 * GRAVITY_MPS2, 0.866_025_4 * GRAVITY_MPS2);
    let angle = 30.0f32.to_radians();
    for (accel_mps2, expected) in [
        ([half, 0.0, rest], [0.0, -angle, 0.0]),
        ([-half, 0.0, rest], [0.0, angle, 0.0]),
        ([0.0, half, rest], [angle, 0.0, 0.0]),
        ([0.0, -half, rest], [-angle, 0.0, 0.0]),
    ] {
        let mut bench = Bench::new();
        bench.imu.accel_mps2 = accel_mps2;
        bench.run(1.0);
        assert_close(bench.estimate.rpy_rad, expected, 1e-3);
    }
}

/// Without extrapolation between samples the yaw would lag by up to 4 mrad.
#[test]
fn a_steady_turn_is_followed_between_samples() {
    let mut bench = Bench::settled();
    let start_us = bench.now_us;
    bench.imu.gyro_dps = [0.0, 0.0, 1.0f32.to_degrees()];
    bench.run(0.005);
    for _ in 0..2_000 {
        bench.tick();
        let truth = (bench.now_us - start_us) as f32 * 1e-6;
        assert!((bench.yaw_rad() - truth).abs() < 5e-4, "{truth} s");
    }
    assert!(bench.estimate.valid);
}

/// A world vector in the body axes of the attitude `q` (body → world, w first), in double precision.
fn seen_from_body([w, x, y, z]: [f64; 4], [vx, vy, vz]: [f64; 3]) -> [f32; 3] {
    let body = [
        (1.0 - 2.0 * (y * y + z * z)) * vx
            + 2.0 * (x * y + w * z) * vy
            + 2.0 * (x * z - w * y) * vz,
        2.0 * (x * y - w * z) * vx
            + (1.0 - 2.0 * (x * x + z * z)) * vy
            + 2.0 * (y * z + w * x) * vz,
        2.0 * (x * z + w * y) * vx
            + 2.0 * (y * z - w * x) * vy
            + (1.0 - 2.0 * (x * x + y * y)) * vz,
    ];
    body.map(|part| part as f32)
}

/// The body rotates about a fixed axis. Its attitude is (cos, axis · sin) of half the angle. The part of the gyro bias
/// along that axis, 0.3 °/s · 5/7, would alone make 13° in this minute.
#[test]
fn a_tumbling_body_is_followed_despite_the_gyro_bias() {
    let (rate_rps, axis) = (1.2f64, [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0]);
    let mut bench = Bench::new();
    let mut worst_deg = 0.0f64;
    for tick in 1..=60_000u32 {
        let half = rate_rps * f64::from(tick) * 1e-3 / 2.0;
        let [x, y, z] = axis.map(|part| part * half.sin());
        let truth = [half.cos(), x, y, z];
        bench.imu.accel_mps2 = seen_from_body(truth, [0.0, 0.0, GRAVITY_MPS2.into()]);
        bench.imu.gyro_dps = axis.map(|part| (part * rate_rps).to_degrees() as f32 + 0.3);
        bench.mag.mag_ut = seen_from_body(truth, [0.0, 20.0, -45.0]);
        bench.tick();
        let q = bench.estimate.q_wxyz.map(f64::from);
        let dot: f64 = q.iter().zip(truth).map(|(a, b)| a * b).sum();
        worst_deg = worst_deg.max(2.0 * dot.abs().min(1.0).acos().to_degrees());
    }
    assert!(worst_deg < 2.0, "{worst_deg}°");
    let offset_rps = bench.estimate.gyro_bias_rps.map(f64::from);
    let along_axis: f64 = offset_rps.iter().zip(axis).map(|(a, b)| a * b).sum();
    let found = along_axis.to_degrees() / (0.3 * 5.0 / 7.0);
    assert!((0.6..1.1).contains(&found), "{found} of the offset found");
}

#[test]
fn at_rest_the_gyro_offset_is_found_and_the_heading_stays() {
    let mut bench = Bench::new();
    bench.imu.gyro_dps = [0.5, -0.4, 0.3];
    bench.run(20.0);
    let offset_dps = bench.estimate.gyro_bias_rps.map(f32::to_degrees);
    assert_close(offset_dps, [0.5, -0.4, 0.3], 0.02);
    let before = bench.yaw_rad();
    bench.run(10.0);
    assert!((bench.yaw_rad() - before).abs() < 2e-3);
}

/// Once the sensor stage subtracts the bias, the estimator must not subtract it again.
#[test]
fn a_bias_removed_from_the_samples_is_not_removed_twice() {
    let mut bench = Bench::new();
    bench.imu.gyro_dps = [0.5, -0.4, 0.3];
    bench.run(20.0);
    bench.imu.gyro_bias_dps = bench.imu.gyro_dps;
    bench.imu.gyro_dps = [0.0; 3];
    bench.run(0.01);
    let before = bench.yaw_rad();
    assert_close(bench.estimate.gyro_bias_rps, [0.0; 3], 1e-5);
    bench.run(10.0);
    assert!((bench.yaw_rad() - before).abs() < 2e-3);
}

/// Half a second is 100 samples. After a gap it takes 120 quiet samples to level the attitude.
fn assert_invalid_for_half_a_second(bench: &mut Bench, gap: bool, cause: &str) {
    bench.run(0.49);
    assert!(!bench.estimate.valid, "{cause}");
    bench.run(if gap { 0.12 } else { 0.02 });
    assert!(bench.estimate.valid, "{cause}");
    assert!(bench.tilt_rad() < 0.01, "{cause}: {:?}", bench.estimate);
}

#[test]
fn an_impossible_imu_sample_is_not_used() {
    for bad in [f32::NAN, f32::INFINITY, f32::MAX, -3_000.0] {
        for place in 0..3 {
            let mut bench = Bench::settled();
            let good = bench.imu;
            match place {
                0 => bench.imu.gyro_dps[1] = bad,
                1 => bench.imu.accel_mps2[2] = bad,
                _ => bench.imu.gyro_bias_dps[0] = bad,
            }
            bench.run(0.005);
            let cause = format!("{bad} at {place}");
            assert!(!bench.estimate.valid, "{cause}");
            assert!(bench.tilt_rad() < 0.01, "{cause}");
            bench.imu = good;
            assert_invalid_for_half_a_second(&mut bench, false, &cause);
        }
    }
}

#[test]
fn a_rotation_goes_on_through_unused_samples() {
    let mut bench = Bench::settled();
    let turning = [0.0, 0.0, 1.0f32.to_degrees()];
    bench.imu.gyro_dps = turning;
    bench.run(1.0);
    bench.imu.gyro_dps = [f32::NAN; 3];
    bench.run(0.05);
    bench.imu.gyro_dps = turning;
    bench.run(0.95);
    // The rate of a sample stands for the 5 ms before it.
    assert!((bench.yaw_rad() - 2.0).abs() < 6e-3, "{}", bench.yaw_rad());
}

/// 100 ms at the ends of ±12 g would tilt a smoothed gravity vector by 20°.
#[test]
fn an_impact_beyond_the_range_does_not_tilt_the_estimate() {
    let mut bench = Bench::settled();
    bench.imu.accel_mps2 = [117.6, -117.6, 9.8];
    bench.imu.saturated = true;
    bench.run(0.1);
    assert!(bench.estimate.valid);
    bench.imu.accel_mps2 = LEVEL;
    bench.imu.saturated = false;
    bench.run(0.5);
    assert!(bench.tilt_rad() < 0.2_f32.to_radians());
    bench.imu.gyro_dps = [0.0, 0.0, 1_000.0];
    bench.imu.saturated = true;
    bench.run(0.09);
    assert!(bench.estimate.valid);
    let [.., yaw_rad] = bench.estimate.rpy_rad;
    assert!((yaw_rad.to_degrees() - 90.0).abs() < 6.0, "{yaw_rad}");
}

#[test]
fn an_impossible_field_changes_nothing() {
    for bad in [f32::NAN, f32::INFINITY, f32::MAX, 9_000.0] {
        let mut bench = Bench::settled();
        bench.mag.mag_ut = FACING_NORTH_UT;
        bench.run(1.0);
        bench.mag.mag_ut[0] = bad;
        bench.run(1.0);
        bench.mag.mag_ut = FACING_NORTH_UT;
        bench.run(1.0);
        let yaw_deg = bench.yaw_rad().to_degrees();
        assert!((yaw_deg - 90.0).abs() < 0.1, "{bad}: {yaw_deg}°");
        assert!(bench.estimate.valid && bench.tilt_rad() < 1e-3, "{bad}");
    }
}

#[test]
fn silence_ends_validity_after_25_ms_and_a_long_one_for_longer() {
    let mut bench = Bench::settled();
    bench.imu_sends = false;
    bench.run(0.025);
    assert!(bench.estimate.valid);
    bench.tick();
    assert!(!bench.estimate.valid);
    bench.imu_sends = true;
    bench.run(0.005);
    assert!(bench.estimate.valid, "30 ms can be bridged");

    bench.imu_sends = false;
    bench.run(0.2);
    bench.imu_sends = true;
    assert_invalid_for_half_a_second(&mut bench, true, "200 ms of silence");
}

#[test]
fn a_jump_in_time_ends_validity_for_half_a_second() {
    for jump_us in [-900_000i64, -1_000, 25_000, 60_000_000, 1_000_000_000_000] {
        let mut bench = Bench::settled();
        bench.now_us = bench.now_us.checked_add_signed(jump_us).unwrap();
        bench.tick();
        assert!(!bench.estimate.valid, "{jump_us} µs");
        let gap = jump_us != 25_000;
        assert_invalid_for_half_a_second(&mut bench, gap, &format!("{jump_us} µs"));
    }
}

/// 1834 rpm of the rotor are 10 rad/s of a wheel with a radius of 0.06 m. The right motor is mirrored. From rest to 0.6
/// m/s in 0.3 s and back to rest the robot moves 0.6 m/s times the time between the middles of both ramps.
#[test]
fn the_robot_drives_where_its_nose_points() {
    let mut bench = Bench::settled();
    bench.mag.mag_ut = FACING_NORTH_UT;
    bench.wheels_turn([0, 0]);
    bench.run(1.0);
    for (accel_mps2, expected_m) in [(2.0, 1.2), (-2.0, 0.0)] {
        let top_rpm = 917 * accel_mps2 as i16;
        bench.accelerate(accel_mps2, 0);
        bench.run(1.7);
        assert_close(bench.estimate.vel_mps, [0.0, 0.3 * accel_mps2, 0.0], 2e-2);
        bench.accelerate(-accel_mps2, top_rpm);
        bench.run(1.7);
        assert_close(bench.estimate.vel_mps, [0.0; 3], 2e-3);
        assert_close(bench.estimate.pos_m, [0.0, expected_m, 0.0], 4e-2);
    }
}

/// Back and forth at 2 m/s² for a minute. The wheels explain the acceleration, so it does not tilt the estimate.
#[test]
fn driving_does_not_tilt_the_estimate() {
    let mut bench = Bench::settled();
    bench.wheels_turn([0, 0]);
    bench.run(1.0);
    let mut worst_deg: f32 = 0.0;
    for lap in 0..60 {
        let backward = lap % 2 == 1;
        let (accel_mps2, top_rpm) = if backward {
            (-2.0, -1_834)
        } else {
            (2.0, 1_834)
        };
        bench.accelerate(accel_mps2, 0);
        worst_deg = worst_deg.max(bench.tilt_rad().to_degrees());
        bench.run(0.4);
        bench.accelerate(-accel_mps2, top_rpm);
        worst_deg = worst_deg.max(bench.tilt_rad().to_degrees());
    }
    assert!(worst_deg < 0.12, "{worst_deg}°");
}

/// A bias of 0.306 m/s², that of one board.
#[test]
fn standing_still_shows_the_accelerometer_bias() {
    let mut bench = Bench::new();
    bench.imu.accel_mps2 = [0.0, 0.0, GRAVITY_MPS2 + 0.306];
    bench.wheels_turn([0, 0]);
    bench.run(8.0);
    assert_close(bench.estimate.accel_bias_mps2, [0.0, 0.0, 0.306], 3e-3);
    assert_close(bench.estimate.vel_mps, [0.0; 3], 1e-3);
    assert_close(bench.estimate.pos_m, [0.0; 3], 2e-2);
}
