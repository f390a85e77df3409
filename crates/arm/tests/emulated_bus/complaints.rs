//! What users of serial-servo arms complain of most, and what these tools do then. The numbers are those of the issues in
//! huggingface/lerobot and TheRobotStudio/SO-ARM100.

use std::time::Duration;

use robot_arm::{
    bus::{Alarms, BusError, Cause, Presence, register::*},
    calibration::{Calibration, Format, Travel},
    controller::{Mismatch, Recovery, ServoController, Warning},
};
use robot_servo_model::{Fault, Load, Servo, Version};

use crate::wire::Emulated;

/// lerobot #1252, #1389, #526: no or an incorrect status packet.
#[test]
fn no_answer_names_the_servo_the_question_and_the_cure() {
    let emulated = Emulated::arm(40);
    let mut arm = emulated.controller();
    emulated.wire().bus().start(Fault::Gone { servo: 2 });
    let said = arm.read_servo_positions().unwrap_err().to_string();
    assert!(
        said.starts_with("servo 3 (elbow_flex), read present_position, asked 6 times: no answer. Is its supply on"),
        "{said}"
    );
}

/// lerobot #4282: one bad packet ends the loop.
#[test]
fn one_bad_packet_is_asked_for_again() {
    let emulated = Emulated::arm(41);
    let mut arm = emulated.controller();
    emulated
        .wire()
        .fault_for(Fault::CorruptPacket { probability: 1.0 }, 500_000);
    assert_eq!(arm.read_servo_positions().unwrap().len(), 6);
    let statistics = arm.bus().statistics();
    assert!(
        statistics.retried > 0 && statistics.lost == 0,
        "{statistics:?}"
    );
}

/// lerobot #3211, XLeRobot #85: ids are missing. The others go on, and the one comes back by itself.
#[test]
fn a_joint_without_cable_leaves_the_others_and_comes_back() {
    let emulated = Emulated::arm(42);
    let mut arm = emulated.controller();
    arm.enable_torque().unwrap();
    let gone = emulated.wire().bus().start(Fault::Gone { servo: 5 });
    for _ in 0..50 {
        let positions = arm.read_positions().unwrap();
        assert_eq!((positions.steps.len(), positions.errors.len()), (5, 1));
        assert_eq!(positions.errors[0].joint.as_deref(), Some("gripper"));
    }
    emulated.wire().bus().end(gone);
    arm.bus().wait(Duration::from_secs(1)).unwrap();
    assert_eq!(arm.read_positions().unwrap().steps.len(), 6);
    let joint = "gripper".to_owned();
    assert_eq!(arm.take_warnings(), [Warning::NoTorque { joint }]);
    let goal = [
        ("shoulder_pan".to_owned(), 2000),
        ("gripper".to_owned(), 2000),
    ]
    .into();
    arm.fast_move_to_pose(&goal, 0).unwrap();
    let view = emulated.view()[5];
    assert!(!view.has_torque, "nobody gave it torque unasked");
    assert_ne!(view.goal_steps, 2000, "no goal waits for its torque");
    arm.enable_torque().unwrap();
    arm.bus().wait(Duration::from_secs(1)).unwrap();
    let views = emulated.view();
    assert!(views.iter().all(|servo| servo.has_torque), "{views:?}");
    assert!(
        (views[5].position_steps - 2220).abs() < 4,
        "no jump: {views:?}"
    );
    assert!(
        (views[0].position_steps - 2000).abs() < 8,
        "the others move on: {views:?}"
    );
}

/// lerobot #1110, #3394: a motor is not found, because of its baud rate or id.
#[test]
fn a_scan_finds_servos_of_another_speed_and_id() {
    let servos = vec![
        Servo::new(Version::Volts12, 2048.0).with_id(1),
        Servo::new(Version::Volts12, 2048.0)
            .with_id(9)
            .with_baud_code(4),
    ];
    let mut bus = Emulated::new(servos, 43).bus();
    let mut found = vec![];
    for bps in robot_arm::bus::BAUD_RATES {
        bus.set_baud(bps).unwrap();
        for id in 0..=12 {
            if bus.presence(id).unwrap() == Presence::Present {
                found.push((bps, bus.identify(id).unwrap().id));
            }
        }
    }
    assert_eq!(found, [(1_000_000, 1), (115_200, 9)]);
}

/// lerobot #2387, SO-ARM100 #174: input voltage error, as a servo for 7.4 V is on 12 V. Positions still come, with the cure.
#[test]
fn a_wrong_supply_is_said_in_volts_and_ends_by_itself() {
    let servos = (1..=6).map(|id| Servo::new(Version::Volts7, 2048.0).with_id(id));
    let emulated = Emulated::new(servos.collect(), 44);
    let mut arm = emulated.controller();
    let supply = emulated.wire().bus().start(Fault::Supply { volts: 12.0 });
    arm.bus().wait(Duration::from_secs(1)).unwrap();
    assert_eq!(arm.read_servo_positions().unwrap().len(), 6);
    let said = arm.take_warnings()[0].to_string();
    assert!(
        said.contains("input voltage out of range") && said.contains("7.4 V or 12 V"),
        "{said}"
    );
    let Recovery::Voltage {
        has_dv, most_dv, ..
    } = arm.recover("elbow_flex").unwrap()
    else {
        panic!("the voltage is the cause");
    };
    assert!(has_dv >= 119 && most_dv < 119, "{has_dv} {most_dv}");
    emulated.wire().bus().end(supply);
    arm.bus().wait(Duration::from_secs(1)).unwrap();
    assert_eq!(arm.recover("elbow_flex").unwrap(), Recovery::Fine);
}

/// SO-ARM100 #66, physical-ai-studio #955: an overload that only a power cycle ended.
#[test]
fn an_overload_is_ended_without_a_power_cycle() {
    let emulated = Emulated::arm(45);
    let mut arm = emulated.controller();
    arm.enable_torque().unwrap();
    emulated.wire().bus().start(Fault::Blocked { servo: 5 });
    let goal = [("gripper".to_owned(), 3500)].into();
    arm.fast_move_to_pose(&goal, 0).unwrap();
    arm.bus().wait(Duration::from_secs(5)).unwrap();
    assert_eq!(
        arm.read_servo_positions().unwrap().len(),
        6,
        "positions still come"
    );
    let said = arm.take_warnings()[0].to_string();
    assert!(said.starts_with("gripper: overload"), "{said}");
    assert_eq!(
        arm.recover("gripper").unwrap(),
        Recovery::Recovered {
            had: Alarms::OVERLOAD
        }
    );
    assert_eq!(arm.recover("gripper").unwrap(), Recovery::Fine);
}

/// Of an arm without torque, `recover` gives it to one joint: the others get it with the next motion.
#[test]
fn a_motion_after_a_recovery_has_the_torque_of_all_joints() {
    let emulated = Emulated::arm(52);
    let mut arm = emulated.controller();
    arm.enable_torque().unwrap();
    let blocked = emulated.wire().bus().start(Fault::Blocked { servo: 5 });
    let goal = [("gripper".to_owned(), 3500)].into();
    arm.fast_move_to_pose(&goal, 0).unwrap();
    arm.bus().wait(Duration::from_secs(5)).unwrap();
    drop(arm);
    emulated.wire().bus().end(blocked);
    let mut arm = emulated.controller();
    for id in 1..=5 {
        arm.bus().write(id, TORQUE_ENABLE, 0).unwrap();
    }
    let recovered = arm.recover("gripper").unwrap();
    assert!(
        matches!(recovered, Recovery::Recovered { .. }),
        "{recovered:?}"
    );
    arm.fast_move_to_pose(&[("shoulder_pan".to_owned(), 2000)].into(), 0)
        .unwrap();
    assert!(emulated.view().iter().all(|servo| servo.has_torque));
}

#[test]
fn a_hot_servo_is_told_to_cool() {
    let emulated = Emulated::arm(46);
    let mut arm = emulated.controller();
    emulated.wire().bus().start(Fault::Hot {
        servo: 1,
        celsius: 80.0,
    });
    arm.bus().wait(Duration::from_secs(1)).unwrap();
    let hot = arm.recover("shoulder_lift").unwrap();
    assert!(
        matches!(hot, Recovery::Hot { has_c: 75..=85, .. }),
        "{hot:?}"
    );
}

/// lerobot #1296, #3370, #1885: an offset beyond 2047.
#[test]
fn an_offset_that_no_servo_stores_is_refused_with_a_cure() {
    let error = Travel::new(4095, 0)
        .finish(1, Format::LeRobot, true)
        .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("2047 at the most: move the joint by some steps"),
        "{error}"
    );
    let mut bus = Emulated::arm(47).bus();
    let error = bus.store(1, &[(HOMING_OFFSET, 2048)]).unwrap_err();
    assert!(
        matches!(error, BusError::Value { value: 2048, .. }),
        "{error}"
    );
}

/// lerobot #1360: after a replug the offset is another.
#[test]
fn an_offset_that_is_lost_is_noticed() {
    let emulated = Emulated::arm(48);
    let text = Calibration::so101().to_json();
    let text = text.replace(
        "\"homing_offset\": 0",
        "\"drive_mode\": 0, \"homing_offset\": 300",
    );
    let calibration = Calibration::parse(&text, "arm.json").unwrap();
    let mut arm = ServoController::new(emulated.bus(), calibration).unwrap();
    let lost = arm.take_warnings();
    let is_offset = |w: &Warning| {
        matches!(
            w,
            Warning::Mismatch(Mismatch::Offset {
                wanted: 300,
                has: 0,
                ..
            })
        )
    };
    assert_eq!(lost.iter().filter(|w| is_offset(w)).count(), 6);
    arm.apply_calibration().unwrap();
    // It is stored: a brown-out does not take it.
    emulated.wire().fault_for(Fault::BrownOut, 100_000_000);
    arm.bus().wait(Duration::from_secs(2)).unwrap();
    arm.reconnect(Duration::ZERO).unwrap();
    assert_eq!(arm.take_warnings(), []);
    assert!(!arm.has_torque(), "a servo that had no power has no torque");
}

/// Two new servos at once: both have the id 1 as shipped, here 5.
#[test]
fn two_servos_with_one_id_are_recognised() {
    let emulated = Emulated::arm(49);
    emulated
        .wire()
        .bus()
        .start(Fault::DuplicateId { servo: 5, id: 5 });
    let mut bus = emulated.bus();
    let error = bus.read(5, PRESENT_POSITION).unwrap_err();
    let BusError::Servo(error) = error else {
        panic!("{error}");
    };
    assert_eq!(error.cause, Cause::Damaged);
    assert_eq!(bus.presence(6).unwrap(), Presence::Absent);
}

/// SO-ARM100 #134: under load a joint stays off its goal; the state shows load and position together.
#[test]
fn load_and_position_are_read_together() {
    let emulated = Emulated::arm(50);
    let mut arm = emulated.controller();
    arm.enable_torque().unwrap();
    let load = Load {
        torque_nm: 0.8,
        ..Load::default()
    };
    emulated.wire().bus().servo_mut(1).unwrap().set_load(load);
    arm.bus().wait(Duration::from_secs(1)).unwrap();
    let states = arm.read_states().unwrap();
    let (name, state) = &states.joints[1];
    assert_eq!(name, "shoulder_lift");
    assert!(
        state.load_permille.abs() > 50 && state.current_ma != 0,
        "{state:?}"
    );
    assert!((110..=125).contains(&state.voltage_dv), "{state:?}");
}
