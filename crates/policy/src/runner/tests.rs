use std::time::Duration;

use robotctl::link_recorder::Mode;

use super::{
    testing::{Bench, REST_RAD},
    *,
};
use crate::pace::{Lateness, RobotPace};

/// A run with a network that gives zeros, at the moment when it drives.
fn driving() -> Bench {
    let mut bench = Bench::new([0.0; 6]);
    bench.until(Phase::Policy);
    bench
}

/// Something happens while the policy drives; the robot is limp in the same cycle.
fn goes_limp(name: &str, happens: impl FnOnce(&mut Bench)) {
    let mut bench = driving();
    bench.cycle();
    assert!(!bench.is_limp());
    happens(&mut bench);
    bench.cycle();
    assert_eq!((bench.ended_by(), bench.phase()), (name, Phase::Passive));
    assert!(bench.is_limp(), "{:?}", bench.last);
    assert!(bench.runner.machine().is_over());
}

/// Something happened while the policy drove; the robot gets down, and begins with `phase`.
fn gets_down(mut bench: Bench, name: &str, phase: Phase) {
    assert_eq!((bench.ended_by(), bench.phase()), (name, phase));
    assert!(!bench.is_limp());
    bench.until(Phase::Passive);
    let joints = bench.state.motors[2..].iter();
    assert!(
        joints
            .clone()
            .all(|it| (it.pos_rad - REST_RAD).abs() < 0.01),
        "{joints:?}"
    );
    assert!(bench.is_limp() && bench.runner.machine().is_over());
}

#[test]
fn it_gets_up_to_the_default_pose_before_the_policy_drives() {
    let mut bench = Bench::new([0.0, 0.0, 0.0, 0.0, 1.0, -2.0]);
    bench.until(Phase::GetUp);
    // From rest: the first targets are where the joints are.
    let first = bench.last;
    assert!(
        first
            .joints
            .iter()
            .all(|it| (it.pos_rad - REST_RAD).abs() < 0.01 && it.kp == 40.0)
    );
    assert!(
        first
            .wheels
            .iter()
            .all(|it| it.speed_rps == 0.0 && it.kd == 0.5)
    );
    bench.until(Phase::Policy);
    assert!(
        (bench.time_s - 2.5).abs() < 0.02,
        "0.5 s settled, 1 s up, 1 s held: {}",
        bench.time_s
    );
    let angles = bench.last.joints.map(|it| it.pos_rad);
    let near = angles
        .iter()
        .zip([-0.3, -0.2, -0.1, 0.0])
        .all(|(a, b)| (a - b).abs() < 1e-3);
    assert!(near, "{angles:?}");
    assert!(bench.last.joints.iter().all(|it| it.kp == 20.0));
    let speeds = bench.last.wheels.map(|it| (it.speed_rps, it.kd));
    assert_eq!(
        speeds,
        [(5.0, 0.3), (-8.333_333, 0.3)],
        "-10 rad/s is held within 2.5 N·m / 0.3"
    );
    let shares: Vec<_> = bench.runner.held_shares().collect();
    assert_eq!(shares, [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn the_network_runs_in_one_of_four_cycles() {
    let mut bench = driving();
    let runs: Vec<bool> = (0..8)
        .map(|_| {
            bench.cycle();
            bench.runner.has_run()
        })
        .collect();
    assert_eq!(
        runs.iter().filter(|has_run| **has_run).count(),
        2,
        "{runs:?}"
    );
}

#[test]
fn nothing_moves_before_the_pilot_has_armed_in_mode_pc() {
    let mut bench = Bench::new([0.0; 6]);
    for obstacle in [
        Obstacle::RadioLost,
        Obstacle::NotPc(Mode::Manual),
        Obstacle::Disarmed(Vec::new()),
        Obstacle::PcAwaited,
    ] {
        bench.obstacle = Some(obstacle);
        for _ in 0..400 {
            bench.cycle();
            assert!(bench.is_limp());
        }
    }
    bench.obstacle = None;
    bench.until(Phase::GetUp);
}

#[test]
fn an_obstacle_for_a_moment_begins_the_wait_anew() {
    let mut bench = Bench::new([0.0; 6]);
    for _ in 0..20 {
        for obstacle in [Some(Obstacle::PcAwaited), None] {
            bench.obstacle = obstacle;
            for _ in 0..90 {
                bench.cycle();
            }
        }
    }
    assert_eq!(bench.phase(), Phase::Passive);
}

#[test]
fn the_modes_loss_stops() {
    goes_limp("not-permitted", |bench| {
        bench.obstacle = Some(Obstacle::NotPc(Mode::Manual))
    });
}

#[test]
fn disarming_stops() {
    goes_limp("not-permitted", |bench| {
        bench.obstacle = Some(Obstacle::Disarmed(Vec::new()))
    });
}

#[test]
fn a_position_out_of_range_stops() {
    goes_limp("joint-position", |bench| {
        bench.state.motors[4].pos_rad = 0.9
    });
}

#[test]
fn the_speed_of_a_joint_stops() {
    goes_limp("joint-speed", |bench| bench.state.motors[3].vel_rps = -15.1);
}

#[test]
fn the_speed_of_a_wheel_stops() {
    goes_limp("joint-speed", |bench| bench.state.motors[1].vel_rps = 33.0);
}

#[test]
fn a_body_that_leans_too_far_stops() {
    let half_rad = 61.0_f32.to_radians() / 2.0;
    let tilted = [half_rad.sin(), 0.0, 0.0, half_rad.cos()];
    goes_limp("attitude", |bench| bench.state.q_xyzw = tilted);
}

#[test]
fn a_robot_that_does_not_say_that_it_is_safe_stops() {
    goes_limp("no-answer", |bench| bench.silence_s = 1.01);
    let mut bench = Bench::new([0.0; 6]);
    bench.silence_s = f64::INFINITY;
    for _ in 0..400 {
        bench.cycle();
    }
    assert_eq!(bench.phase(), Phase::Passive, "nor does it get up");
}

#[test]
fn a_stale_state_stops() {
    goes_limp("stale", |bench| bench.age_s = 0.101);
}

#[test]
fn a_robot_in_lockstep_that_was_silent_stops() {
    let mut pace = RobotPace::new(Duration::from_millis(5));
    pace.hear(4.0);
    pace.begin(4.0);
    let age_s = pace.hear(4.2);
    let late = pace.begin(4.2).expect("its cycle is due");
    goes_limp("stale", |bench| {
        bench.age_s = age_s;
        // The network is late by as much, and that would let the robot get down.
        bench.stop = Lateness::new(0.02).add(late).err();
        assert!(bench.stop.is_some());
    });
}

#[test]
fn a_state_that_is_no_number_stops() {
    goes_limp("implausible", |bench| bench.state.gyro_rps[0] = f32::NAN);
}

#[test]
fn a_state_beyond_its_sensor_stops() {
    goes_limp("implausible", |bench| bench.state.gyro_rps[2] = 50.0);
}

/// 0.5 rad off at 20 N·m/rad are 10 N·m; the limit is 6.
#[test]
fn a_blocked_joint_stops_after_half_a_second() {
    let mut bench = driving();
    bench.follows = false;
    while !bench.runner.is_due() {
        bench.cycle();
    }
    bench.state.motors[2].pos_rad = 0.2;
    for _ in 0..99 {
        let command = bench.cycle();
        assert_eq!(bench.phase(), Phase::Policy);
        let torque_nm = command.joints[0].kp * (command.joints[0].pos_rad - 0.2);
        assert!(torque_nm.abs() < 6.001, "{torque_nm}");
    }
    bench.state.motors[2].pos_rad = -0.3;
    bench.cycle();
    bench.state.motors[2].pos_rad = 0.2;
    for _ in 0..99 {
        bench.cycle();
    }
    assert_eq!(bench.phase(), Phase::Policy, "a break begins it anew");
    bench.cycle();
    bench.cycle();
    assert_eq!(
        (bench.ended_by(), bench.phase()),
        ("joint-torque", Phase::Passive)
    );
    assert!(bench.is_limp());
}

#[test]
fn an_action_that_is_no_number_gets_down() {
    let mut bench = Bench::new([0.0, 0.0, f32::NAN, 0.0, 0.0, 0.0]);
    bench.until(Phase::GetDown);
    gets_down(bench, "action", Phase::GetDown);
}

#[test]
fn the_user_gets_it_down_and_a_second_wish_lets_it_go() {
    let mut bench = driving();
    bench.stop = Some(Stop::Asked);
    bench.cycle();
    gets_down(bench, "asked", Phase::ToDefault);

    let mut bench = driving();
    bench.stop = Some(Stop::Asked);
    bench.cycle();
    bench.cycle();
    bench.stop = Some(Stop::Asked);
    bench.cycle();
    assert!(bench.is_limp() && bench.runner.machine().is_over());
}

#[test]
fn what_the_computer_lacks_gets_it_down() {
    for stop in [
        Stop::Deadline {
            late_ms: 90.0,
            misses: 1,
        },
        Stop::NoCommands("the joystick is gone".to_owned()),
        Stop::TimeOver { seconds: 1.0 },
        Stop::Network("it gives no output".to_owned()),
    ] {
        let name = stop.name();
        let phase = if stop.is_of_network() {
            Phase::GetDown
        } else {
            Phase::ToDefault
        };
        let mut bench = driving();
        bench.stop = Some(stop);
        bench.cycle();
        gets_down(bench, name, phase);
    }
}

/// The network asks for angles beside the default, and for 3 rad/s of each wheel.
#[test]
fn it_goes_to_the_default_pose_while_the_network_drives_the_wheels() {
    let mut bench = Bench::new([0.5, 0.5, 0.5, 0.5, 0.6, 0.6]);
    bench.until(Phase::Policy);
    let driven = bench.last.joints.map(|it| it.pos_rad);
    let default = [-0.3, -0.2, -0.1, 0.0];
    bench.stop = Some(Stop::Asked);
    bench.cycle();
    let began_s = bench.time_s;
    while bench.phase() == Phase::ToDefault {
        let share = ((bench.time_s - began_s) / 2.0) as f32;
        for ((joint, from), to) in bench.last.joints.iter().zip(driven).zip(default) {
            // A command stays for 20 ms.
            let wanted = from + share * (to - from);
            assert!((joint.pos_rad - wanted).abs() < 0.005, "{share}: {joint:?}");
            assert_eq!(joint.kp, 20.0);
        }
        assert!(bench.last.wheels.iter().all(|it| it.speed_rps == 3.0));
        bench.cycle();
    }
    assert_eq!(bench.phase(), Phase::GetDown);
    assert!((bench.time_s - began_s - 2.0).abs() < 0.011, "{began_s}");
    assert!(bench.last.wheels.iter().all(|it| it.speed_rps == 0.0));
}

#[test]
fn a_network_that_fails_on_the_way_to_the_default_pose_is_left_out() {
    let mut bench = driving();
    bench.stop = Some(Stop::Asked);
    bench.cycle();
    bench.stop = Some(Stop::Network("it gives no output".to_owned()));
    bench.cycle();
    gets_down(bench, "asked", Phase::GetDown);
}

#[test]
fn getting_down_ends_at_once_when_the_robot_does_not_obey() {
    let mut bench = driving();
    bench.stop = Some(Stop::Asked);
    bench.cycle();
    bench.obstacle = Some(Obstacle::Disarmed(Vec::new()));
    bench.cycle();
    assert!(bench.is_limp() && bench.runner.machine().is_over());
    assert_eq!(bench.ended_by(), "asked", "the first reason is kept");
}

#[test]
fn getting_down_ends_at_once_though_the_joystick_stays_away() {
    let mut bench = driving();
    let gone = || Some(Stop::NoCommands("the joystick is gone".to_owned()));
    bench.stop = gone();
    bench.cycle();
    bench.stop = gone();
    bench.obstacle = Some(Obstacle::Disarmed(Vec::new()));
    bench.cycle();
    assert!(bench.is_limp() && bench.runner.machine().is_over());
}

#[test]
fn a_fall_while_getting_up_stops() {
    let mut bench = Bench::new([0.0; 6]);
    bench.until(Phase::GetUp);
    bench.state.q_xyzw = [1.0, 0.0, 0.0, 0.0];
    bench.cycle();
    assert_eq!(bench.ended_by(), "attitude");
    assert!(bench.is_limp());
}

/// The history of the run before would be another robot's.
#[test]
fn a_rehearsal_leaves_no_trace_in_the_run() {
    let mut bench = Bench::new([0.5; 6]);
    let mut odd = bench.state;
    odd.gyro_rps = [4.0, 4.0, 4.0];
    bench
        .runner
        .rehearse(&odd, &Commands::default())
        .expect("targets");
    bench.until(Phase::Policy);
    let input = bench.runner.input();
    let block = |term: &str| {
        let mut blocks = bench.runner.layout().blocks().iter();
        let block = blocks
            .find(|it| it.term == term && it.age == 2)
            .expect("the term");
        &input[block.offset..block.offset + block.len]
    };
    assert_eq!(block("ang_vel"), [0.0; 3]);
    assert_eq!(block("actions"), [0.0; 6]);
}
