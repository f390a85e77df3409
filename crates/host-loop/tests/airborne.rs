//! Flight and landing are recognised at once, and nothing else is taken for them.

mod pilot;

use robot_app::domain::{BalanceState, RobotConfig};
use robot_host_loop::Robot;
use robot_plant::world::{PlantKind, Push, RemoteInput, Terrain, WorldConfig};

/// Longest time in s until flight or landing is recognised.
const RECOGNISED_S: f64 = 0.020;

fn sitting(terrain: Terrain, seed: u64) -> Robot {
    let world = WorldConfig {
        plant: PlantKind::Free,
        seed,
        terrain,
        ..WorldConfig::default()
    };
    Robot::in_world(world, RobotConfig::default()).expect("no recording to load")
}

fn standing(terrain: Terrain, seed: u64) -> Robot {
    let mut robot = sitting(terrain, seed);
    pilot::stand_up(&mut robot, 7.0);
    assert_eq!(robot.diagnostics().balance.state, BalanceState::Balance);
    robot
}

fn drive(robot: &mut Robot, stick: f64) {
    robot.remote(RemoteInput {
        vx: Some(stick),
        ..RemoteInput::default()
    });
}

fn airborne(robot: &Robot) -> bool {
    robot.diagnostics().balance.airborne
}

/// No wheel touches the ground.
fn flies(robot: &Robot) -> bool {
    let force_n = ["truth.wheel.0.contact_n", "truth.wheel.1.contact_n"].map(|it| robot.signal(it));
    force_n == [0.0; 2]
}

#[test]
fn flight_and_landing_are_recognised_within_20_ms() {
    for seed in 0..3 {
        let step = Terrain::Step {
            at_m: 1.5,
            height_m: -0.15,
        };
        let mut robot = standing(step, seed);
        drive(&mut robot, 0.4);
        let mut ticks = Vec::new();
        robot.run_until(10.0, |robot| {
            ticks.push((robot.seconds(), flies(robot), airborne(robot)));
        });
        // No bounce of a tyre takes 0.08 s.
        let flight = ticks.chunk_by(|one, next| one.1 == next.1);
        let flight = flight.clone().find(|part| part[0].1 && part.len() > 80);
        let flight = flight.expect("a flight off the step");
        let (left_s, landed_s) = (flight[0].0, flight[flight.len() - 1].0);
        let told = |from_s: f64, to_s: f64, airborne: bool| {
            let mut within = ticks.iter().filter(|it| (from_s..to_s).contains(&it.0));
            within.any(|it| it.2 == airborne)
        };
        assert!(told(left_s, left_s + RECOGNISED_S, true), "off at {left_s}");
        assert!(
            !told(left_s + RECOGNISED_S, landed_s, false),
            "off at {left_s}"
        );
        assert!(
            told(landed_s, landed_s + RECOGNISED_S, false),
            "landed at {landed_s}"
        );
    }
}

/// Runs on and fails where the robot is taken to fly although a wheel has touched the ground all the time before.
fn require_no_false_alarm(robot: &mut Robot, until_s: f64) {
    let mut flew_s = f64::NEG_INFINITY;
    robot.run_until(until_s, |robot| {
        if flies(robot) {
            flew_s = robot.seconds();
        }
        let late_s = robot.seconds() - flew_s;
        assert!(
            !airborne(robot) || late_s <= RECOGNISED_S,
            "a false alarm at {:.3} s",
            robot.seconds()
        );
    });
}

#[test]
fn hard_braking_is_no_flight() {
    for seed in 0..2 {
        let mut robot = standing(Terrain::Flat, seed);
        for stick in [1.0, -1.0, 0.0] {
            drive(&mut robot, stick);
            let until_s = robot.seconds() + 2.0;
            require_no_false_alarm(&mut robot, until_s);
        }
        assert_eq!(robot.diagnostics().balance.state, BalanceState::Balance);
    }
}

#[test]
fn rough_ground_is_no_flight() {
    for seed in 0..3 {
        let plates = Terrain::Plates {
            start_m: 0.8,
            count: 8,
            length_m: 0.3,
            height_m: 0.01,
            tilt_rad: 0.03,
            seed,
        };
        let mut robot = standing(plates, seed);
        drive(&mut robot, 0.2);
        require_no_false_alarm(&mut robot, 15.0);
        assert_eq!(robot.diagnostics().balance.state, BalanceState::Balance);
        assert!(robot.signal("truth.body.x") > 3.0);
    }
}

#[test]
fn a_robot_without_torque_does_not_fly() {
    let never = |robot: &Robot| assert!(!airborne(robot), "at {:.3} s", robot.seconds());
    let mut robot = sitting(Terrain::Flat, 0);
    robot.run_until(2.0, never);
    robot.world_mut().push(Push::instant([0.0, 0.0, 6.4]));
    robot.run_until(3.0, never);
    // The same after it has stood and has lost its torque.
    let mut robot = standing(Terrain::Flat, 0);
    robot.remote(RemoteInput {
        enable: Some(false),
        ..RemoteInput::default()
    });
    let from_s = robot.seconds() + 0.05;
    robot.run_until(from_s, |_| ());
    robot.run_until(from_s + 2.0, never);
}

#[test]
fn a_lifted_wheel_follows_the_one_on_the_ground() {
    let mut robot = standing(Terrain::Flat, 0);
    drive(&mut robot, 0.4);
    robot.run_until(8.5, |_| ());
    // From its right side, so that its right wheel leaves the ground.
    robot.world_mut().push(Push::instant([0.0, 6.4 * 1.1, 0.0]));
    let (mut lifted_ticks, mut apart_mps) = (0, 0.0_f64);
    robot.run_until(9.5, |robot| {
        let [left_n, right_n] =
            ["truth.wheel.0.contact_n", "truth.wheel.1.contact_n"].map(|it| robot.signal(it));
        if left_n > 0.0 && right_n == 0.0 {
            lifted_ticks += 1;
            let [left_mps, right_mps] =
                ["truth.wheel.0.speed_mps", "truth.wheel.1.speed_mps"].map(|it| robot.signal(it));
            apart_mps = apart_mps.max((left_mps - right_mps).abs());
        }
    });
    assert!(lifted_ticks > 100, "lifted for {lifted_ticks} ms");
    assert!(apart_mps < 0.5, "{apart_mps}");
    assert_eq!(robot.diagnostics().balance.state, BalanceState::Balance);
}
