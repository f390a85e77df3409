//! The motion estimator on motions worked out by hand.

mod driving;
mod gains;
mod legs;
mod slipping;
mod unaided;

use super::*;
use crate::{domain::WheelFeedback, math::Quaternion};

const GRAVITY_MPS2: f32 = 9.806_65;
const DT_S: f32 = 0.005;
/// 1834 rpm of the rotor are 10 rad/s of a wheel with a radius of 0.06 m.
const RPM_PER_MPS: f32 = 1_834.0 / 0.6;

/// A motion estimator with made-up sensors.
struct Bench {
    motion: MotionEstimator,
    pose: BodyPose,
    motor: MotorFeedback,
    legs: Option<[AxlePath; 2]>,
    /// Specific force in body axes.
    accel_mps2: Vector3,
}

impl Bench {
    /// Level, facing east, at rest, without wheel feedback.
    fn new() -> Self {
        Self {
            motion: MotionEstimator::new(&WheelOdomConfig {
                wheel_radius_m: 0.06,
                ..WheelOdomConfig::default()
            }),
            pose: BodyPose {
                orientation: Quaternion::IDENTITY,
                rate_rps: [0.0; 3],
            },
            motor: MotorFeedback::default(),
            legs: None,
            accel_mps2: [0.0, 0.0, GRAVITY_MPS2],
        }
    }

    /// At rest for a second, with wheel feedback.
    fn on_wheels() -> Self {
        let mut bench = Self::new();
        bench.wheels_run([0.0, 0.0]);
        bench.run(1.0);
        bench
    }

    /// Sets the wheel speeds, forward positive.
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
        let legs = self.legs.as_ref();
        self.motion
            .feed(&sample, 0.0, &self.pose, &self.motor, legs);
    }

    fn run(&mut self, seconds: f32) {
        for _ in 0..(seconds / DT_S).round() as u32 {
            self.sample();
        }
    }

    /// Accelerates evenly from one speed to another, forward, with both wheels.
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
        self.motion.extrapolate(0.0).0
    }

    fn position_m(&self) -> Vector3 {
        self.motion.extrapolate(0.0).1
    }

    fn forward_mps(&self) -> f32 {
        let [x, ..] = self.velocity_mps();
        x
    }
}

/// Facing `yaw_rad` to the left of east, computed in double precision.
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
