//! Records sensor samples: each sample is sent in a frame of its own for a given time while the robot is disarmed.
//!
//! A sample's frame holds x, y and z in steps as `i16`, and the low 16 bits of its time in units of 100 µs as `u16`,
//! all little-endian. Frames are sent in ticks without a reply, one a tick. On a bus they take the mailbox that motors
//! leave free.

use super::{
    TuningGate, TuningPort,
    identifiers::{ACCEL_ID, GYRO_ID, MAG_ID},
};
use crate::domain::{CanFrame, SensorsSnapshot, StandardId};

/// Longest recording in s.
pub const MAX_RECORDING_S: u16 = 600;

/// Source of a recorded sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedSensor {
    /// Accelerometer, in m/s².
    Accel,
    /// Gyro, in °/s.
    Gyro,
    /// Magnetometer, in µT.
    Mag,
}

impl RecordedSensor {
    const ALL: [Self; 3] = [Self::Accel, Self::Gyro, Self::Mag];

    /// Identifier of the sensor's frames.
    pub const fn frame_id(self) -> StandardId {
        match self {
            Self::Accel => ACCEL_ID,
            Self::Gyro => GYRO_ID,
            Self::Mag => MAG_ID,
        }
    }

    /// Steps per unit: about the resolution of the sensor, with room for its whole range.
    const fn steps(self) -> f32 {
        match self {
            Self::Accel => 256.0,
            Self::Gyro => 16.0,
            Self::Mag => 10.0,
        }
    }

    fn frame(self, vector: [f32; 3], ts_us: u64) -> CanFrame {
        let [[a, b], [c, d], [e, f]] = vector.map(|value| {
            let steps = value * self.steps();
            let half = if steps < 0.0 { -0.5 } else { 0.5 };
            // The conversion saturates.
            ((steps + half) as i16).to_le_bytes()
        });
        let [g, h] = ((ts_us / 100) as u16).to_le_bytes();
        CanFrame::new(self.frame_id(), [a, b, c, d, e, f, g, h])
    }
}

/// A sample as received by the PC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedSample {
    /// Source of the sample.
    pub sensor: RecordedSensor,
    /// Value in the sensor's unit, as in diagnostics.
    pub value: [f32; 3],
    /// Time in units of 100 µs; it wraps.
    pub time: u16,
}

impl RecordedSample {
    /// Decodes a sample. Returns `None` for any other frame.
    pub fn decode(frame: &CanFrame) -> Option<Self> {
        let mut sensors = RecordedSensor::ALL.into_iter();
        let sensor = sensors.find(|sensor| sensor.frame_id() == frame.id())?;
        let [a, b, c, d, e, f, g, h] = frame.full_payload()?;
        let value = [[a, b], [c, d], [e, f]]
            .map(|bytes| f32::from(i16::from_le_bytes(bytes)) / sensor.steps());
        let time = u16::from_le_bytes([g, h]);
        Some(Self {
            sensor,
            value,
            time,
        })
    }
}

/// State of the present or the last recording. The numbers are on the wire and never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum RecordingState {
    /// No recording since boot, or the last one ended regularly.
    #[default]
    Ended = 0,
    /// A recording is running.
    Running = 1,
    /// The recording ended early because the robot was armed or the enable switch went on.
    CutShort = 2,
}

/// State of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RecordingStatus {
    /// Whether it is running.
    pub state: RecordingState,
    /// Number of IMU samples sent, each with a frame of the accelerometer and one of the gyro.
    pub imu: u32,
    /// Number of magnetometer samples sent.
    pub mag: u32,
}

#[derive(Clone, Copy, Debug)]
struct Running {
    port: TuningPort,
    until_us: u64,
    /// Times of the last samples sent.
    imu_ts_us: u64,
    mag_ts_us: u64,
    /// The gyro's part of an IMU sample, for the next tick.
    gyro: Option<CanFrame>,
}

/// Records sensor samples after it has been started.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    running: Option<Running>,
    status: RecordingStatus,
}

impl Recorder {
    /// Starts a recording and ends any other; 0 s only ends the other one.
    pub fn start(&mut self, port: TuningPort, seconds: u16, sensors: &SensorsSnapshot) {
        let duration_us = u64::from(seconds).saturating_mul(1_000_000);
        self.running = (seconds != 0).then(|| Running {
            port,
            until_us: sensors.ts_us.saturating_add(duration_us),
            imu_ts_us: sensors.imu.ts_us,
            mag_ts_us: sensors.mag.ts_us,
            gyro: None,
        });
        self.status = RecordingStatus {
            state: match self.running {
                Some(_) => RecordingState::Running,
                None => RecordingState::Ended,
            },
            ..RecordingStatus::default()
        };
    }

    /// Whether a recording is running.
    pub const fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// State of the recording.
    pub const fn status(&self) -> &RecordingStatus {
        &self.status
    }

    /// Returns the next frame. Called in each tick without a reply while a recording is running.
    #[cold]
    #[inline(never)]
    pub fn next(
        &mut self,
        gate: TuningGate,
        sensors: &SensorsSnapshot,
    ) -> Option<(TuningPort, CanFrame)> {
        let running = self.running.as_mut()?;
        if gate == TuningGate::Shut {
            self.end(RecordingState::CutShort);
            return None;
        }
        if sensors.ts_us >= running.until_us {
            self.end(RecordingState::Ended);
            return None;
        }
        let frame = if let Some(gyro) = running.gyro.take() {
            gyro
        } else if sensors.imu.ts_us != running.imu_ts_us {
            let ts_us = sensors.imu.ts_us;
            running.imu_ts_us = ts_us;
            running.gyro = Some(RecordedSensor::Gyro.frame(sensors.imu.gyro_dps, ts_us));
            self.status.imu = self.status.imu.wrapping_add(1);
            RecordedSensor::Accel.frame(sensors.imu.accel_mps2, ts_us)
        } else if sensors.mag.ts_us != running.mag_ts_us {
            running.mag_ts_us = sensors.mag.ts_us;
            self.status.mag = self.status.mag.wrapping_add(1);
            RecordedSensor::Mag.frame(sensors.mag.mag_ut, sensors.mag.ts_us)
        } else {
            return None;
        };
        Some((running.port, frame))
    }

    fn end(&mut self, state: RecordingState) {
        self.running = None;
        self.status.state = state;
    }
}

impl RecordingState {
    const ALL: [Self; 3] = [Self::Ended, Self::Running, Self::CutShort];

    /// Decodes a state. Returns `None` for an unknown number.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|state| *state as u8 == code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A recorder started 1 s after boot, with sensors just sampled.
    fn start(seconds: u16) -> (Recorder, SensorsSnapshot) {
        let mut sensors = SensorsSnapshot {
            ts_us: 1_000_000,
            ..SensorsSnapshot::default()
        };
        sensors.imu.ts_us = 999_000;
        sensors.mag.ts_us = 998_000;
        let mut recorder = Recorder::default();
        recorder.start(TuningPort::Link, seconds, &sensors);
        (recorder, sensors)
    }

    fn payload(sent: Option<(TuningPort, CanFrame)>) -> (u16, [u8; 8]) {
        let (port, frame) = sent.expect("a frame");
        assert_eq!(port, TuningPort::Link);
        (frame.id().raw(), frame.full_payload().unwrap())
    }

    /// 9.8125 m/s² = 2512 = 0x09D0, −1 = −256 = 0xFF00; −2.5 °/s = −40 = 0xFFD8; 48.1 µT = 481 = 0x01E1. Times:
    /// 1.0041 s = 10,041 = 0x2739, 1.0032 s = 10,032 = 0x2730.
    #[test]
    fn each_sample_is_sent_once_with_its_time() {
        let (mut recorder, mut sensors) = start(1);
        assert_eq!(recorder.next(TuningGate::Open, &sensors), None);
        let imu = &mut sensors.imu;
        imu.accel_mps2 = [-1.0, 0.0, 9.8125];
        imu.gyro_dps = [0.0, 0.0, -2.5];
        imu.ts_us = 1_004_199;
        sensors.mag.mag_ut = [48.1, 0.0, 1e9];
        sensors.mag.ts_us = 1_003_200;
        let mut next = || recorder.next(TuningGate::Open, &sensors);
        let accel = [0x00, 0xFF, 0, 0, 0xD0, 0x09, 0x39, 0x27];
        assert_eq!(payload(next()), (0x7A3, accel));
        assert_eq!(
            payload(next()),
            (0x7A4, [0, 0, 0, 0, 0xD8, 0xFF, 0x39, 0x27])
        );
        let mag = [0xE1, 0x01, 0, 0, 0xFF, 0x7F, 0x30, 0x27];
        assert_eq!(payload(next()), (0x7A5, mag));
        assert_eq!(next(), None);
        let status = *recorder.status();
        assert_eq!((status.imu, status.mag), (1, 1));
        let frame = CanFrame::new(StandardId::new(0x7A3).unwrap(), accel);
        let sample = RecordedSample {
            sensor: RecordedSensor::Accel,
            value: [-1.0, 0.0, 9.8125],
            time: 10_041,
        };
        assert_eq!(RecordedSample::decode(&frame), Some(sample));
        let other = CanFrame::new(StandardId::new(0x7A2).unwrap(), accel);
        assert_eq!(RecordedSample::decode(&other), None);
    }

    #[test]
    fn a_recording_ends_at_its_time_or_when_the_gate_shuts() {
        for (gate, at_us, state) in [
            (TuningGate::Open, 1_999_999, RecordingState::Running),
            (TuningGate::Open, 2_000_000, RecordingState::Ended),
            (TuningGate::Shut, 1_500_000, RecordingState::CutShort),
        ] {
            let (mut recorder, mut sensors) = start(1);
            sensors.ts_us = at_us;
            sensors.imu.ts_us = at_us;
            let sent = recorder.next(gate, &sensors);
            assert_eq!(sent.is_some(), state == RecordingState::Running);
            assert_eq!(recorder.is_running(), sent.is_some());
            assert_eq!(recorder.status().state, state);
        }
        assert!(!start(0).0.is_running());
    }
}
