//! Moves the body in steps of 0.25 ms and measures it.

use std::collections::VecDeque;

use robot_app::domain::{ImuState, MagState};
use robot_test_support::{Random, Rotation, Vector, add, dot, scale};

use crate::{
    motion::{GRAVITY_MPS2, Motion},
    sensors::{Sensors, Timing},
};

const STEP_US: u64 = 250;
const IMU_US: u64 = 5_000;
const MAG_US: u64 = 20_000;
/// Time from the middle of the magnetometer's measurement to its reading.
const MAG_READ_US: u64 = 4_000;
/// Largest jitter of a sample, in steps of the motion.
const MAX_JITTER_STEPS: f64 = 8.0;

struct Due<T> {
    at_us: u64,
    sample: T,
}

pub struct World {
    motion: Motion,
    sensors: Sensors,
    noise: Random,
    elapsed_us: u64,
    attitude: Rotation,
    angle_rad: Vector,
    velocity_mps: Vector,
    interval_start_us: u64,
    interval_end_us: u64,
    imu_number: u64,
    imu_due: VecDeque<Due<ImuState>>,
    mag_due: VecDeque<Due<MagState>>,
}

impl World {
    pub fn new(motion: Motion, sensors: Sensors) -> Self {
        Self {
            attitude: motion.start,
            noise: Random::new(sensors.seed),
            motion,
            sensors,
            elapsed_us: 0,
            angle_rad: [0.0; 3],
            velocity_mps: [0.0; 3],
            interval_start_us: 0,
            interval_end_us: IMU_US,
            imu_number: 0,
            imu_due: VecDeque::new(),
            mag_due: VecDeque::new(),
        }
    }

    pub fn attitude(&self) -> Rotation {
        self.attitude
    }

    /// The bias that is left in the samples.
    pub fn gyro_offset_dps(&self) -> Vector {
        let t = self.time_s();
        let taken_out = (self.sensors.removed_bias_dps)(t);
        add((self.sensors.gyro_offset_dps)(t), scale(taken_out, -1.0))
    }

    pub fn wheels_mps(&self) -> Option<[f64; 2]> {
        let wheels = self.motion.wheels_mps.as_ref()?;
        Some(wheels(self.time_s()))
    }

    /// The robot's clock `elapsed_us` after the start.
    pub fn clock_us(&self, elapsed_us: u64) -> u64 {
        self.sensors.start_us + elapsed_us
    }

    pub fn imu_due(&mut self, elapsed_us: u64) -> Option<ImuState> {
        take_due(&mut self.imu_due, elapsed_us)
    }

    pub fn mag_due(&mut self, elapsed_us: u64) -> Option<MagState> {
        take_due(&mut self.mag_due, elapsed_us)
    }

    pub fn advance_to(&mut self, elapsed_us: u64) {
        while self.elapsed_us < elapsed_us {
            self.move_on();
            if self.elapsed_us == self.interval_end_us {
                self.measure_imu();
            }
            if (self.elapsed_us + MAG_READ_US).is_multiple_of(MAG_US) {
                self.measure_mag();
            }
        }
    }

    fn time_s(&self) -> f64 {
        self.elapsed_us as f64 * 1e-6
    }

    /// Half the rotation, the acceleration, half the rotation: each quantity is that of the middle of the step.
    fn move_on(&mut self) {
        let dt_s = STEP_US as f64 * 1e-6;
        let middle_s = self.time_s() + dt_s / 2.0;
        let turn = scale((self.motion.rate_rps)(middle_s), dt_s);
        let half = Rotation::by(scale(turn, 0.5));
        let middle = self.attitude.then_in_body(half);
        let force = add((self.motion.accel_mps2)(middle_s), [0.0, 0.0, GRAVITY_MPS2]);
        let force = middle.inverse().turn(force);
        self.attitude = middle.then_in_body(half);
        self.angle_rad = add(self.angle_rad, turn);
        self.velocity_mps = add(self.velocity_mps, scale(force, dt_s));
        self.elapsed_us += STEP_US;
    }

    fn measure_imu(&mut self) {
        let interval_s = (self.interval_end_us - self.interval_start_us) as f64 * 1e-6;
        let rate_dps = self
            .angle_rad
            .map(|angle| (angle / interval_s).to_degrees());
        let accel_mps2 = scale(self.velocity_mps, 1.0 / interval_s);
        self.angle_rad = [0.0; 3];
        self.velocity_mps = [0.0; 3];
        let sample = self.imu_sample(rate_dps, accel_mps2);
        if !(self.sensors.loses)(self.imu_number) {
            let at_us = match self.sensors.timing {
                Timing::Late => self.elapsed_us + 1_000 * (1 + self.noise.below(9) as u64),
                Timing::WrongStamps => {
                    sample.ts_us.max(self.clock_us(self.elapsed_us)) - self.sensors.start_us
                }
                Timing::Exact | Timing::Jitter => self.elapsed_us,
            };
            self.imu_due.push_back(Due { at_us, sample });
        }
        self.imu_number += 1;
        self.interval_start_us = self.interval_end_us;
        let nominal_us = (self.imu_number + 1) * IMU_US;
        self.interval_end_us = match self.sensors.timing {
            Timing::Jitter => nominal_us.saturating_add_signed(self.jitter_us()),
            _ => nominal_us,
        };
    }

    fn imu_sample(&mut self, rate_dps: Vector, accel_mps2: Vector) -> ImuState {
        let level = self.sensors.noise;
        let gyro = self.sensors.gyro_matrix.map(|row| dot(row, rate_dps));
        let gyro = add(gyro, self.gyro_offset_dps());
        let gyro = add(gyro, self.noise_of(level.gyro_dps));
        let accel = add(accel_mps2, self.noise_of(level.accel_mps2));
        let (gyro_end, accel_end) = (self.sensors.gyro_range_dps, self.sensors.accel_range_mps2);
        let stamp_error_us = match self.sensors.timing {
            Timing::WrongStamps => self.jitter_us(),
            _ => 0,
        };
        ImuState {
            gyro_dps: gyro.map(|rate| rate.clamp(-gyro_end, gyro_end) as f32),
            accel_mps2: accel.map(|part| part.clamp(-accel_end, accel_end) as f32),
            saturated: gyro.iter().any(|rate| rate.abs() > gyro_end)
                || accel.iter().any(|part| part.abs() > accel_end),
            gyro_clipped_ms: gyro.map(|rate| if rate.abs() > gyro_end { 5 } else { 0 }),
            gyro_bias_dps: (self.sensors.removed_bias_dps)(self.time_s()).map(|part| part as f32),
            ts_us: self
                .clock_us(self.elapsed_us)
                .saturating_add_signed(stamp_error_us),
            ..ImuState::default()
        }
    }

    fn measure_mag(&mut self) {
        if !(self.sensors.has_mag)(self.time_s()) {
            return;
        }
        let field = add(
            self.motion.earth_field_ut,
            (self.motion.magnet_ut)(self.time_s()),
        );
        let seen = self.attitude.inverse().turn(field);
        let seen = add(seen, self.sensors.hard_iron_ut);
        let seen = add(seen, self.noise_of(self.sensors.noise.mag_ut));
        let stamp_us = self.elapsed_us + self.sensors.unknown_mag_delay_us;
        let sample = MagState {
            mag_ut: seen.map(|part| part as f32),
            ts_us: self.clock_us(stamp_us),
        };
        let at_us = stamp_us + MAG_READ_US;
        self.mag_due.push_back(Due { at_us, sample });
    }

    fn noise_of(&mut self, std: f64) -> Vector {
        std::array::from_fn(|_| std * self.noise.normal())
    }

    fn jitter_us(&mut self) -> i64 {
        let steps = self.noise.between(-MAX_JITTER_STEPS, MAX_JITTER_STEPS);
        steps.round() as i64 * STEP_US as i64
    }
}

/// Samples are delivered in the order in which they were taken.
fn take_due<T>(queue: &mut VecDeque<Due<T>>, elapsed_us: u64) -> Option<T> {
    queue
        .pop_front_if(|due| due.at_us <= elapsed_us)
        .map(|due| due.sample)
}
