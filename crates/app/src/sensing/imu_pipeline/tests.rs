//! BMI088 answers put together by hand from the datasheet.

use super::*;

fn new_pipeline() -> ImuPipeline {
    ImuPipeline::new(ImuCalibration::default(), HeaterConfig::default())
}

/// A sample whose buffer holds `frames`. The registers show the newest of them.
fn process_frames<const N: usize>(
    pipeline: &mut ImuPipeline,
    index: u32,
    frames: [[i16; 3]; N],
) -> Result<ImuState, ImuSampleError> {
    let (accel, mut gyro) = answers(index);
    let frames = frames.map(|frame| frame.map(i16::to_le_bytes));
    let bytes = frames.as_flattened().as_flattened();
    gyro[3..9].copy_from_slice(&bytes[bytes.len() - 6..]);
    gyro[15] = N as u8;
    pipeline.process(&accel, &gyro, bytes, u64::from(index) * 5_000)
}

/// Answers of a level BMI088 at rest with an overrun gyro buffer, by the datasheet: 1 g is 2730 counts at ±12 g, and
/// the temperature bytes 0x10 0x20 are 39.125 °C.
fn answers(index: u32) -> ([u8; 20], [u8; 16]) {
    let mut accel = [0; 20];
    let ripple = (index % 3) as u8;
    accel[2] = ripple;
    accel[6..8].copy_from_slice(&2_730i16.to_le_bytes());
    accel[8..11].copy_from_slice(&(index * 128).to_le_bytes()[..3]);
    accel[18..20].copy_from_slice(&[0x10, 0x20]);
    let mut gyro = [0; 16];
    gyro[1] = 0x0F;
    gyro[15] = 0x85;
    gyro[7..9].copy_from_slice(&164i16.to_le_bytes());
    (accel, gyro)
}

#[test]
fn counts_become_physical_units() {
    let mut pipeline = new_pipeline();
    let (accel, gyro) = answers(3);
    let state = pipeline.process(&accel, &gyro, &[], 5_000).unwrap();
    assert!((state.accel_mps2[2] - 9.806_65).abs() < 0.01);
    assert!((state.gyro_dps[2] - 10.01).abs() < 0.01);
    assert_eq!(state.temperature_c, 39.125);
    // The low-pass takes 1.94 ms, the reading 0.5 ms.
    assert_eq!(state.ts_us, 5_000 - 2_440);
}

/// By hand: (9.806 − 0.306) · 2 = 19 m/s². Until the bias is measured, the stored one is used: (10.01 − 1.01) · 0.5.
#[test]
fn stored_offsets_and_scales_are_applied() {
    let mut pipeline = new_pipeline();
    let calibration = ImuCalibration {
        accel_bias_mps2: [0.0, 0.0, 0.306],
        accel_scale: [1.0, 1.0, 2.0],
        gyro_bias_dps: [0.0, 0.0, 1.01],
        gyro_scale: [1.0, 1.0, 0.5],
    };
    pipeline.set_config(&calibration, &HeaterConfig::default());
    let (accel, gyro) = answers(3);
    let state = pipeline.process(&accel, &gyro, &[], 5_000).unwrap();
    assert!((state.accel_mps2[2] - 19.0).abs() < 0.01);
    assert!((state.gyro_dps[2] - 4.5).abs() < 0.01);
    assert_eq!(state.gyro_bias_dps[2], 1.01);
}

/// The sensor's z axis points forward, so its 10.01 °/s and 1 g are about and along the robot's x axis.
#[test]
fn samples_are_rotated_before_they_are_calibrated() {
    let mut pipeline = new_pipeline();
    pipeline.set_mounting(Orientation::XRightZForward);
    let calibration = ImuCalibration {
        accel_bias_mps2: [0.5, 0.0, 0.0],
        gyro_scale: [0.5, 1.0, 1.0],
        ..ImuCalibration::default()
    };
    pipeline.set_config(&calibration, &HeaterConfig::default());
    let (accel, gyro) = answers(3);
    let state = pipeline.process(&accel, &gyro, &[], 5_000).unwrap();
    let [forward, left, up] = state.accel_mps2;
    assert!((forward - 9.306_65).abs() < 0.01 && left.abs() + up.abs() < 0.01);
    let [forward, left, up] = state.gyro_dps;
    assert!((forward - 5.005).abs() < 0.01 && left.abs() + up.abs() < 0.01);
    // The times of saturation are rotated too: the sensor's x axis points to the right.
    let rates = [20_000, i16::MAX, i16::MAX, i16::MAX].map(|x| [x, 0, 0]);
    let state = process_frames(&mut pipeline, 2, rates).unwrap();
    assert_eq!(state.gyro_clipped_ms, [0, 4, 0]);
}

#[test]
fn another_mounting_measures_the_bias_again() {
    let mut pipeline = new_pipeline();
    let still = |pipeline: &mut ImuPipeline, samples: std::ops::Range<u32>| {
        for index in samples {
            let (accel, mut gyro) = answers(index);
            gyro[7..9].copy_from_slice(&(16 + (index % 2) as i16).to_le_bytes());
            let read_us = u64::from(index) * 5_000;
            pipeline.process(&accel, &gyro, &[], read_us).unwrap();
        }
    };
    still(&mut pipeline, 1..211);
    pipeline.set_mounting(Orientation::default());
    assert!(pipeline.calibrated());
    pipeline.set_mounting(Orientation::XUpZLeft);
    still(&mut pipeline, 211..212);
    assert!(!pipeline.calibrated());
    still(&mut pipeline, 212..422);
    assert!(pipeline.calibrated());
}

#[test]
fn a_still_second_removes_the_bias() {
    let mut pipeline = new_pipeline();
    let mut last = ImuState::default();
    for index in 1..=210u32 {
        let (accel, mut gyro) = answers(index);
        gyro[7..9].copy_from_slice(&(16 + (index % 2) as i16).to_le_bytes());
        last = pipeline
            .process(&accel, &gyro, &[], u64::from(index) * 5_000)
            .unwrap();
    }
    assert!(pipeline.calibrated());
    assert!((last.gyro_bias_dps[2] - 16.5 / 16.384).abs() < 0.01);
    assert!(last.gyro_dps[2].abs() < 0.05);
}

#[test]
fn an_absent_sensor_is_reported() {
    let mut pipeline = new_pipeline();
    let (accel, gyro) = answers(1);
    let mut process = |accel: &[u8; 20], gyro: &[u8; 16]| pipeline.process(accel, gyro, &[], 5_000);
    assert_eq!(
        process(&[0xFF; 20], &gyro),
        Err(ImuSampleError::AccelAbsent)
    );
    assert_eq!(
        process(&[0x00; 20], &gyro),
        Err(ImuSampleError::AccelAbsent)
    );
    assert_eq!(
        process(&accel, &[0xFF; 16]),
        Err(ImuSampleError::GyroAbsent)
    );
    assert_eq!(
        process(&accel, &[0x00; 16]),
        Err(ImuSampleError::GyroAbsent)
    );
}

#[test]
fn a_frozen_sensor_is_detected() {
    let mut pipeline = new_pipeline();
    let (accel, gyro) = answers(1);
    assert!(pipeline.process(&accel, &gyro, &[], 5_000).is_ok());
    let stopped_clock = pipeline.process(&accel, &gyro, &[], 10_000);
    assert_eq!(stopped_clock, Err(ImuSampleError::Frozen));

    let mut pipeline = new_pipeline();
    let (accel, mut gyro) = answers(1);
    gyro[15] = 0;
    let no_frames = pipeline.process(&accel, &gyro, &[], 5_000);
    assert_eq!(no_frames, Err(ImuSampleError::Frozen));

    let mut pipeline = new_pipeline();
    let results: Vec<bool> = (1..=20u32)
        .map(|index| {
            let (mut accel, gyro) = answers(index);
            accel[2] = 7;
            let ts_us = u64::from(index) * 5_000;
            pipeline.process(&accel, &gyro, &[], ts_us).is_ok()
        })
        .collect();
    assert!(results[..8].iter().all(|good| *good));
    assert!(!results[19]);
}

/// By hand from the datasheet: 0x00 0x00 is 23 °C, 17 K below the target. 0x80 0x00 is invalid.
#[test]
fn the_heater_follows_the_temperature_and_stops_without() {
    let mut pipeline = new_pipeline();
    let mut duty_after = |index: u32, temperature: [u8; 2], present: bool| {
        let (mut accel, gyro) = answers(index);
        accel[18..20].copy_from_slice(&temperature);
        if !present {
            accel = [0xFF; 20];
        }
        let _ = pipeline.process(&accel, &gyro, &[], u64::from(index) * 5_000);
        pipeline.heater_duty()
    };
    assert_eq!(duty_after(1, [0, 0], true), 1.0);
    assert_eq!(duty_after(2, [0x80, 0], true), 0.0);
    assert_eq!(duty_after(3, [0, 0], true), 1.0);
    assert_eq!(duty_after(4, [0, 0], false), 0.0);
    assert_eq!(duty_after(5, [0, 0], true), 1.0);
    pipeline.process_silence(30_000);
    assert_eq!(pipeline.heater_duty(), 0.0);
    assert_eq!(pipeline.status().rejects.absent, 1);
}

#[test]
fn a_cold_package_is_not_calibrated() {
    let mut pipeline = new_pipeline();
    for index in 1..=600u32 {
        let (mut accel, mut gyro) = answers(index);
        accel[18..20].copy_from_slice(&[0, 0]);
        gyro[7..9].copy_from_slice(&(16 + (index % 2) as i16).to_le_bytes());
        let ts_us = u64::from(index) * 5_000;
        pipeline.process(&accel, &gyro, &[], ts_us).unwrap();
    }
    assert!(!pipeline.calibrated());
    let calibration = pipeline.status().calibration;
    assert_eq!(calibration.state, CalibrationState::WaitingForTemperature);
}

#[test]
fn saturation_is_marked_and_implausible_samples_rejected() {
    let mut pipeline = new_pipeline();
    let (accel, gyro) = answers(1);
    assert!(
        !pipeline
            .process(&accel, &gyro, &[], 5_000)
            .unwrap()
            .saturated
    );
    let (mut accel, gyro) = answers(2);
    accel[6..8].copy_from_slice(&i16::MAX.to_le_bytes());
    assert!(
        pipeline
            .process(&accel, &gyro, &[], 10_000)
            .unwrap()
            .saturated
    );
    // Two frames: the first jumps, and the second confirms it.
    let jumped = process_frames(&mut pipeline, 3, [[i16::MIN, 0, 164]; 2]);
    assert_eq!(jumped, Err(ImuSampleError::Implausible));
    assert_eq!(pipeline.status().rejects.implausible, 1);
}

#[test]
fn an_outlier_is_counted_and_its_sample_used() {
    let mut pipeline = new_pipeline();
    let (good, wrong) = ([0, 0, 164], [i16::MIN, 0, 164]);
    let state = process_frames(&mut pipeline, 1, [good, good, wrong, good, good]).unwrap();
    assert!((state.gyro_dps[2] - 10.01).abs() < 0.01 && !state.saturated);
    assert!(state.gyro_dps[0].abs() < 0.01);
    assert_eq!(pipeline.status().rejects.gyro_frames, 1);
}

/// By hand: 1000 °/s in one frame of two, then two frames at the end of the range.
#[test]
fn an_impact_is_averaged_and_its_saturation_reported() {
    let mut pipeline = new_pipeline();
    let mut process = |index: u32, frames: [i16; 2]| {
        process_frames(&mut pipeline, index, frames.map(|y| [0, y, 164]))
    };
    let rising = process(1, [0, 16_384]).unwrap();
    let beyond = process(2, [i16::MAX; 2]).unwrap();
    assert!(!rising.saturated && beyond.saturated);
    assert_eq!(beyond.gyro_clipped_ms, [0, 5, 0]);
    // The rotation that was held back after the jump is added later: 500 and 2000 °/s in the mean.
    let sum = rising.gyro_dps[1] + beyond.gyro_dps[1];
    assert!((sum - 2_500.0).abs() < 0.1, "{sum}");
}
