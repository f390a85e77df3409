use super::*;
use crate::domain::{OperatorState, RemoteState};

/// All channels at their centre.
fn remote() -> RemoteUpdate {
    RemoteUpdate {
        raw: [992; 16],
        ..RemoteUpdate::default()
    }
}

fn uplink(telemetry: &Telemetry, remote: &RemoteUpdate) -> Uplink {
    let observation = Observation {
        telemetry,
        remote,
        wheel_odom: &WheelOdomConfig::default(),
        battery_v: 24.0,
        mcu_c: 41.4,
    };
    observation.uplink()
}

fn keys(remote: &RemoteUpdate) -> Keys {
    uplink(&Telemetry::default(), remote).keys
}

#[test]
fn units_and_orders_are_those_of_the_frame() {
    let telemetry = Telemetry {
        ts_us: 12_500_000,
        accel_mps2: [1.0, 2.0, 9.8],
        gyro_dps: [180.0, -90.0, 0.0],
        q_wxyz: [0.8, 0.1, 0.2, 0.3],
        joint_rad: [0.1, 0.2, 0.3, 0.4],
        joint_rps: [1.0, 2.0, 3.0, 4.0],
        ..Telemetry::default()
    };
    let state = uplink(&telemetry, &remote());
    assert_eq!(state.time_s, 12.5);
    assert_eq!((state.battery_v, state.mcu_c), (24.0, 41));
    assert_eq!(state.accel_mps2, [1.0, 2.0, 9.8]);
    assert_eq!(state.gyro_rps, [TAU / 2.0, -TAU / 4.0, 0.0]);
    assert_eq!(state.q_xyzw, [0.1, 0.2, 0.3, 0.8]);
    for (index, motor) in state.motors[2..].iter().enumerate() {
        let number = (index + 1) as f32;
        assert_eq!((motor.pos_rad, motor.vel_rps), (number / 10.0, number));
    }
}

#[test]
fn temperatures_are_rounded_and_limited() {
    for (celsius, expected) in [
        (41.4, 41),
        (41.6, 42),
        (-10.6, -11),
        (200.0, 127),
        (-200.0, -128),
        (f32::NAN, 0),
    ] {
        assert_eq!(rounded(celsius), expected, "{celsius}");
    }
}

/// The right rotor turns backward when the robot drives forward. 1,000 rotor turns a minute are 52.07 of the wheel.
#[test]
fn a_wheel_rolls_forward_with_positive_angle_and_speed() {
    let telemetry = Telemetry {
        wheel_counts: [8_192, -8_192],
        wheel_rpm: [1_000, -1_000],
        ..Telemetry::default()
    };
    let state = uplink(&telemetry, &remote());
    for motor in &state.motors[..2] {
        assert!((motor.pos_rad - 187.0 / 3_591.0 * TAU).abs() < 1e-6);
        assert!((motor.vel_rps - 5.453_2).abs() < 1e-3, "{motor:?}");
    }
}

/// In integers: `counts` · 187 of 8192 · 3591 to a turn. The ratio as a float is off by 1e-9 of itself.
#[test]
fn the_angle_of_a_wheel_wraps_and_stays_exact() {
    const TURN: i64 = 8_192 * 3_591;
    let gear_ratio = WheelOdomConfig::default().gear_ratio;
    for step in -500..=500_i64 {
        // Up to some 48,000 turns of the wheel.
        let counts = step * 15_485_863;
        let within = (counts * 187).rem_euclid(TURN);
        let exact = within as f64 / TURN as f64 * std::f64::consts::TAU;
        let error = f64::from(wheel_angle(counts, gear_ratio)) - exact;
        let turns = counts as f64 / 157_312.0;
        let allowed = 1e-6 + turns.abs() * std::f64::consts::TAU * ratio_error(gear_ratio);
        let off = error.rem_euclid(std::f64::consts::TAU);
        let off = off.min(std::f64::consts::TAU - off);
        assert!(off < allowed, "{counts}: {off}");
        assert!(wheel_angle(counts, gear_ratio).abs() <= core::f32::consts::PI);
    }
}

fn ratio_error(gear_ratio: f32) -> f64 {
    (f64::from(gear_ratio) / (3_591.0 / 187.0) - 1.0).abs() * 1.1
}

/// 32 is a power of two, so that counts and turns have no error at all.
#[test]
fn a_day_of_driving_costs_no_accuracy() {
    let turn = 32 * 8_192;
    for turns in [0, 1, -1, 4_000_000, -4_000_000] {
        for (counts, expected) in [
            (0, 0.0),
            (turn / 4, TAU / 4.0),
            (-turn / 4, -TAU / 4.0),
            (1, TAU / turn as f32),
        ] {
            let angle = wheel_angle(turns * turn + counts, 32.0);
            assert!((angle - expected).abs() < 1e-6, "{turns} {counts}: {angle}");
        }
    }
}

#[test]
fn no_gear_ratio_makes_a_nonsense_angle() {
    for gear_ratio in [0.0, -1.0, f32::NAN, f32::INFINITY, 1.0, 200.0] {
        for counts in [i64::MIN, -1, 0, 1, i64::MAX] {
            let angle = wheel_angle(counts, gear_ratio);
            assert!(
                angle.abs() <= core::f32::consts::PI,
                "{gear_ratio} {counts}"
            );
        }
    }
}

#[test]
fn switches_show_as_keys() {
    let with = |change: fn(&mut OperatorState)| {
        let mut remote = remote();
        remote.operator.e_stop = false;
        change(&mut remote.operator);
        keys(&remote)
    };
    assert_eq!(with(|_| {}), Keys::A);
    assert_eq!(with(|op| op.enabled = true), Keys::A | Keys::START);
    assert_eq!(with(|op| op.e_stop = true), Keys::A | Keys::SELECT);
    assert_eq!(with(|op| op.dead_man = true), Keys::A | Keys::Y);
    assert_eq!(with(|op| op.mode = DriveMode::Pc), Keys::B);
    assert_eq!(with(|op| op.mode = DriveMode::Custom), Keys::X);
}

#[test]
fn channels_9_to_14_show_as_keys() {
    let with = |index: usize, position: f32| {
        let mut remote = remote();
        remote.operator.e_stop = false;
        remote.state.channels[index] = position;
        keys(&remote) - Keys::A
    };
    for (index, above, below) in [
        (8, Keys::empty(), Keys::empty()),
        (9, Keys::L1, Keys::empty()),
        (10, Keys::R1, Keys::empty()),
        (11, Keys::L2, Keys::empty()),
        (12, Keys::R2, Keys::empty()),
        (13, Keys::UP, Keys::DOWN),
        (14, Keys::RIGHT, Keys::LEFT),
        (15, Keys::empty(), Keys::empty()),
    ] {
        assert_eq!(with(index, 0.51), above, "{index}");
        assert_eq!(with(index, 0.49), Keys::empty(), "{index}");
        assert_eq!(with(index, -0.49), Keys::empty(), "{index}");
        assert_eq!(with(index, -0.51), below, "{index}");
    }
}

/// Receivers send 0 for a channel that the transmitter does not have, which looks like the low end.
#[test]
fn absent_channels_press_no_key() {
    let mut remote = remote();
    remote.operator.e_stop = false;
    remote.raw = [0; 16];
    remote.state.channels = [-1.0; 16];
    assert_eq!(keys(&remote), Keys::A);
    assert_eq!(uplink(&Telemetry::default(), &remote).sticks.l2, 0.0);
    remote.raw = [8; 16];
    assert_eq!(keys(&remote), Keys::A | Keys::DOWN | Keys::LEFT);
}

#[test]
fn sticks_are_right_and_up_positive() {
    let mut remote = remote();
    remote.state = RemoteState {
        vx: 0.1,
        wz: 0.2,
        select: 0.3,
        hold: 0.4,
        ..RemoteState::default()
    };
    remote.state.channels[11] = 0.6;
    let expected = Sticks {
        lx: 0.4,
        rx: -0.2,
        ly: 0.3,
        l2: 0.6,
        ry: 0.1,
    };
    assert_eq!(uplink(&Telemetry::default(), &remote).sticks, expected);
}

#[test]
fn without_radio_only_f1_and_f2_are_left() {
    let mut remote = remote();
    remote.operator.enabled = true;
    remote.state.vx = 1.0;
    remote.state.channels = [1.0; 16];
    for lost in [SafetyFlags::REMOTE_LOST, SafetyFlags::REMOTE_FAILSAFE] {
        for (arming, expected) in [
            (ArmingState::Disarmed, Keys::F2),
            (ArmingState::Armed, Keys::F1 | Keys::F2),
        ] {
            let telemetry = Telemetry {
                flags: lost,
                arming,
                ..Telemetry::default()
            };
            let state = uplink(&telemetry, &remote);
            assert_eq!(state.keys, expected);
            assert_eq!(state.sticks, Sticks::default());
        }
    }
}
