//! Arranges samples as they arrive into rows of a table.

use nalgebra::Vector3;
use robot_app::tuning::{RecordedSample, RecordedSensor};

use super::RecordError;
use crate::calibration::{accel::AccelCorrection, mag::MagCorrection};

/// Units of the robot's time on the wire per second.
const UNITS_A_SECOND: f64 = 10_000.0;

const HEADING: &str = "\
# Written by `robotctl record`: x forward, y left, z up; accelerometer and magnetometer without the robot's corrections.
# t in s, a in m/s2, g in deg/s, m in uT
t,ax,ay,az,gx,gy,gz,mx,my,mz
";

type Vector = Vector3<f64>;

#[derive(Clone, Copy, Debug, PartialEq)]
enum SensorValues {
    Imu {
        accel_mps2: Vector,
        /// `None` if its frame was lost.
        gyro_dps: Option<Vector>,
    },
    Mag(Vector),
}

/// Recorded samples in the order of their times.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    /// Rows with their times. The low 16 bits of a time are those on the wire.
    rows: Vec<(i64, SensorValues)>,
    /// Time of the sample that arrived last.
    last_time: Option<i64>,
}

impl Samples {
    pub(super) fn extend(&mut self, heard: &[RecordedSample]) {
        for sample in heard {
            self.push(sample);
        }
    }

    fn push(&mut self, sample: &RecordedSample) {
        let time = self.unwrapped(sample.time);
        let value = Vector::from_iterator(sample.value.into_iter().map(f64::from));
        let measured = match sample.sensor {
            RecordedSensor::Accel => SensorValues::Imu {
                accel_mps2: value,
                gyro_dps: None,
            },
            RecordedSensor::Mag => SensorValues::Mag(value),
            RecordedSensor::Gyro => return self.add_gyro(time, value),
        };
        // The magnetometer's time is the middle of its measurement, so it may arrive after younger samples of the IMU.
        let place = self.rows.partition_point(|(other, _)| *other <= time);
        self.rows.insert(place, (time, measured));
    }

    /// Adds the gyro's half of a sample, which follows the accelerometer's.
    fn add_gyro(&mut self, time: i64, value: Vector) {
        let of_this_time = self.rows.iter_mut().rev();
        for (_, measured) in of_this_time.take_while(|(other, _)| *other >= time) {
            if let SensorValues::Imu { gyro_dps, .. } = measured {
                *gyro_dps = Some(value);
            }
        }
    }

    /// Returns the full time of which the wire has 16 bits. It is the one nearest to the last sample's.
    fn unwrapped(&mut self, time: u16) -> i64 {
        let time = match self.last_time {
            None => time.into(),
            Some(last) => last + i64::from(time.wrapping_sub(last as u16).cast_signed()),
        };
        self.last_time = Some(time);
        time
    }

    /// Returns the number of samples of the IMU and of the magnetometer.
    pub fn counts(&self) -> (u32, u32) {
        let is_imu =
            |(_, measured): &&(i64, SensorValues)| matches!(measured, SensorValues::Imu { .. });
        let imu = self.rows.iter().filter(is_imu).count();
        (imu as u32, (self.rows.len() - imu) as u32)
    }

    pub fn duration_s(&self) -> f64 {
        let last = self.rows.last().map_or(0, |(last, _)| *last);
        self.seconds(last)
    }

    /// Returns the longest time without a sample. The robot sends nothing while it erases flash.
    pub fn longest_gap_s(&self) -> f64 {
        let gaps = self.rows.windows(2).map(|pair| pair[1].0 - pair[0].0);
        gaps.max().unwrap_or(0) as f64 / UNITS_A_SECOND
    }

    fn seconds(&self, time: i64) -> f64 {
        let first = self.rows.first().map_or(time, |(first, _)| *first);
        (time - first) as f64 / UNITS_A_SECOND
    }

    /// Restores what the sensors measured before the robot corrected it.
    pub(super) fn undo(
        &mut self,
        accel: &AccelCorrection,
        mag: &MagCorrection,
    ) -> Result<(), RecordError> {
        for (_, measured) in &mut self.rows {
            match measured {
                SensorValues::Imu { accel_mps2, .. } => *accel_mps2 = accel.undo(*accel_mps2),
                SensorValues::Mag(field_ut) => {
                    *field_ut = mag.undo(*field_ut).ok_or(RecordError::SoftIron)?;
                }
            }
        }
        Ok(())
    }

    /// Returns the table that `robotctl calibrate` and spreadsheets read. Each sample is a row, and values that it does
    /// not have are empty.
    pub fn table(&self) -> String {
        let mut table = String::from(HEADING);
        for (time, measured) in &self.rows {
            let row = match measured {
                SensorValues::Imu {
                    accel_mps2,
                    gyro_dps,
                } => {
                    let gyro = gyro_dps.map_or(",,".to_owned(), |gyro| fields(&gyro, 4));
                    format!("{},{gyro},,,", fields(accel_mps2, 4))
                }
                SensorValues::Mag(field_ut) => format!(",,,,,,{}", fields(field_ut, 2)),
            };
            table.push_str(&format!("{:.4},{row}\n", self.seconds(*time)));
        }
        table
    }
}

fn fields(vector: &Vector, digits: usize) -> String {
    let [x, y, z] = [vector.x, vector.y, vector.z];
    format!("{x:.digits$},{y:.digits$},{z:.digits$}")
}
