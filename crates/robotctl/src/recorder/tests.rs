use std::time::Duration;

use nalgebra::Vector3;
use robot_app::{
    domain::BusId,
    tuning::{RecordedSample, RecordedSensor, TuningGate, TuningPort},
};

use super::*;
use crate::{
    recording::{self, Sensor},
    tuning::testing::{Bus, robot},
};

const QUICK: RecordTimeouts = RecordTimeouts {
    look: Duration::ZERO,
    silence: Duration::from_secs(60),
};

fn sample(sensor: RecordedSensor, time: u16, x: f32) -> RecordedSample {
    RecordedSample {
        sensor,
        value: [x, 0.0, 0.0],
        time,
    }
}

/// The 16-bit times 65,500, 14 and 64 are 0, 5 and 10 ms. The magnetometer's sample for 2 ms comes late.
#[test]
fn rows_are_sorted_by_time() {
    let mut samples = Samples::default();
    samples.extend(&[
        sample(RecordedSensor::Accel, 65_500, 1.0),
        sample(RecordedSensor::Gyro, 65_500, 10.0),
        sample(RecordedSensor::Accel, 14, 2.0),
        sample(RecordedSensor::Mag, 65_520, 30.0),
        sample(RecordedSensor::Accel, 64, 3.0),
        sample(RecordedSensor::Gyro, 64, 12.0),
    ]);
    assert_eq!(samples.counts(), (3, 1));
    assert_eq!(
        (samples.duration_s(), samples.longest_gap_s()),
        (0.01, 0.005)
    );
    let table = samples.table();
    let rows: Vec<&str> = table.lines().skip(3).collect();
    assert_eq!(
        rows,
        [
            "0.0000,1.0000,0.0000,0.0000,10.0000,0.0000,0.0000,,,",
            "0.0020,,,,,,,30.00,0.00,0.00",
            "0.0050,2.0000,0.0000,0.0000,,,,,,",
            "0.0100,3.0000,0.0000,0.0000,12.0000,0.0000,0.0000,,,",
        ]
    );
}

/// Makes the robot send `each_look` of its 200 samples per second between two requests. Every `lose`th does not arrive.
fn send(bus: &Bus, seconds: u64, lose: usize) -> impl FnMut() {
    let bus = bus.clone();
    let mut sent = 0_usize;
    move || {
        let robot = &mut *bus.0.borrow_mut();
        for _ in 0..50 {
            let sensors = &mut robot.diagnostics.sensors;
            sensors.ts_us += 2_500;
            if sensors.ts_us.is_multiple_of(5_000) {
                sensors.imu.ts_us = sensors.ts_us;
                sensors.imu.accel_mps2 = [0.5, 0.0, 9.5];
            }
            if sensors.ts_us.is_multiple_of(20_000) {
                sensors.mag.ts_us = sensors.ts_us;
                sensors.mag.mag_ut = [20.0, 0.0, -40.0];
            }
            if sensors.ts_us > seconds * 1_000_000 {
                robot.gate = TuningGate::Shut;
            }
            let gate = robot.gate;
            for _ in 0..3 {
                let recorder = robot.channel.recorder();
                if let Some((TuningPort::Bus(BusId::Can2), frame)) =
                    recorder.next(gate, &robot.diagnostics.sensors)
                {
                    sent += 1;
                    if !sent.is_multiple_of(lose) {
                        robot.replies.push_back(frame);
                    }
                }
            }
        }
    }
}

fn recorded(seconds: u64, lose: usize) -> Result<Recorded, RecordError> {
    let (bus, mut client) = robot();
    bus.0.borrow_mut().config.imu.accel_bias_mps2[0] = 0.25;
    let mut send = send(&bus, seconds, lose);
    record(&mut client, 4, QUICK, |_| send())
}

#[test]
fn a_recording_can_be_used_for_calibration() {
    let recorded = recorded(10, usize::MAX).unwrap();
    assert_eq!(recorded.lost, 0);
    let (imu, mag) = recorded.samples.counts();
    assert!(
        (798..=800).contains(&imu) && (198..=200).contains(&mag),
        "{imu} {mag}"
    );
    let path = std::env::temp_dir().join(format!("robotctl-recorder-{}.csv", std::process::id()));
    std::fs::write(&path, recorded.samples.table()).unwrap();
    let accel = recording::load(&path, Sensor::Accelerometer).unwrap();
    let field = recording::load(&path, Sensor::Magnetometer).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert_eq!((accel.len() as u32, field.len() as u32), (imu, mag));
    // The sensor measured this. The robot had subtracted 0.25.
    assert_eq!(accel[7].value, Vector3::new(0.75, 0.0, 9.5));
    assert_eq!(field[7].value, Vector3::new(20.0, 0.0, -40.0));
}

#[test]
fn lost_samples_are_counted_and_too_many_refused() {
    let few = recorded(10, 500).unwrap();
    assert!((1..=4).contains(&few.lost), "{}", few.lost);
    let error = recorded(10, 20).unwrap_err();
    assert!(matches!(error, RecordError::Lost { .. }), "{error}");
}

#[test]
fn arming_ends_a_recording_with_an_error() {
    let error = recorded(2, usize::MAX).unwrap_err();
    assert!(matches!(error, RecordError::CutShort), "{error}");
}
