//! The estimator of the main chain.

use super::{
    attitude::{AttitudeFilter, Clipped},
    motion::{AccelSample, BodyPose, MotionEstimator},
};
use crate::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig, age_us},
    math::{Vector3, scalar, vector},
};

/// An IMU sample older than this says nothing about the attitude now.
const MAX_IMU_AGE_US: u32 = 25_000;
/// Samples further apart than this leave a gap that cannot be bridged.
const MAX_SAMPLE_GAP_US: u32 = 100_000;
/// Samples in a row before the estimate counts.
const SETTLING_SAMPLES: u16 = 100;
/// A tick further from the last than this is a jump in time.
const MAX_TICK_US: u32 = 20_000;
/// Beyond what the BMI088 can measure at any setting (±2000 °/s, ±24 g) and the IST8310 at all (±2500 µT), with room
/// for calibration. A larger value is no measurement, and its square would overflow into the filters' memories.
const MAX_RATE_DPS: f32 = 2_500.0;
const MAX_ACCEL_MPS2: f32 = 300.0;
const MAX_FIELD_UT: f32 = 5_000.0;
/// A field sample older than this, or newer, is turned to the present as if it were only so old.
const MAX_MAG_AGE_S: f32 = 0.03;

/// A sample that was measured so long after the settings changed was turned by the new ones: the sensors' tasks look at the
/// settings before each.
const OLD_AXES_US: u64 = 25_000;

/// Whether the magnetometer's samples are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    ShowsNorth,
    /// Nobody knows how the magnetometer sits: the heading is carried by the gyro alone and begins with 0 (east) where the
    /// robot is switched on.
    Unknown,
}

/// Called at 1 kHz with the latest samples; uses each sample once and carries the attitude on between them.
#[derive(Clone, Debug)]
pub struct InsEstimator {
    attitude: AttitudeFilter,
    motion: MotionEstimator,
    /// Last sample looked at.
    imu_seen_us: u64,
    /// Last sample used.
    imu_ts_us: u64,
    mag_ts_us: u64,
    applied_bias_dps: Vector3,
    settled_samples: u16,
    /// As of the last sample: there were enough, and up is known.
    trusted: bool,
    /// What was measured until then is not looked at.
    deaf_until_us: u64,
    field: Field,
    /// Last tick, 0 = none yet.
    ts_us: u64,
}

impl InsEstimator {
    pub fn new(odometry: WheelOdomConfig) -> Self {
        Self {
            attitude: AttitudeFilter::new(),
            motion: MotionEstimator::new(&odometry),
            imu_seen_us: 0,
            imu_ts_us: 0,
            mag_ts_us: 0,
            applied_bias_dps: [0.0; 3],
            settled_samples: 0,
            trusted: false,
            deaf_until_us: 0,
            field: Field::ShowsNorth,
            ts_us: 0,
        }
    }

    /// Counts from the next sample on.
    pub fn set_field(&mut self, field: Field) {
        self.field = field;
    }

    /// Other wheels from now on; everything known so far stays.
    pub fn set_odometry(&mut self, odometry: &WheelOdomConfig) {
        self.motion.set_config(odometry);
    }

    /// The sensors' axes are others from now on: begins anew.
    #[cold]
    #[inline(never)]
    pub fn restart(&mut self, odometry: &WheelOdomConfig, field: Field, now_us: u64) {
        *self = Self {
            field,
            deaf_until_us: now_us.saturating_add(OLD_AXES_US),
            ts_us: now_us,
            ..Self::new(*odometry)
        };
    }

    /// Renews `estimate`. `motor`: with ages as of `now_us`. What makes the estimate invalid is listed at
    /// [`StateEstimate::valid`].
    pub fn step(
        &mut self,
        imu: &ImuState,
        mag: &MagState,
        motor: &MotorFeedback,
        now_us: u64,
        estimate: &mut StateEstimate,
    ) {
        let passed_us = if self.ts_us == 0 {
            0
        } else {
            self.passed_us(now_us)
        };
        let mut sample = None;
        if imu.ts_us != self.imu_seen_us && imu.ts_us != 0 {
            self.imu_seen_us = imu.ts_us;
            if imu.ts_us > self.deaf_until_us {
                sample = self.take_imu(imu);
            }
        }
        if mag.ts_us != self.mag_ts_us && mag.ts_us != 0 {
            self.mag_ts_us = mag.ts_us;
            self.take_mag(mag);
        }
        self.ts_us = now_us;
        self.publish(sample, motor, passed_us, now_us, estimate);
    }

    /// Since the last tick; 0 if time ran backwards, stood still or jumped.
    fn passed_us(&mut self, now_us: u64) -> u32 {
        let passed_us = now_us.wrapping_sub(self.ts_us);
        if passed_us.wrapping_sub(1) < u64::from(MAX_TICK_US) {
            return passed_us as u32;
        }
        self.settled_samples = 0;
        self.trusted = false;
        self.motion.restart();
        0
    }

    fn take_imu(&mut self, imu: &ImuState) -> Option<AccelSample> {
        if !is_measurement(imu) {
            self.settled_samples = 0;
            self.trusted = false;
            return None;
        }
        let gap_us = age_us(self.imu_ts_us, imu.ts_us);
        let continuous = imu.ts_us > self.imu_ts_us && gap_us <= MAX_SAMPLE_GAP_US;
        self.imu_ts_us = imu.ts_us;
        if self.applied_bias_dps != imu.gyro_bias_dps {
            self.applied_bias_dps = imu.gyro_bias_dps;
            self.attitude.restart_bias();
        }
        if !continuous {
            self.settled_samples = 0;
            self.attitude.restart_after_gap();
            self.motion.restart();
        }
        let dt_s = if continuous { seconds(gap_us) } else { 0.0 };
        let gyro_rps = imu.gyro_dps.map(f32::to_radians);
        let clipped = Clipped {
            accel: imu.saturated,
            gyro_ms: imu.gyro_clipped_ms,
        };
        // Without what the known motion adds, the force points up.
        let standing_mps2 = vector::sub(imu.accel_mps2, self.motion.kinematic_mps2());
        let kept = self
            .attitude
            .feed_imu(gyro_rps, standing_mps2, clipped, dt_s);
        self.settled_samples = if kept {
            self.settled_samples.saturating_add(1)
        } else {
            0
        };
        self.trusted = self.settled_samples >= SETTLING_SAMPLES && self.attitude.knows_up();
        // What was cut off no longer averages out: the speed would never come back.
        let accel_mps2 = (!imu.saturated).then_some(imu.accel_mps2);
        Some(AccelSample { accel_mps2, dt_s })
    }

    fn take_mag(&mut self, mag: &MagState) {
        let is_used = self.field == Field::ShowsNorth && mag.ts_us > self.deaf_until_us;
        if is_used && self.settled_samples > 0 && vector::is_within(mag.mag_ut, MAX_FIELD_UT) {
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
        sample: Option<AccelSample>,
        motor: &MotorFeedback,
        passed_us: u32,
        now_us: u64,
        estimate: &mut StateEstimate,
    ) {
        let imu_age_us = age_us(self.imu_ts_us, now_us);
        let ahead_s = seconds(imu_age_us.min(MAX_IMU_AGE_US));
        let orientation = self.attitude.orientation(ahead_s);
        if let Some(sample) = sample {
            let pose = BodyPose {
                orientation,
                rate_rps: self.attitude.rate_rps(),
            };
            self.motion.feed(&sample, ahead_s, &pose, motor);
        }
        if imu_age_us > MAX_IMU_AGE_US {
            self.motion.fade(seconds(passed_us));
        }
        estimate.q_wxyz = orientation.to_wxyz();
        estimate.rpy_rad = orientation.roll_pitch_yaw();
        (estimate.vel_mps, estimate.pos_m) = self.motion.after(ahead_s);
        estimate.gyro_bias_rps = self.attitude.bias_rps();
        estimate.accel_bias_mps2 = self.motion.accel_bias_mps2();
        estimate.ts_us = now_us;
        estimate.valid = imu_age_us <= MAX_IMU_AGE_US && self.trusted;
    }
}

fn is_measurement(imu: &ImuState) -> bool {
    vector::is_within(imu.gyro_dps, MAX_RATE_DPS)
        && vector::is_within(imu.gyro_bias_dps, MAX_RATE_DPS)
        && vector::is_within(imu.accel_mps2, MAX_ACCEL_MPS2)
}

fn seconds(us: u32) -> f32 {
    us as f32 * 1e-6
}
