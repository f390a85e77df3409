//! The estimator of the control tick.

use super::{
    attitude::{AttitudeFilter, Footing, Saturation},
    motion::{AccelSample, AxlePath, BodyPose, MotionEstimator},
};
use crate::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig, age_us},
    kinematics::Leg,
    math::{Vector3, scalar, vector},
};

/// Oldest IMU sample from which the present attitude is extrapolated.
const MAX_IMU_AGE_US: u32 = 25_000;
/// Longest interval between samples that is bridged.
const MAX_SAMPLE_GAP_US: u32 = 100_000;
/// Samples in a row before the estimate is valid.
const MIN_CONSECUTIVE_SAMPLES: u16 = 100;
/// Longest interval between two ticks. A longer one is a jump in time.
const MAX_TICK_US: u32 = 20_000;
/// Largest values that can be measurements: beyond the widest ranges of the BMI088 (±2000 °/s, ±24 g) and of the IST8310
/// (±2500 µT), with room for calibration. The square of a larger value would overflow into the states of the filters.
const MAX_RATE_DPS: f32 = 2_500.0;
const MAX_ACCEL_MPS2: f32 = 300.0;
const MAX_FIELD_UT: f32 = 5_000.0;
/// Limit of the time between a field sample and the last IMU sample.
const MAX_MAG_AGE_S: f32 = 0.03;

/// After a restart with other axes, samples taken within this time may still have the old ones: the sensor tasks read the
/// settings before each sample.
const OLD_AXES_US: u64 = 25_000;

/// Where the heading comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeadingSource {
    /// Magnetometer and gyro. A heading of 0 is magnetic east.
    Magnetometer,
    /// The gyro alone, because the axes of the magnetometer are not known. A heading of 0 is where the robot pointed at
    /// power-on.
    GyroOnly,
}

/// Estimates attitude, heading, velocity and position from IMU, magnetometer and wheels.
///
/// [`step`](Self::step) is called at 1 kHz with the newest samples. It uses each sample once and extrapolates between
/// them.
///
/// ```
/// use robot_app::{
///     domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig},
///     estimation::InsEstimator,
/// };
///
/// let mut estimator = InsEstimator::new(WheelOdomConfig::default());
/// let mut estimate = StateEstimate::default();
/// // One second at rest with the nose up by 30°: half of gravity is along the body's x axis. No magnetometer, no wheels.
/// let mut imu = ImuState { accel_mps2: [4.903, 0.0, 8.493], ..ImuState::default() };
/// for now_us in (1_000..=1_000_000).step_by(1_000) {
///     if now_us % 5_000 == 0 {
///         imu.ts_us = now_us;
///     }
///     let (mag, motor) = (MagState::default(), MotorFeedback::default());
///     estimator.step(&imu, &mag, &motor, now_us, &mut estimate);
/// }
/// assert!(estimate.valid);
/// let [roll, pitch, _] = estimate.rpy_rad;
/// assert!(roll.abs() < 1e-3);
/// assert!((pitch.to_degrees() + 30.0).abs() < 0.1); // pitch is positive with the nose down
/// ```
///
/// Wheels give velocity and position. Here the left rotor turns at +1467 rpm and the right, mirrored one at −1467 rpm,
/// which is 0.6 m/s with the default wheels:
///
/// ```
/// # use robot_app::{
/// #     domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig},
/// #     estimation::InsEstimator,
/// # };
/// let mut estimator = InsEstimator::new(WheelOdomConfig::default());
/// let mut estimate = StateEstimate::default();
/// let mut imu = ImuState { accel_mps2: [0.0, 0.0, 9.80665], ..ImuState::default() };
/// let mut motor = MotorFeedback::default();
/// for (wheel, rpm) in motor.wheels.iter_mut().zip([1_467, -1_467]) {
///     wheel.rpm = rpm;
///     wheel.age_us = 1_000;
/// }
/// for now_us in (1_000..=3_000_000).step_by(1_000) {
///     if now_us % 5_000 == 0 {
///         imu.ts_us = now_us;
///     }
///     estimator.step(&imu, &MagState::default(), &motor, now_us, &mut estimate);
/// }
/// let [east, north, up] = estimate.vel_mps;
/// assert!((east - 0.6).abs() < 0.01 && north.abs() < 0.01 && up.abs() < 0.01);
/// ```
#[derive(Clone, Debug)]
pub struct InsEstimator {
    attitude: AttitudeFilter,
    motion: MotionEstimator,
    /// Time of the last IMU sample that was looked at.
    imu_seen_us: u64,
    /// Time of the last IMU sample that was used.
    imu_ts_us: u64,
    mag_ts_us: u64,
    applied_bias_dps: Vector3,
    consecutive_samples: u16,
    /// At the last sample there were enough in a row, and the tilt was known.
    trusted: bool,
    /// Samples up to this time are ignored.
    ignore_until_us: u64,
    heading_source: HeadingSource,
    /// Height of the IMU above the hip centre in m.
    imu_up_m: f32,
    /// Time of the last tick, 0 = none yet.
    ts_us: u64,
}

impl InsEstimator {
    /// An estimator before its first tick, which uses the magnetometer.
    pub fn new(odometry: WheelOdomConfig) -> Self {
        Self {
            attitude: AttitudeFilter::new(),
            motion: MotionEstimator::new(&odometry),
            imu_seen_us: 0,
            imu_ts_us: 0,
            mag_ts_us: 0,
            applied_bias_dps: [0.0; 3],
            consecutive_samples: 0,
            trusted: false,
            ignore_until_us: 0,
            heading_source: HeadingSource::Magnetometer,
            imu_up_m: 0.0,
            ts_us: 0,
        }
    }

    /// Takes effect with the next sample.
    pub fn set_heading_source(&mut self, source: HeadingSource) {
        self.heading_source = source;
    }

    /// Sets the height of the IMU above the hip centre in m. It matters on moving legs only.
    pub fn set_imu_height(&mut self, imu_up_m: f32) {
        self.imu_up_m = imu_up_m;
    }

    /// Changes the dimensions of the wheels. The estimate so far stays.
    pub fn set_odometry(&mut self, odometry: &WheelOdomConfig) {
        self.motion.set_config(odometry);
    }

    /// Starts again, because the axes of the sensors have changed. Samples that may have the old axes are ignored.
    #[cold]
    #[inline(never)]
    pub fn restart(
        &mut self,
        odometry: &WheelOdomConfig,
        heading_source: HeadingSource,
        now_us: u64,
    ) {
        *self = Self {
            heading_source,
            imu_up_m: self.imu_up_m,
            ignore_until_us: now_us.saturating_add(OLD_AXES_US),
            ts_us: now_us,
            ..Self::new(*odometry)
        };
    }

    /// Updates `estimate` to `now_us`, for a body that sits stiffly on its axle. The ages in `motor` refer to `now_us`.
    /// [`StateEstimate::valid`] lists what makes the estimate invalid.
    pub fn step(
        &mut self,
        imu: &ImuState,
        mag: &MagState,
        motor: &MotorFeedback,
        now_us: u64,
        estimate: &mut StateEstimate,
    ) {
        self.step_on_legs(imu, mag, motor, || None, now_us, estimate);
    }

    /// The same for a body on moving legs, left and right, or `None` while they are not known. `legs` is called when
    /// there is a new IMU sample. It is out of line, as the tick is faster so.
    #[inline(never)]
    pub fn step_on_legs(
        &mut self,
        imu: &ImuState,
        mag: &MagState,
        motor: &MotorFeedback,
        legs: impl FnOnce() -> Option<[Leg; 2]>,
        now_us: u64,
        estimate: &mut StateEstimate,
    ) {
        let elapsed_us = if self.ts_us == 0 {
            0
        } else {
            self.elapsed_us(now_us)
        };
        let mut sample = None;
        if imu.ts_us != self.imu_seen_us && imu.ts_us != 0 {
            self.imu_seen_us = imu.ts_us;
            if imu.ts_us > self.ignore_until_us {
                sample = self.process_imu(imu);
            }
        }
        if mag.ts_us != self.mag_ts_us && mag.ts_us != 0 {
            self.mag_ts_us = mag.ts_us;
            self.process_mag(mag);
        }
        self.ts_us = now_us;
        let sample = sample.map(|sample| (sample, legs()));
        self.publish(sample, motor, elapsed_us, now_us, estimate);
    }

    /// Time since the last tick. If time ran backwards, stood still or jumped, it is 0, and the estimate is invalid.
    fn elapsed_us(&mut self, now_us: u64) -> u32 {
        let elapsed_us = now_us.wrapping_sub(self.ts_us);
        if elapsed_us.wrapping_sub(1) < u64::from(MAX_TICK_US) {
            return elapsed_us as u32;
        }
        self.consecutive_samples = 0;
        self.trusted = false;
        self.motion.restart();
        0
    }

    fn process_imu(&mut self, imu: &ImuState) -> Option<AccelSample> {
        if !is_measurement(imu) {
            self.consecutive_samples = 0;
            self.trusted = false;
            return None;
        }
        let gap_us = age_us(self.imu_ts_us, imu.ts_us);
        let continuous = imu.ts_us > self.imu_ts_us && gap_us <= MAX_SAMPLE_GAP_US;
        self.imu_ts_us = imu.ts_us;
        if self.applied_bias_dps != imu.gyro_bias_dps {
            self.applied_bias_dps = imu.gyro_bias_dps;
            self.attitude.reset_bias();
        }
        if !continuous {
            self.consecutive_samples = 0;
            self.attitude.restart_after_gap();
            self.motion.restart();
        }
        let dt_s = if continuous { seconds(gap_us) } else { 0.0 };
        let gyro_rps = imu.gyro_dps.map(f32::to_radians);
        let saturation = Saturation {
            any: imu.saturated,
            gyro_ms: imu.gyro_clipped_ms,
        };
        // Without the acceleration of the known motion the force points up.
        let gravity_mps2 = vector::sub(imu.accel_mps2, self.motion.kinematic_mps2());
        let converged = self
            .attitude
            .feed_imu(gyro_rps, gravity_mps2, saturation, dt_s);
        self.consecutive_samples = if converged {
            self.consecutive_samples.saturating_add(1)
        } else {
            0
        };
        self.trusted =
            self.consecutive_samples >= MIN_CONSECUTIVE_SAMPLES && self.attitude.knows_tilt();
        // What saturation cuts off does not average out, so the velocity would be wrong for good.
        let accel_mps2 = (!imu.saturated).then_some(imu.accel_mps2);
        Some(AccelSample { accel_mps2, dt_s })
    }

    fn process_mag(&mut self, mag: &MagState) {
        let is_used =
            self.heading_source == HeadingSource::Magnetometer && mag.ts_us > self.ignore_until_us;
        if is_used && self.consecutive_samples > 0 && vector::is_within(mag.mag_ut, MAX_FIELD_UT) {
            let ahead_s = if mag.ts_us >= self.imu_ts_us {
                seconds(age_us(self.imu_ts_us, mag.ts_us))
            } else {
                -seconds(age_us(mag.ts_us, self.imu_ts_us))
            };
            let ahead_s = scalar::clamp(ahead_s, -MAX_MAG_AGE_S, MAX_MAG_AGE_S);
            self.attitude.feed_mag(mag.mag_ut, ahead_s);
        }
    }

    fn publish(
        &mut self,
        sample: Option<(AccelSample, Option<[Leg; 2]>)>,
        motor: &MotorFeedback,
        elapsed_us: u32,
        now_us: u64,
        estimate: &mut StateEstimate,
    ) {
        let imu_age_us = age_us(self.imu_ts_us, now_us);
        let ahead_s = seconds(imu_age_us.min(MAX_IMU_AGE_US));
        let orientation = self.attitude.orientation(ahead_s);
        if let Some((sample, legs)) = sample {
            let paths = legs.map(|legs| legs.map(|leg| AxlePath::new(&leg, self.imu_up_m)));
            let pose = BodyPose {
                orientation,
                rate_rps: self.attitude.rate_rps(),
            };
            self.motion
                .feed(&sample, ahead_s, &pose, motor, paths.as_ref());
            self.attitude.set_footing(match paths {
                None => Footing::Any,
                Some(_) if self.motion.stands => Footing::StandingLegs,
                Some(_) => Footing::Legs,
            });
        }
        if imu_age_us > MAX_IMU_AGE_US {
            self.motion.decay(seconds(elapsed_us));
        }
        estimate.q_wxyz = orientation.to_wxyz();
        estimate.rpy_rad = orientation.roll_pitch_yaw();
        (estimate.vel_mps, estimate.pos_m) = self.motion.extrapolate(ahead_s);
        estimate.gyro_bias_rps = self.attitude.bias_rps();
        estimate.accel_bias_mps2 = self.motion.accel_bias_mps2();
        estimate.ts_us = now_us;
        estimate.valid = imu_age_us <= MAX_IMU_AGE_US && self.trusted;
    }
}

/// False for values that no sensor can measure, NaN among them.
fn is_measurement(imu: &ImuState) -> bool {
    vector::is_within(imu.gyro_dps, MAX_RATE_DPS)
        && vector::is_within(imu.gyro_bias_dps, MAX_RATE_DPS)
        && vector::is_within(imu.accel_mps2, MAX_ACCEL_MPS2)
}

fn seconds(us: u32) -> f32 {
    us as f32 * 1e-6
}
