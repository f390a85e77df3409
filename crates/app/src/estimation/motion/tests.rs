//! The parts of the motion estimate, against double precision and numbers worked out by hand.

use super::{
    slip::Grip,
    velocity_filter::{FORWARD, Gains, LEFT, UP},
    *,
};
use crate::domain::WheelFeedback;

const GRAVITY_MPS2: f32 = 9.806_65;
const DT_S: f32 = 0.005;
/// 1834 rpm of the rotor are 10 rad/s of a wheel of 0.06 m.
const RPM_PER_MPS: f32 = 1_834.0 / 0.6;

/// Feeds samples.
struct Bench {
    motion: MotionEstimator,
    pose: BodyPose,
    motor: MotorFeedback,
    /// Specific force, body axes.
    accel_mps2: Vector3,
}

impl Bench {
    /// Level, nose to the east, at rest, wheels silent.
    fn new() -> Self {
        Self {
            motion: MotionEstimator::new(&WheelOdomConfig::default()),
            pose: BodyPose {
                orientation: Quaternion::IDENTITY,
                rate_rps: [0.0; 3],
            },
            motor: MotorFeedback::default(),
            accel_mps2: [0.0, 0.0, GRAVITY_MPS2],
        }
    }

    /// Stands on wheels that are heard.
    fn on_wheels() -> Self {
        let mut bench = Self::new();
        bench.wheels_run([0.0, 0.0]);
        bench.run(1.0);
        bench
    }

    /// Rim speeds, forward positive.
    fn wheels_run(&mut self, [left_mps, right_mps]: [f32; 2]) {
        for (wheel, mps) in self.motor.wheels.iter_mut().zip([left_mps, -right_mps]) {
            *wheel = WheelFeedback {
                rpm: (mps * RPM_PER_MPS).round() as i16,
                age_us: 1_000,
                ..WheelFeedback::default()
            };
        }
    }

    fn sample(&mut self) {
        let sample = AccelSample {
            accel_mps2: Some(self.accel_mps2),
            dt_s: DT_S,
        };
        self.motion.feed(&sample, 0.0, &self.pose, &self.motor);
    }

    fn run(&mut self, seconds: f32) {
        for _ in 0..(seconds / DT_S).round() as u32 {
            self.sample();
        }
    }

    /// Forward with both wheels following, from a speed to a speed.
    fn drive(&mut self, from_mps: f32, to_mps: f32, seconds: f32) {
        let accel_mps2 = (to_mps - from_mps) / seconds;
        self.accel_mps2 = [accel_mps2, 0.0, GRAVITY_MPS2];
        let samples = (seconds / DT_S).round() as u32;
        for sample in 1..=samples {
            let mps = from_mps + accel_mps2 * sample as f32 * DT_S;
            self.wheels_run([mps, mps]);
            self.sample();
        }
        self.accel_mps2 = [0.0, 0.0, GRAVITY_MPS2];
    }

    fn velocity_mps(&self) -> Vector3 {
        self.motion.after(0.0).0
    }

    fn position_m(&self) -> Vector3 {
        self.motion.after(0.0).1
    }

    fn forward_mps(&self) -> f32 {
        let [x, ..] = self.velocity_mps();
        x
    }
}

/// From facing east, computed in double precision.
fn turned_left(yaw_rad: f64) -> Quaternion {
    let (sin, cos) = (0.5 * yaw_rad).sin_cos();
    Quaternion {
        w: cos as f32,
        x: 0.0,
        y: 0.0,
        z: sin as f32,
    }
}

fn assert_close(got: Vector3, expected: Vector3, tolerance: f32) {
    for (got_part, part) in got.iter().zip(expected) {
        let close = (got_part - part).abs() < tolerance;
        assert!(close, "{got:?} instead of {expected:?}");
    }
}

/// The covariance run step by step at 200 Hz until it is steady, in double precision.
fn riccati(std_mps: f64, lasts_s: f64, wander_mps2: f64) -> [f64; 2] {
    let dt = 0.005;
    let (q, p, r) = (
        0.3 * 0.3 * dt,
        wander_mps2 * wander_mps2,
        2.0 * std_mps * std_mps * lasts_s,
    );
    let [mut vv, mut vb, mut bb] = [1.0, 0.0, 1.0];
    let mut gains = [0.0; 2];
    for _ in 0..200_000 {
        vv += -2.0 * vb * dt + bb * dt * dt + q * dt;
        vb -= bb * dt;
        bb += p * dt;
        // White noise of density r, averaged over one step.
        let innovation = vv + r / dt;
        gains = [vv / innovation, vb / innovation];
        bb -= vb * gains[1];
        vb -= vb * gains[0];
        vv -= vv * gains[0];
    }
    [gains[0] / dt, -gains[1] / dt]
}

#[test]
fn gains_are_those_of_the_kalman_filter() {
    let check = |Gains { speed, bias }: Gains, expected: [f64; 2]| {
        for (got, expected) in [speed, bias].into_iter().zip(expected) {
            let ratio = f64::from(got) / expected;
            assert!((ratio - 1.0).abs() < 0.02, "{got} instead of {expected}");
        }
    };
    check(FORWARD, riccati(0.03, 0.05, 0.05));
    check(LEFT, riccati(0.05, 0.2, 0.05));
    check(UP, riccati(0.05, 0.2, 0.01));
}

#[test]
fn speed_and_way_follow_a_drive() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    assert!((bench.forward_mps() - 1.0).abs() < 0.01);
    bench.run(2.0);
    bench.drive(1.0, 0.0, 0.5);
    bench.run(1.0);
    // 1 m/s for the 2.5 s between the middles of the ramps.
    assert_close(bench.position_m(), [2.5, 0.0, 0.0], 0.02);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-4);
}

/// Offset forward and to the left while driving, so that no rest shows it.
#[test]
fn an_offset_is_learnt_while_driving() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.run(2.0);
    bench.accel_mps2 = [0.2, -0.1, GRAVITY_MPS2];
    bench.run(8.0);
    assert_close(bench.motion.accel_bias_mps2(), [0.2, -0.1, 0.0], 5e-3);
    assert_close(bench.velocity_mps(), [1.0, 0.0, 0.0], 5e-3);
}

/// Nothing but sensor values tells a constant speed from rest; turning wheels do.
#[test]
fn a_constant_speed_is_not_taken_for_rest() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 0.05, 0.1);
    bench.run(20.0);
    assert!((bench.forward_mps() - 0.05).abs() < 1e-3);
    let [x, ..] = bench.position_m();
    assert!((x - 1.0).abs() < 0.02, "{x}");
}

#[test]
fn moving_off_after_a_long_rest_is_followed_at_once() {
    let mut bench = Bench::on_wheels();
    bench.run(600.0);
    bench.drive(0.0, 0.4, 0.1);
    assert!((bench.forward_mps() - 0.4).abs() < 0.02);
}

/// On its own a wheel runs slower inside a left turn by yaw rate · half the track: 2 rad/s · 0.21 m.
#[test]
fn one_wheel_and_the_yaw_rate_are_enough() {
    for silent in [0, 1] {
        let mut bench = Bench::on_wheels();
        bench.pose.rate_rps = [0.0, 0.0, 2.0];
        bench.wheels_run([-0.42, 0.42]);
        bench.motor.wheels[silent].age_us = 50_001;
        bench.run(1.0);
        assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
    }
}

/// The motor turns with the body: leaning forward at 1 rad/s over wheels that stand turns the rotor backward by 1 rad/s
/// of the wheel.
#[test]
fn pitching_over_standing_wheels_is_no_motion() {
    let mut bench = Bench::on_wheels();
    bench.pose.rate_rps = [0.0, 1.0, 0.0];
    bench.wheels_run([-0.06, -0.06]);
    bench.run(0.5);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-2);
}

/// Wheels spin up to 2 m/s within 0.1 s, nothing accelerates the robot.
fn spin_up(bench: &mut Bench) {
    for sample in 1..=20 {
        let mps = 0.1 * sample as f32;
        bench.wheels_run([mps, mps]);
        bench.sample();
    }
}

/// Somebody carries the robot, or it is pushed: slip from the first samples on, for 2 s.
#[test]
fn slipping_wheels_of_a_shaken_robot_are_not_believed_for_two_seconds() {
    let mut bench = Bench::on_wheels();
    bench.accel_mps2 = [0.0, 0.5, GRAVITY_MPS2];
    bench.sample();
    bench.accel_mps2 = [0.0, 0.0, GRAVITY_MPS2];
    spin_up(&mut bench);
    bench.run(1.8);
    assert!(bench.forward_mps().abs() < 0.1, "{}", bench.forward_mps());
    bench.run(0.4);
    assert!((bench.forward_mps() - 2.0).abs() < 0.1);
}

/// In the air, body at rest: whatever the wheels do, fast or slow, together or against each other, for however long.
#[test]
fn wheels_that_spin_beside_a_robot_at_rest_move_nothing() {
    let mut bench = Bench::on_wheels();
    let speeds = [
        [2.0, 2.0],
        [0.5, 0.5],
        [0.2, 0.2],
        [-0.4, 0.4],
        [-1.0, -1.0],
        [0.6, 0.0],
    ];
    for [left, right] in speeds {
        for share in 1..=20 {
            let share = share as f32 / 20.0;
            bench.wheels_run([share * left, share * right]);
            bench.sample();
        }
        for _ in 0..2_000 {
            bench.sample();
            let [x, y, _] = bench.velocity_mps();
            assert!(x.hypot(y) < 0.15, "{left} {right}: {x} {y}");
        }
        assert_close(bench.velocity_mps(), [0.0; 3], 0.02);
        bench.wheels_run([0.0; 2]);
        bench.run(0.6);
        assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
        let [x, y, _] = bench.position_m();
        assert!(x.hypot(y) < 0.05, "{x} {y}");
    }
    bench.drive(0.0, 1.0, 0.5);
    assert!((bench.forward_mps() - 1.0).abs() < 0.02, "it drives off");
}

/// As a thumb pushes the stick: 0.3 m/s² that nothing feels.
#[test]
fn wheels_that_spin_up_slowly_are_found_out() {
    let mut bench = Bench::on_wheels();
    for sample in 0..800 {
        let mps = (0.3 * 0.005 * sample as f32).min(0.6);
        bench.wheels_run([mps, mps]);
        bench.sample();
        assert!(
            bench.forward_mps().abs() < 0.2,
            "{} at {mps}",
            bench.forward_mps()
        );
    }
    assert!(bench.forward_mps().abs() < 0.02, "{}", bench.forward_mps());
}

/// Very smooth ice: 0.2 m/s², less than what shakes a robot. It moves off all the same.
#[test]
fn a_robot_that_glides_away_under_spinning_wheels_is_not_held() {
    let mut bench = Bench::on_wheels();
    bench.accel_mps2 = [0.2, 0.0, GRAVITY_MPS2];
    bench.wheels_run([1.5, 1.5]);
    bench.run(1.9);
    let mps = bench.forward_mps();
    assert!((0.15..0.5).contains(&mps), "{mps} of 0.38");
}

/// Driving, one wheel runs away from what the gyro says: the other one is believed.
#[test]
fn of_two_wheels_that_contradict_the_gyro_the_one_further_off_slips() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.run(4.0);
    for sample in 1..=400 {
        let more = 0.002 * sample as f32;
        bench.wheels_run([1.0, 1.0 + more]);
        bench.sample();
    }
    bench.run(5.0);
    assert!(
        (bench.forward_mps() - 1.0).abs() < 0.05,
        "{}",
        bench.forward_mps()
    );
}

#[test]
fn one_slipping_wheel_is_left_out_for_as_long_as_it_slips() {
    let mut bench = Bench::on_wheels();
    bench.wheels_run([0.0, 1.5]);
    bench.run(10.0);
    assert!(bench.forward_mps().abs() < 0.02, "{}", bench.forward_mps());
}

#[test]
fn grip_returns_once_the_speeds_agree_for_a_tenth_of_a_second() {
    let mut grip = Grip::Rolling;
    for _ in 0..100 {
        grip = grip.step(0.29, DT_S);
    }
    assert!(grip.rolls());
    grip = grip.step(-0.31, DT_S);
    assert!(!grip.rolls());
    // It passes by.
    for _ in 0..15 {
        grip = grip.step(0.02, DT_S);
    }
    grip = grip.step(0.2, DT_S);
    for _ in 0..19 {
        grip = grip.step(0.02, DT_S);
        assert!(!grip.rolls());
    }
    grip = grip.step(0.02, DT_S).step(0.02, DT_S);
    assert!(grip.rolls());
}

/// 1 m/s when the wheels fall silent, and an accelerometer that is 0.3 m/s² off: 2 s by it, then it fades.
#[test]
fn without_wheels_the_speed_fades_and_the_way_ends() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.motor = MotorFeedback::default();
    bench.accel_mps2 = [0.3, 0.0, GRAVITY_MPS2];
    bench.run(1.9);
    assert!((bench.forward_mps() - 1.57).abs() < 0.05);
    bench.run(10.0);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
    let before_m = bench.position_m();
    bench.run(600.0);
    assert_close(bench.position_m(), before_m, 1e-3);
}

/// Lying on its side the robot does not roll, however fast the wheels turn.
#[test]
fn wheels_of_a_fallen_robot_say_nothing() {
    let mut bench = Bench::on_wheels();
    let half = core::f32::consts::FRAC_1_SQRT_2;
    bench.pose.orientation = Quaternion {
        w: half,
        x: half,
        y: 0.0,
        z: 0.0,
    };
    bench.accel_mps2 = [0.0, GRAVITY_MPS2, 0.0];
    bench.wheels_run([1.0, 1.0]);
    bench.run(5.0);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
}

/// After half a second e⁻¹ of the speed is left, and 0.5 · 0.5 · (1 − e⁻¹) m are gone.
#[test]
fn the_speed_fades_while_the_imu_is_silent() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 0.5, 0.2);
    let [before_m, ..] = bench.position_m();
    for _ in 0..500 {
        bench.motion.fade(0.001);
    }
    let [after_m, ..] = bench.position_m();
    assert!((bench.forward_mps() - 0.184).abs() < 0.01);
    assert!((after_m - before_m - 0.158).abs() < 0.01);
}

/// A 100 km way in steps of 1 mm: a plain single-precision sum would be kilometres off.
#[test]
fn small_steps_far_from_home_are_kept() {
    let mut position = Position::new();
    let mut exact_m = 0.0;
    for _ in 0..100_000_000 {
        position.add([1e-3, 0.0, 0.0]);
        exact_m += f64::from(1e-3_f32);
    }
    let [x, ..] = position.total_m();
    assert!((f64::from(x) - exact_m).abs() < 0.01, "{x}");
}

/// Settings that are no numbers, and the largest values a sensor may give.
#[test]
fn extremes_leave_nothing_behind() {
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1e20] {
        let mut bench = Bench::on_wheels();
        let default = WheelOdomConfig::default();
        for config in [
            WheelOdomConfig {
                wheel_radius_m: odd,
                ..default
            },
            WheelOdomConfig {
                wheel_track_m: odd,
                ..default
            },
            WheelOdomConfig {
                gear_ratio: 1.0 / odd,
                ..default
            },
            default,
        ] {
            bench.motion.set_config(&config);
            bench.accel_mps2 = [300.0, -300.0, 300.0];
            bench.pose.rate_rps = [-40.0, 40.0, 40.0];
            bench.wheels_run([10.0, -10.0]);
            bench.run(0.5);
            let all = [
                bench.velocity_mps(),
                bench.position_m(),
                bench.motion.accel_bias_mps2(),
                bench.motion.kinematic_mps2(),
            ];
            assert!(
                all.as_flattened().iter().all(|x| x.abs() < 500.0),
                "{all:?}"
            );
        }
        bench.accel_mps2 = [0.0, 0.0, GRAVITY_MPS2];
        bench.pose.rate_rps = [0.0; 3];
        bench.wheels_run([0.0, 0.0]);
        bench.run(8.0);
        assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
        assert_close(bench.motion.accel_bias_mps2(), [0.0; 3], 1e-2);
    }
}

/// Wheels spinning, so that nothing corrects; pushed east at 2 m/s² for a second while it turns at 20 rad/s. Each sample
/// is the force's mean over its interval, in axes that turn meanwhile.
#[test]
fn a_force_is_taken_where_the_body_was_in_the_middle_of_its_sample() {
    let mut bench = Bench::on_wheels();
    bench.wheels_run([5.0, 5.0]);
    bench.pose.rate_rps = [0.0, 0.0, 20.0];
    for sample in 1..=200_u16 {
        let end_rad = 20.0 * f64::from(sample) * 0.005;
        let (sin, cos) = (end_rad - 0.05).sin_cos();
        let mean = 2.0 * 0.05_f64.sin() / 0.05;
        bench.accel_mps2 = [(mean * cos) as f32, (-mean * sin) as f32, GRAVITY_MPS2];
        bench.pose.orientation = turned_left(end_rad);
        bench.sample();
    }
    assert_close(bench.velocity_mps(), [2.0, 0.0, 0.0], 0.02);
}

/// Somebody carries the robot off, its wheels stand: they explain no force.
#[test]
fn standing_wheels_accelerate_nothing() {
    let mut bench = Bench::on_wheels();
    bench.run(1.0);
    for sample in 0..400 {
        let push_mps2 = (0.02 * sample as f32).sin();
        bench.accel_mps2 = [push_mps2, -push_mps2, GRAVITY_MPS2];
        bench.sample();
        assert_eq!(bench.motion.kinematic_mps2(), [0.0; 3], "{sample}");
    }
}

/// Round a circle of 0.5 m at 2 rad/s, the IMU's samples turned with the body: all of the force is kinematic.
#[test]
fn a_circle_is_no_tilt() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.accel_mps2 = [0.0, 2.0, GRAVITY_MPS2];
    bench.pose.rate_rps = [0.0, 0.0, 2.0];
    bench.wheels_run([0.58, 1.42]);
    for sample in 1..=1_000_u16 {
        bench.pose.orientation = turned_left(2.0 * 0.005 * f64::from(sample));
        bench.sample();
        assert_close(bench.motion.kinematic_mps2(), [0.0, 2.0, 0.0], 0.1);
    }
}
