//! The client against the firmware's own tuning channel, over a bus that carries other frames and loses some.

use std::time::Duration;

use nalgebra::Vector3;
use robot_app::{
    domain::{JointState, Orientation, ParamError, ParamState, ParamStatus, RobotConfig},
    motor::NotStationary,
    safety::SafetyFlags,
    tuning::{LIVE_PAGES, PARAMETERS, Refusal, TuningGate},
};

use super::{
    testing::{Bus, robot},
    *,
};
use crate::{
    mounting::{Watch, WatchError},
    parameter_file::ParameterFile,
    settings::{all, find, find_group},
};

fn file(values: &[(&str, f32)]) -> ParameterFile {
    let mut file = ParameterFile::default();
    for (name, value) in values {
        file.set(name, *value);
    }
    file
}

#[test]
fn every_setting_reads_as_the_robot_has_it_and_takes_its_limits() {
    let (bus, mut client) = robot();
    for named in all() {
        let config = bus.0.borrow().config;
        let value = client.read(named).unwrap();
        assert_eq!(
            value,
            named.parameter.read(&config),
            "{}",
            named.full_name()
        );
        client.write(named, value).unwrap();
    }
    assert_eq!(bus.0.borrow().config, RobotConfig::default());
}

#[test]
fn a_written_value_arrives() {
    let (bus, mut client) = robot();
    let track = find("wheel-geometry.track-m").unwrap();
    client.write(track, 0.4).unwrap();
    assert_eq!(bus.0.borrow().config.wheel_odom.wheel_track_m, 0.4);
    let geometry = client.read_geometry().unwrap();
    assert_eq!((geometry.track_mm, geometry.right_reversed), (400, true));
}

#[test]
fn the_wheel_geometry_is_written_whole() {
    let (bus, mut client) = robot();
    let geometry = WheelGeometry {
        radius_mm: 80,
        track_mm: 350,
        gear_ratio_x100: 1_920,
        left_reversed: true,
        right_reversed: false,
    };
    client.write_geometry(&geometry).unwrap();
    let odom = bus.0.borrow().config.wheel_odom;
    assert_eq!((odom.wheel_radius_m, odom.gear_ratio), (0.08, 19.2));
    assert_eq!((odom.rpm_sign_left, odom.rpm_sign_right), (-1.0, 1.0));
}

#[test]
fn an_armed_robot_refuses_and_the_message_says_what_to_do() {
    let (bus, mut client) = robot();
    bus.0.borrow_mut().gate = TuningGate::Shut;
    let error = client
        .write(find("heater.target-c").unwrap(), 30.0)
        .unwrap_err();
    assert!(matches!(
        error,
        TuningError::Refused {
            reason: Ok(Refusal::Armed),
            ..
        }
    ));
    assert!(error.to_string().contains("switch enable off"), "{error}");
    assert_eq!(bus.0.borrow().config, RobotConfig::default());
}

#[test]
fn a_lost_reply_is_requested_again_and_a_dead_bus_is_reported() {
    let (bus, mut client) = robot();
    let target = find("heater.target-c").unwrap();
    bus.0.borrow_mut().to_lose = 2;
    client.write(target, 30.0).unwrap();
    assert_eq!(bus.0.borrow().config.heater.target_c, 30.0);

    bus.0.borrow_mut().to_lose = usize::MAX;
    let before = bus.0.borrow().requests;
    assert!(matches!(client.read(target), Err(TuningError::Silent(_))));
    assert_eq!(bus.0.borrow().requests - before, 3);
}

#[test]
fn a_file_is_applied_whatever_the_order_of_its_values() {
    let (bus, mut client) = robot();
    // Alone, a lower limit of 2 contradicts the upper limit of 0.75.
    let values = [
        ("joint-left-front.min-rad", 2.0),
        ("joint-left-front.max-rad", 3.0),
        ("joint-left-front.max-kd", 5.0),
    ];
    let applied = apply(&mut client, &file(&values)).unwrap();
    let joint = bus.0.borrow().config.joints[0];
    assert_eq!((joint.min_rad, joint.max_rad), (2.0, 3.0));
    let max = applied.iter().find(|a| a.named.parameter.name == "max-rad");
    assert_eq!(max.map(|a| (a.before, a.after)), Some((0.75, 3.0)));
}

/// No two functions may share a channel, not even for a moment.
#[test]
fn channels_of_the_radio_may_change_places() {
    let (bus, mut client) = robot();
    let values = [
        ("radio.steering-channel", 1.0),
        ("radio.drive-channel", 2.0),
        ("radio.select-channel", 0.0),
        ("radio.enable-channel", 6.0),
        ("radio.e-stop-channel", 4.0),
    ];
    apply(&mut client, &file(&values)).unwrap();
    let radio = bus.0.borrow().config.radio;
    assert_eq!((radio.steering.index, radio.drive.index), (1, 2));
    assert_eq!(radio.select.index, 0);
    assert_eq!((radio.enable.index, radio.e_stop.index), (6, 4));
    let twice = [
        ("radio.steering-channel", 9.0),
        ("radio.drive-channel", 9.0),
    ];
    apply(&mut client, &file(&twice)).unwrap_err();
}

#[test]
fn a_file_with_a_mistake_changes_nothing() {
    let (bus, mut client) = robot();
    let mistakes = [
        ("heater.targt-c", 30.0, "did you mean `heater.target-c`"),
        ("heater.target-c", 300.0, "0 … 55 degC"),
        ("joint-left-front.direction", 0.5, "1 or -1"),
        ("safety.clear-hold-us", 1.5, "a whole number"),
    ];
    for (name, value, expected) in mistakes {
        let values = [("wheel-geometry.track-m", 0.4), (name, value)];
        let error = apply(&mut client, &file(&values)).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert_eq!(bus.0.borrow().config, RobotConfig::default());
}

#[test]
fn values_that_can_never_fit_end_the_application() {
    let (bus, mut client) = robot();
    let values = [
        ("joint-left-front.min-rad", 1.0),
        ("joint-left-front.max-rad", -1.0),
    ];
    let error = apply(&mut client, &file(&values)).unwrap_err();
    assert!(matches!(
        error,
        ApplyError::Partly {
            written: 1,
            all: 2,
            ..
        }
    ));
    assert_eq!(bus.0.borrow().config.joints[0].max_rad, -1.0);
}

#[test]
fn unchanged_values_are_not_written() {
    let (bus, mut client) = robot();
    let values = [("heater.target-c", RobotConfig::default().heater.target_c)];
    apply(&mut client, &file(&values)).unwrap();
    assert_eq!(bus.0.borrow().requests, 1, "one read");
}

#[test]
fn bring_up_is_requested_and_too_much_torque_is_refused() {
    let (_, mut client) = robot();
    let joint = |milli: i16| {
        BringUpStep::OneMotor(Motor::RightRear, Trial::Fixed(milli.try_into().unwrap()))
    };
    for step in [BringUpStep::ReadOnly, joint(500), BringUpStep::Off] {
        client.bring_up(step).unwrap();
    }
    let error = client.bring_up(joint(501)).unwrap_err();
    assert!(error.to_string().contains("out of its range"), "{error}");
}

const QUICK: SaveTimeouts = SaveTimeouts {
    pause: Duration::ZERO,
    looks: 5,
};

fn changed() -> (Bus, TuningClient) {
    let (bus, mut client) = robot();
    client
        .write(find("heater.target-c").unwrap(), 30.0)
        .unwrap();
    (bus, client)
}

#[test]
fn a_change_is_followed_until_it_is_saved() {
    let (bus, mut client) = changed();
    bus.0.borrow_mut().looks_to_save = Some(4);
    let report = wait_until_saved(&mut client, QUICK).unwrap();
    assert!(report.is_saved());
    assert_eq!(bus.0.borrow().looks_to_save, Some(0));
}

#[test]
fn a_failing_save_is_explained_with_advice() {
    let (bus, mut client) = changed();
    bus.0.borrow_mut().looks_to_save = None;
    let mut complaint = |state, last_error| {
        bus.0.borrow_mut().diagnostics.params = ParamStatus {
            state,
            last_error,
            unsaved: 1,
            seen: 1,
            ..ParamStatus::default()
        };
        let error = wait_until_saved(&mut client, QUICK).unwrap_err();
        error.to_string()
    };
    let moving = complaint(ParamState::WaitingForRest, ParamError::None);
    assert!(moving.contains("enable switch is off"), "{moving}");
    let failing = complaint(ParamState::BackingOff, ParamError::NotErased);
    assert!(failing.contains("not blank after its erase"), "{failing}");
    assert!(failing.contains("tune save"), "{failing}");
    let busy = complaint(ParamState::Settling, ParamError::None);
    assert!(busy.contains("changing settings"), "{busy}");
    assert_eq!(bus.0.borrow().requests, 1 + 3 * 5);
}

#[test]
fn an_old_firmware_is_known_to_save_nothing() {
    let (bus, mut client) = changed();
    bus.0.borrow_mut().is_old = true;
    assert_eq!(client.store().unwrap(), None);
    assert_eq!(client.boot_findings().unwrap(), None);
    let error = wait_until_saved(&mut client, QUICK).unwrap_err();
    assert!(matches!(error, SaveError::NeverSaves));
}

#[test]
fn findings_of_the_boot_are_named() {
    let (bus, mut client) = robot();
    bus.0.borrow_mut().diagnostics.params = ParamStatus {
        lost_sectors: 1,
        refused: 1 << 3 | 1 << (PARAMETERS.len() - 1),
        ..ParamStatus::default()
    };
    let findings = client.boot_findings().unwrap().unwrap();
    assert_eq!(findings.lost_sectors, 1);
    assert_eq!(findings.refused, [Ok("safety"), Ok("joint-right-rear")]);
}

/// The group has its defaults already, but flash contains a record that was refused.
#[test]
fn defaults_that_change_nothing_wait_for_the_robot_too() {
    let (bus, mut client) = robot();
    bus.0.borrow_mut().looks_to_save = Some(3);
    client.restore_defaults(None).unwrap();
    assert!(!client.store().unwrap().unwrap().is_saved());
    wait_until_saved(&mut client, QUICK).unwrap();
    assert_eq!(bus.0.borrow().looks_to_save, Some(0));
}

#[test]
fn defaults_of_a_group_or_of_all_are_restored() {
    let (bus, mut client) = changed();
    let track = find("wheel-geometry.track-m").unwrap();
    client.write(track, 0.3).unwrap();
    client
        .restore_defaults(Some(find_group("heater").unwrap()))
        .unwrap();
    let config = bus.0.borrow().config;
    assert_eq!(config.heater, RobotConfig::default().heater);
    assert_eq!(config.wheel_odom.wheel_track_m, 0.3);
    client.restore_defaults(None).unwrap();
    assert_eq!(bus.0.borrow().config, RobotConfig::default());
}

#[test]
fn live_values_have_the_firmwares_names_and_units() {
    let (bus, mut client) = robot();
    let joint = live_page("joint");
    {
        let robot = &mut *bus.0.borrow_mut();
        robot.gate = TuningGate::Shut;
        let feedback = &mut robot.diagnostics.sensors.motor.joints[3];
        (feedback.pos_rad, feedback.ts_us) = (0.25, 1);
        feedback.state = JointState::Fault;
        feedback.frozen = true;
        robot.diagnostics.safety.flags = SafetyFlags::JOINT_FAULT;
    }
    let reading = client.live(joint, 3).unwrap().unwrap();
    assert_eq!(reading.title(), "joint right-rear");
    assert_eq!(reading.number("angle-rad"), Some(0.25));
    assert_eq!(reading.choice("state"), "fault");
    assert!(reading.has("marks", "frozen") && !reading.has("marks", "gives-torque"));
    let safety = client.live(live_page("safety"), 0).unwrap().unwrap();
    assert_eq!(safety.title(), "safety");
    assert_eq!(safety.set("flags"), ["joint-fault"]);
    assert!(client.live(joint, 4).unwrap().is_none());
    let pages: usize = LIVE_PAGES.iter().map(|page| page.parts.len()).sum();
    assert_eq!(client.live_all().unwrap().len(), pages);
}

/// x points down and z forward, so y points left; the magnetometer's x points the IMU's left, its y backward.
#[test]
fn sensors_are_watched_along_their_own_axes() {
    let (bus, mut client) = robot();
    {
        let robot = &mut *bus.0.borrow_mut();
        robot.config.mounting.board = Orientation::XDownZForward;
        robot.config.mounting.mag = Some(Orientation::XLeftZUp);
        robot.diagnostics.sensors.imu.accel_mps2 = [1.0, 2.0, 9.0];
        robot.diagnostics.sensors.imu.ts_us = 1;
        robot.diagnostics.sensors.mag.mag_ut = [10.0, 20.0, -40.0];
        robot.diagnostics.sensors.mag.ts_us = 1;
        robot.diagnostics.estimate.rpy_rad = [0.0, 0.0, std::f32::consts::FRAC_PI_2];
        robot.diagnostics.estimate.valid = true;
        robot.diagnostics.estimate.ts_us = 1;
    }
    let mut watch = Watch::new(&mut client).unwrap();
    assert_eq!(watch.board(), Orientation::XDownZForward);
    let force = watch.still_force().unwrap();
    assert!(
        (force - Vector3::new(-9.0, 2.0, 1.0)).norm() < 0.01,
        "{force}"
    );
    // Along the IMU's axes the field is 40, 20, 10.
    let sample = watch.field().unwrap();
    let field = sample.field_ut;
    assert!(
        (field - Vector3::new(20.0, -40.0, 10.0)).norm() < 0.1,
        "{field}"
    );
    // A quarter turn to the left: the nose points north.
    let nose = sample.attitude * Vector3::x();
    assert!((nose - Vector3::y()).norm() < 1e-3, "{nose}");
    watch.check_attitude().unwrap();
    bus.0.borrow_mut().diagnostics.safety.flags = SafetyFlags::ESTIMATE_INVALID;
    assert!(Watch::new(&mut client).unwrap().check_attitude().is_err());
    bus.0.borrow_mut().is_old = true;
    let error = Watch::new(&mut client).unwrap().still_force().unwrap_err();
    assert!(matches!(error, WatchError::TooOld));
}

/// A file with both, in an order that would be refused.
#[test]
fn mounting_is_written_before_calibration() {
    let (bus, mut client) = robot();
    let both = file(&[
        ("imu-calibration.accel-bias-x-mps2", 0.1),
        ("mag-calibration.bias-z-ut", 30.0),
        ("mounting.board", 13.0),
    ]);
    apply(&mut client, &both).unwrap();
    let config = bus.0.borrow().config;
    assert_eq!(config.mounting.board, Orientation::XRightZDown);
    assert_eq!(config.imu.accel_bias_mps2[0], 0.1);
    let board = find("mounting.board").unwrap();
    let refused = client.write(board, 0.0).unwrap_err().to_string();
    assert!(refused.contains("x-forward-z-up"), "{refused}");
    assert!(
        refused.contains("tune defaults imu-calibration --yes"),
        "{refused}"
    );
    assert_eq!(bus.0.borrow().config, config);
}

/// It answers with page 0 in the place of the group, as to any command that it does not know.
#[test]
fn an_old_firmware_has_no_live_values() {
    let (bus, mut client) = robot();
    bus.0.borrow_mut().is_old = true;
    assert!(client.live(live_page("arming"), 0).unwrap().is_none());
    assert!(client.live_all().unwrap().is_empty());
}

#[test]
fn a_value_out_of_range_is_refused_with_its_range() {
    let (_bus, mut client) = robot();
    let mut complaint = |name: &str, value| {
        let error = client.write(find(name).unwrap(), value).unwrap_err();
        error.to_string()
    };
    assert_eq!(
        complaint("heater.target-c", 60.0),
        "heater.target-c = 60: out of range: 0 … 55 degC"
    );
    assert_eq!(
        complaint("joint-left-rear.direction", 0.5),
        "joint-left-rear.direction = 0.5: out of range: 1 or -1"
    );
}

/// The motor is at 0.75 rad. If that is to be 0.25 rad on the mirrored right side, its zero is at 1 rad.
#[test]
fn a_joints_zero_is_set_at_its_present_angle() {
    let (bus, mut client) = robot();
    bus.0.borrow_mut().to_lose = 1;
    client.zero_joint(2, 0.25).unwrap();
    assert_eq!(bus.0.borrow().config.joints[2].zero_rad, 1.0);
    bus.0.borrow_mut().standing = Err(NotStationary::Moving);
    let error = client.zero_joint(2, 0.0).unwrap_err().to_string();
    assert!(error.contains("hold it still"), "{error}");
    bus.0.borrow_mut().standing = Err(NotStationary::Unknown);
    let error = client.zero_joint(2, 0.0).unwrap_err().to_string();
    assert!(error.contains("is its motor powered"), "{error}");
    let error = client.zero_joint(2, 30.0).unwrap_err().to_string();
    assert!(error.contains("is its motor powered"), "{error}");
}
