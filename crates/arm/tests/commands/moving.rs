//! Moving arms.

use std::{thread, time::Duration};

use robot_arm::{calibration::Calibration, motion::Motion};
use robot_servo_model::Fault;

use crate::{armctl, command, complained, file, said, six};

#[test]
fn the_arm_goes_home_and_holds_or_is_released() {
    let port = six();
    let text = said(&armctl(&port, &["home", "--seconds", "0.5"]));
    assert!(
        text.contains("without --arm there are no limits") && text.ends_with("home\n"),
        "{text}"
    );
    let views = port.bus().view();
    assert!(
        views
            .iter()
            .all(|servo| servo.has_torque && (servo.position_steps - 2048).abs() < 30)
    );
    said(&armctl(&port, &["release"]));
    assert!(port.bus().view().iter().all(|servo| !servo.has_torque));
}

#[test]
fn what_is_wrong_with_a_calibration_is_said_before_anything_moves() {
    let port = six();
    let path = file("wrong.json");
    std::fs::write(
        &path,
        r#"{"gripper": {"id": 6, "homing_offset": 0, "range_min": 9, "range_max": 3}}"#,
    )
    .unwrap();
    let text = complained(&armctl(&port, &["home", "--arm", path.to_str().unwrap()]));
    assert!(
        text.contains("wrong.json: gripper: range_min = 9 is not below range_max = 3"),
        "{text}"
    );
    assert!(port.bus().view().iter().all(|servo| !servo.has_torque));
}

#[test]
fn a_motion_by_hand_is_recorded_and_played() {
    for name in ["wave.json", "wave.mcap"] {
        let port = six();
        let path = file(name);
        let words = ["record", path.to_str().unwrap(), "--seconds", "0.6"];
        let child = command(port.path(), &words)
            .stdout(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        for step in 0..10 {
            port.bus()
                .servo_mut(0)
                .unwrap()
                .turn_to(1940.0 + 20.0 * f64::from(step));
            thread::sleep(Duration::from_millis(50));
        }
        said(&child.wait_with_output().unwrap());
        let motion = Motion::load(&path).unwrap();
        assert_eq!(motion.joints().len(), 6);
        let place = motion
            .joints()
            .iter()
            .position(|joint| joint == "shoulder_pan")
            .unwrap();
        let ends = [motion.samples().first(), motion.samples().last()];
        let ends = ends.map(|sample| sample.unwrap().steps[place]);
        assert!(ends[0] < 2000 && ends[1] == 2120, "{ends:?}");
        said(&armctl(&port, &["play", path.to_str().unwrap()]));
        thread::sleep(Duration::from_millis(200));
        let view = port.bus().view()[0];
        assert!((view.position_steps - 2120).abs() < 20, "{view:?}");
    }
}

#[test]
fn a_follower_follows_its_leader_and_the_motion_is_recorded() {
    let (leader, follower) = (six(), six());
    let arm = file("arm.json");
    Calibration::so101().save(&arm).unwrap();
    leader.bus().servo_mut(2).unwrap().turn_to(2300.0);
    let path = file("followed.json");
    let words = [
        "teleoperate",
        "--arm",
        arm.to_str().unwrap(),
        "--leader",
        leader.path().to_str().unwrap(),
        "--leader-arm",
        arm.to_str().unwrap(),
        "--record",
        path.to_str().unwrap(),
        "--seconds",
        "0.5",
    ];
    said(&armctl(&follower, &words));
    let view = follower.bus().view()[2];
    assert!((view.position_steps - 2300).abs() < 20, "{view:?}");
    assert!(leader.bus().view().iter().all(|servo| !servo.has_torque));
    assert!(Motion::load(&path).unwrap().samples().len() > 10);
}

#[test]
fn states_and_alarms_are_shown_and_joints_recover() {
    let port = six();
    let text = said(&armctl(&port, &["monitor", "--json", "--seconds", "0.2"]));
    let first: serde_json::Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    assert_eq!(first["joints"]["elbow_flex"]["position_steps"], 2020);
    assert_eq!(first["errors"].as_array().unwrap().len(), 0);
    let supply = port.bus().start(Fault::Supply { volts: 3.0 });
    thread::sleep(Duration::from_millis(200));
    let output = armctl(&port, &["recover", "gripper"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        !output.status.success() && text.contains("has 3.0 V, and takes"),
        "{text}"
    );
    port.bus().end(supply);
    thread::sleep(Duration::from_millis(200));
    let text = said(&armctl(&port, &["recover", "gripper"]));
    assert!(text.contains("no alarm"), "{text}");
}

#[test]
fn the_screens_want_a_terminal() {
    for name in ["joints", "cartesian"] {
        let port = six();
        let text = complained(&armctl(&port, &[name]));
        assert!(text.contains("no terminal"), "{text}");
        assert!(port.bus().view().iter().all(|servo| !servo.has_torque));
    }
}

#[test]
fn the_bus_and_inverse_kinematics_are_measured() {
    let port = six();
    let words = ["bench", "--json", "--seconds", "0.5", "--poses", "100"];
    let figures: serde_json::Value = serde_json::from_str(&said(&armctl(&port, &words))).unwrap();
    assert!(figures["bus"]["hz"].as_f64().unwrap() > 0.0, "{figures}");
    assert_eq!(figures["bus"]["servos"], 6);
    assert_eq!(figures["ik"]["poses"], 100);
    for field in ["solved", "mean_us", "p99_us"] {
        assert!(figures["ik"][field].is_number(), "{field} in {figures}");
    }
    assert!(port.bus().view().iter().all(|servo| !servo.has_torque));
}
