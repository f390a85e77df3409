//! The arm as a program uses it.

use std::{collections::BTreeMap, sync::atomic::Ordering, time::Duration};

use robot_arm::{
    bus::register::{GOAL_POSITION, MAX_POSITION, TORQUE_ENABLE},
    calibration::{Calibration, Format},
    controller::{ControllerError, Ending, ServoController, Warning},
};

use crate::wire::Emulated;

const INTERVAL: Duration = Duration::from_millis(50);

fn pose(entries: &[(&str, i32)]) -> BTreeMap<String, i32> {
    entries
        .iter()
        .map(|(name, steps)| ((*name).to_owned(), *steps))
        .collect()
}

#[test]
fn the_arm_goes_home_softly_and_says_so() {
    let emulated = Emulated::arm(1);
    let mut arm = emulated.controller();
    arm.soft_move_to_home(20, INTERVAL).unwrap();
    arm.bus().wait(Duration::from_secs(1)).unwrap();
    let positions = arm.read_servo_positions().unwrap();
    assert_eq!(positions.len(), 6);
    for (joint, steps) in positions {
        assert!((steps - 2048).abs() < 8, "{joint} {steps}");
    }
}

/// Switching torque on moves nothing: the goal in a servo that was switched on is 0.
#[test]
fn torque_comes_without_a_jump() {
    let emulated = Emulated::arm(2);
    let before = emulated.view();
    let mut arm = emulated.controller();
    arm.enable_torque().unwrap();
    arm.bus().wait(Duration::from_millis(500)).unwrap();
    for (before, after) in before.iter().zip(emulated.view()) {
        assert!(after.has_torque);
        assert!((before.position_steps - after.position_steps).abs() < 4);
    }
}

#[test]
fn a_target_beyond_the_limits_is_cut_with_one_warning() {
    let emulated = Emulated::arm(3);
    let text = Calibration::so101()
        .to_json()
        .replace("\"range_max\": 4095", "\"range_max\": 2500");
    let calibration = Calibration::parse(&text, "arm.json").unwrap();
    let mut arm = ServoController::new(emulated.bus(), calibration).unwrap();
    let targets = pose(&[("elbow_flex", 3000)]);
    for _ in 0..3 {
        arm.fast_move_to_pose(&targets, 0).unwrap();
    }
    let warnings = arm.take_warnings();
    let said: Vec<String> = warnings.iter().map(Warning::to_string).collect();
    assert_eq!(
        said,
        ["elbow_flex: 3000 is beyond its limits of 0 to 2500: it goes to 2500"]
    );
    assert_eq!(arm.bus().read(3, GOAL_POSITION).unwrap().value, 2500);
    assert_eq!(arm.limit_position("elbow_flex", -5).unwrap(), 0);
}

#[test]
fn what_cannot_be_is_refused_and_moves_nothing() {
    let emulated = Emulated::arm(4);
    let mut arm = emulated.controller();
    let said = arm
        .fast_move_to_pose(&pose(&[("elbow", 1)]), 0)
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("no joint is called elbow") && said.contains("elbow_flex"),
        "{said}"
    );
    assert!(matches!(
        arm.fast_move_to_pose(&pose(&[("elbow_flex", 1)]), -1),
        Err(ControllerError::Speed { speed: -1 })
    ));
    assert!(matches!(
        arm.soft_move_to_home(0, INTERVAL),
        Err(ControllerError::NoSteps)
    ));
    assert!(emulated.view().iter().all(|servo| !servo.has_torque));
}

#[test]
fn a_stop_holds_the_arm_where_it_is() {
    let emulated = Emulated::arm(5);
    let mut arm = emulated.controller();
    arm.fast_move_to_pose(&pose(&[("shoulder_pan", 3500)]), 500)
        .unwrap();
    arm.bus().wait(INTERVAL * 10).unwrap();
    arm.stop_flag().store(true, Ordering::Relaxed);
    let stopped = arm.soft_move_to_home(20, INTERVAL);
    assert!(matches!(stopped, Err(ControllerError::Stopped)));
    arm.bus().wait(INTERVAL * 20).unwrap();
    let view = emulated.view()[0];
    assert!((view.goal_steps - view.position_steps).abs() < 40 && view.position_steps < 2600);
}

/// Ending of each kind, by a drop and by a panic.
#[test]
fn the_arm_holds_or_is_released_at_the_end_and_in_a_panic() {
    for (ending, has_torque) in [(Ending::Hold, true), (Ending::Release, false)] {
        for panics in [false, true] {
            let emulated = Emulated::arm(6);
            let other = emulated.clone();
            let ended = std::panic::catch_unwind(move || {
                let mut arm = other.controller();
                arm.set_ending(ending);
                arm.fast_move_to_pose(&pose(&[("shoulder_pan", 3500)]), 500)
                    .unwrap();
                assert!(!panics, "as the test wants");
            });
            assert_eq!(ended.is_err(), panics);
            let mut bus = emulated.bus();
            bus.wait(Duration::from_secs(2)).unwrap();
            let servos = emulated.view();
            assert!(
                servos.iter().all(|servo| servo.has_torque == has_torque),
                "{ending:?}"
            );
            assert!(
                servos[0].position_steps < 2100,
                "{}",
                servos[0].position_steps
            );
        }
    }
}

#[test]
fn release_takes_the_torque_of_all() {
    let emulated = Emulated::arm(7);
    let mut arm = emulated.controller();
    arm.enable_torque().unwrap();
    arm.release().unwrap();
    assert!(emulated.view().iter().all(|servo| !servo.has_torque));
    assert_eq!(arm.bus().read(1, TORQUE_ENABLE).unwrap().value, 0);
}

#[test]
fn a_pulled_plug_is_an_error_and_the_arm_comes_back() {
    let emulated = Emulated::arm(8);
    let mut arm = emulated.controller();
    arm.enable_torque().unwrap();
    emulated.unplug(true);
    let said = arm.read_positions().unwrap_err().to_string();
    assert!(said.contains("emulated no longer works"), "{said}");
    let error = arm.reconnect(Duration::ZERO).unwrap_err();
    assert!(matches!(error, ControllerError::NotBack { .. }), "{error}");
    emulated.unplug(false);
    arm.reconnect(Duration::ZERO).unwrap();
    assert!(arm.has_torque());
    assert_eq!(arm.read_positions().unwrap().steps.len(), 6);
}

#[test]
fn a_calibration_is_applied_and_found_again() {
    let emulated = Emulated::arm(9);
    let text = Calibration::so101().to_json();
    let text = text.replace("\"homing_offset\"", "\"drive_mode\": 0, \"homing_offset\"");
    let text = text.replacen("\"homing_offset\": 0", "\"homing_offset\": -120", 1);
    let calibration = Calibration::parse(&text, "arm.json").unwrap();
    assert_eq!(calibration.format(), Format::LeRobot);
    let mut arm = ServoController::new(emulated.bus(), calibration.clone()).unwrap();
    let warnings = arm.take_warnings();
    assert_eq!(warnings.len(), 1);
    let said = warnings[0].to_string();
    assert!(
        said.starts_with(
            "shoulder_pan: the servo's homing_offset is 0, and this calibration is for -120"
        ),
        "{said}"
    );
    arm.apply_calibration().unwrap();
    let mut again = ServoController::new(emulated.bus(), calibration).unwrap();
    assert_eq!(again.take_warnings(), []);
    assert_eq!(again.bus().read(1, MAX_POSITION).unwrap().value, 4095);
}
