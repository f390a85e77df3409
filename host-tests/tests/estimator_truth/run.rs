//! The estimator on a simulated motion, compared with the truth tick by tick.

use robot_app::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig},
    estimation::InsEstimator,
};
use robot_test_support::{Rotation, Vector};

use crate::{
    error::{AttitudeError, Worst},
    motion::Motion,
    sensors::Sensors,
    world::World,
};

const TICK_US: u64 = 1_000;

pub struct Run {
    world: World,
    estimator: InsEstimator,
    imu: ImuState,
    mag: MagState,
    wheel_config: WheelOdomConfig,
    motor: MotorFeedback,
    pub estimate: StateEstimate,
    tick: u64,
}

impl Run {
    pub fn new(motion: Motion, sensors: Sensors) -> Self {
        Self {
            world: World::new(motion, sensors),
            estimator: InsEstimator::new(WheelOdomConfig::default()),
            imu: ImuState::default(),
            mag: MagState::default(),
            wheel_config: WheelOdomConfig::default(),
            motor: MotorFeedback::default(),
            estimate: StateEstimate::default(),
            tick: 0,
        }
    }

    /// One tick of 1 ms.
    pub fn step(&mut self) {
        self.step_after(1);
    }

    /// A tick `ticks` ms after the last.
    pub fn step_after(&mut self, ticks: u64) {
        self.tick += ticks;
        let elapsed_us = self.tick * TICK_US;
        self.world.advance_to(elapsed_us);
        while let Some(sample) = self.world.imu_due(elapsed_us) {
            self.imu = sample;
        }
        while let Some(sample) = self.world.mag_due(elapsed_us) {
            self.mag = sample;
        }
        let now_us = self.world.clock_us(elapsed_us);
        self.turn_wheels(now_us);
        self.estimator.step(
            &self.imu,
            &self.mag,
            &self.motor,
            now_us,
            &mut self.estimate,
        );
        assert_valid_state(&self.estimate, now_us);
    }

    /// Rotor speed in rpm: ground speed over the wheel's circumference, times the gear ratio.
    fn turn_wheels(&mut self, now_us: u64) {
        self.motor.ts_us = now_us;
        let Some(wheels_mps) = self.world.wheels_mps() else {
            return;
        };
        let config = self.wheel_config;
        let turn_m = std::f64::consts::TAU * f64::from(config.wheel_radius_m);
        let signs = [config.rpm_sign_left, config.rpm_sign_right].map(f64::from);
        for (wheel, (mps, sign)) in self
            .motor
            .wheels
            .iter_mut()
            .zip(wheels_mps.into_iter().zip(signs))
        {
            wheel.rpm = (sign * mps / turn_m * f64::from(config.gear_ratio) * 60.0).round() as i16;
            wheel.age_us = 0;
            wheel.ts_us = now_us;
        }
    }

    /// Does a `step`, and then repeats the samples with other values but the same time stamps.
    pub fn step_then_repeat_other_values(&mut self) {
        self.step();
        self.imu.gyro_dps = [500.0, -300.0, 100.0];
        self.imu.accel_mps2 = [5.0, 5.0, -5.0];
        self.mag.mag_ut = [-40.0, 10.0, 5.0];
    }

    /// The largest errors from now until `until_s`.
    pub fn worst(&mut self, until_s: f64) -> Worst {
        let mut worst = Worst::default();
        let first = self.error();
        while self.time_s() < until_s - 1e-6 {
            let before = (self.attitude(), self.world.attitude());
            self.step();
            let turn = |from: Rotation, to: Rotation| from.inverse().then_in_body(to);
            let estimated = turn(before.0, self.attitude());
            let real = turn(before.1, self.world.attitude());
            let jump = real.inverse().then_in_body(estimated);
            worst.add(self.error(), first, jump.angle_deg());
        }
        worst
    }

    /// Runs until `until_s` without checking the errors.
    pub fn skip(&mut self, until_s: f64) {
        while self.time_s() < until_s - 1e-6 {
            self.step();
        }
    }

    pub fn time_s(&self) -> f64 {
        (self.tick * TICK_US) as f64 * 1e-6
    }

    pub fn error(&self) -> AttitudeError {
        AttitudeError::between(self.attitude(), self.world.attitude())
    }

    pub fn attitude(&self) -> Rotation {
        Rotation::from_wxyz(self.estimate.q_wxyz.map(f64::from))
    }

    /// The estimated up axis in the body frame.
    pub fn up(&self) -> Vector {
        self.attitude().inverse().turn([0.0, 0.0, 1.0])
    }

    /// Error of the estimated gyro bias.
    pub fn bias_error_dps(&self) -> f64 {
        let truth = self.world.gyro_offset_dps();
        let found = self
            .estimate
            .gyro_bias_rps
            .map(|rate| f64::from(rate).to_degrees());
        let squares = truth
            .iter()
            .zip(found)
            .map(|(truth, found)| (truth - found).powi(2));
        squares.sum::<f64>().sqrt()
    }
}

/// What holds in every tick for any input: finite values, unit length, and angles that match the quaternion.
pub fn assert_valid_state(estimate: &StateEstimate, now_us: u64) {
    let StateEstimate {
        q_wxyz,
        rpy_rad,
        vel_mps,
        pos_m,
        gyro_bias_rps,
        accel_bias_mps2,
        ts_us,
        valid: _,
    } = estimate;
    let finite = |values: &[f32]| values.iter().all(|value| value.is_finite());
    assert!(
        finite(q_wxyz)
            && [rpy_rad, vel_mps, pos_m, gyro_bias_rps, accel_bias_mps2]
                .iter()
                .all(|values| finite(*values)),
        "not finite: {estimate:?}"
    );
    let q_wxyz = q_wxyz.map(f64::from);
    let length = q_wxyz.iter().map(|part| part * part).sum::<f64>().sqrt();
    assert!((length - 1.0).abs() < 1e-5, "length {length}: {estimate:?}");
    let attitude = Rotation::from_wxyz(q_wxyz);
    assert_eq!(*ts_us, now_us);
    let [roll, pitch, yaw] = rpy_rad.map(f64::from);
    let from_angles = Rotation::by([0.0, 0.0, yaw])
        .then_in_body(Rotation::by([0.0, pitch, 0.0]))
        .then_in_body(Rotation::by([roll, 0.0, 0.0]));
    let between = attitude.inverse().then_in_body(from_angles).angle_deg();
    // Near the vertical roll and yaw merge. The rounding of the sine, √(2 · 2⁻²³) rad, limits what is left of them.
    if pitch.sin().abs() < 0.9999 {
        assert!(between < 0.1, "angles {between}° off: {estimate:?}");
    }
}
