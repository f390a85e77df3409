use super::*;
use crate::domain::BalanceStatus;

const NAN: f32 = f32::NAN;

fn sample() -> BlackBoxSample {
    BlackBoxSample {
        time: 123_456,
        q_wxyz: [1.0, -1.0, 0.5, 0.0],
        gyro_dps: [-2_048.0, 0.0625, 1_000.0],
        accel_mps2: [-256.0, 9.8125, 0.0],
        wheel_rps: [-12.5, 30.0],
        sent_ma: [16_000.0, -20_000.0],
        measured_ma: [-1.0, 1.0],
        joint_rad: [-3.0, 0.4, 1.2, 12.5],
        joint_nm: [-21.0, 0.5, 1.0, 20.0],
        flags: SafetyFlags::TILT.union(SafetyFlags::STICKS_AWAITED),
        battery_v: 24.125,
        armed: true,
        enabled: false,
        estimate_valid: true,
        mode: DriveMode::Custom,
        source: CommandSource::BringUp,
        command_age_ms: 7,
        radio_age_ms: 255,
        late_tasks: LateTasks {
            imu: true,
            params: true,
            ..LateTasks::default()
        },
        can: [BusErrorState::Passive, BusErrorState::BusOff],
        missed_ticks: 13,
        drive: -1.0,
        turn: 1.0,
        balance: Some(BalanceSample {
            status: BalanceStatus {
                leg_m: [0.2, 0.25],
                airborne: true,
                ..BalanceStatus::default()
            },
            ..BalanceSample::default()
        }),
    }
}

#[test]
fn a_sample_survives_its_record() {
    let found = BlackBoxSample::from_record(&sample().record(7), 7).expect("whole");
    let expected = sample();
    let close = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
    assert!(close(&found.q_wxyz, &expected.q_wxyz));
    assert!(close(&found.gyro_dps, &expected.gyro_dps));
    assert!(close(&found.joint_rad, &expected.joint_rad));
    let exact = BlackBoxSample {
        q_wxyz: expected.q_wxyz,
        gyro_dps: expected.gyro_dps,
        joint_rad: expected.joint_rad,
        ..found
    };
    assert_eq!(exact, expected);
    assert_eq!(BlackBoxSample::from_record(&sample().record(7), 8), None);
}

/// Layout 1 ended with the checksum where layout 2 goes on.
#[test]
fn a_record_of_layout_1_is_read() {
    let mut first = [0; FIRST_RECORD_WORDS];
    first.copy_from_slice(&sample().record(7)[..FIRST_RECORD_WORDS]);
    assert_eq!(BlackBoxSample::from_first_record(&first, 7), None);
    first[15] = 7;
    first[15] = checksum_of_words(&first);
    let found = BlackBoxSample::from_first_record(&first, 7).expect("whole");
    let with = BlackBoxSample::from_record(&sample().record(7), 7).expect("whole");
    let without = BlackBoxSample {
        balance: None,
        ..with
    };
    assert_eq!(found, without);
    assert_eq!(BlackBoxSample::from_first_record(&first, 8), None);
}

#[test]
fn one_wrong_bit_anywhere_is_noticed() {
    let record = sample().record(7);
    for bit in 0..RECORD_WORDS * 32 {
        let mut damaged = record;
        damaged[bit / 32] ^= 1 << (bit % 32);
        assert_eq!(BlackBoxSample::from_record(&damaged, 7), None, "{bit}");
    }
}

#[test]
fn values_beyond_the_range_become_its_ends() {
    let wild = BlackBoxSample {
        gyro_dps: [1e9, -1e9, NAN],
        joint_nm: [f32::INFINITY, f32::NEG_INFINITY, NAN, 0.0],
        battery_v: -3.0,
        ..sample()
    };
    let found = BlackBoxSample::from_record(&wild.record(1), 1).expect("whole");
    assert_eq!(found.gyro_dps, [32_767.0 / 16.0, -2_048.0, 0.0]);
    assert_eq!(found.joint_nm, [127.0 / 6.0, -128.0 / 6.0, 0.0, 0.0]);
    assert_eq!(found.battery_v, 0.0);
}
