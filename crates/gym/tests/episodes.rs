//! Episodes, from outside.

use std::path::Path;

use robot_gym::{Environment, Fleet, GymError, Options, StartKind};
use robot_policy::{PolicyDescription, config, observation::Commands, robot::OtherRobot};

const STILL: [f32; 6] = [0.0; 6];

fn policy() -> PolicyDescription {
    let policies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../policy");
    config::read(&policies, "fivebar", "flat").expect("the policy of the tree")
}

fn calm(start: StartKind) -> Options {
    Options {
        start,
        push_mps: 0.0,
        ..Options::default()
    }
}

fn environment(options: Options, seed: u64) -> Environment {
    Environment::new(&policy(), options, seed).expect("it arms")
}

#[test]
fn equal_seeds_are_equal_episodes_and_others_are_not() {
    let episode = |seed| {
        let mut environment = environment(Options::default(), seed);
        let mut seen = environment.observation().to_vec();
        let mut rewards = Vec::new();
        for _ in 0..20 {
            rewards.push(environment.step(&[0.1; 6]).expect("six numbers").reward);
            seen.extend_from_slice(environment.observation());
        }
        environment.reset().expect("it arms");
        seen.extend_from_slice(environment.observation());
        (seen, rewards)
    };
    assert_eq!(episode(5), episode(5));
    assert_ne!(episode(5), episode(6));
}

#[test]
fn a_robot_sits_on_its_nose_or_stands_on_its_wheels() {
    let sits = environment(calm(StartKind::Sitting), 3).truth();
    assert!(
        sits.armed && sits.body_n > 1.0 && sits.roll_pitch_rad[1] > 0.5,
        "{sits:?}"
    );
    let stands = environment(calm(StartKind::Standing), 3).truth();
    assert!(stands.armed && stands.tilt_rad() < 0.25, "{stands:?}");
    assert!((stands.leg_m[0] - 0.205).abs() < 1e-3, "{stands:?}");
}

#[test]
fn a_robot_that_sits_is_in_the_default_pose() {
    let environment = environment(calm(StartKind::Sitting), 3);
    let hips = &environment.observation()[..4];
    assert!(hips.iter().all(|rad| rad.abs() < 0.1), "{hips:?}");
}

/// As it would on the robot, where the network drives through the runner.
#[test]
fn a_limit_of_the_runner_ends_the_episode() {
    let mut environment = environment(calm(StartKind::Sitting), 3);
    let spin = [0.0, 0.0, 0.0, 0.0, 8.0, 8.0];
    let steps = (0..50).map(|_| environment.step(&spin).expect("six numbers"));
    assert!(
        steps.into_iter().any(|step| step.fallen),
        "the wheels spin on"
    );
    let stop = environment.stopped_by().expect("a limit");
    assert_eq!(stop.name(), "joint-speed", "{stop}");
    environment.reset().expect("it arms");
    assert_eq!(environment.stopped_by(), None);
}

/// A robot on its wheels that does nothing falls within a second, and the firmware lets go or the body touches the ground.
#[test]
fn a_robot_that_does_not_balance_falls() {
    let mut environment = environment(calm(StartKind::Standing), 4);
    let steps = (0..100).map(|_| environment.step(&STILL).expect("six numbers"));
    let fall = steps
        .into_iter()
        .find(|step| step.fallen)
        .expect("it falls");
    assert!(fall.reward < -5.0, "{fall:?}");
}

#[test]
fn wheels_that_are_told_to_turn_drive_the_robot_forward() {
    let mut environment = environment(calm(StartKind::Sitting), 5);
    for _ in 0..10 {
        environment
            .step(&[0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
            .expect("six numbers");
    }
    assert!(
        environment.truth().forward_mps > 0.1,
        "{:?}",
        environment.truth()
    );
}

#[test]
fn a_push_changes_the_speed_by_what_it_says() {
    let mut environment = environment(calm(StartKind::Standing), 6);
    let before = environment.truth();
    environment.push([0.0, 0.8]);
    environment.step(&STILL).expect("six numbers");
    let after = environment.truth();
    let moved_m = after.place_m[1] - before.place_m[1];
    // Pushed over 10 ms of the 20: some 12 mm of way, less what the tyres hold.
    assert!((0.002..0.03).contains(&moved_m), "{moved_m}");
}

#[test]
fn a_command_is_seen_and_stays() {
    let mut environment = environment(calm(StartKind::Sitting), 7);
    environment.command(Commands {
        forward_mps: 0.5,
        left_mps: 0.0,
        yaw_rps: -1.0,
    });
    environment.step(&STILL).expect("six numbers");
    // Scales of config.yaml: 0.96 and 0.5.
    assert_eq!(environment.observation()[66..], [0.48, 0.0, -0.5]);
}

/// The robot's own controller stands it up and keeps it up.
#[test]
fn the_built_in_controller_balances() {
    let options = Options {
        built_in: true,
        ..calm(StartKind::Sitting)
    };
    let mut environment = environment(options, 8);
    for _ in 0..250 {
        let step = environment.step(&STILL).expect("six numbers");
        assert!(!step.fallen, "{:?}", environment.truth());
    }
    let truth = environment.truth();
    assert!(truth.tilt_rad() < 0.25 && truth.body_n == 0.0, "{truth:?}");
}

#[test]
fn threads_change_nothing() {
    let run = |threads| {
        let mut fleet = Fleet::new(&policy(), Options::default(), 9, 4, threads).expect("they arm");
        let rows: Vec<_> = (0..60)
            .map(|_| fleet.step(&[0.2; 24]).expect("four rows"))
            .collect();
        assert!(
            rows.iter().any(|row| row.fallen.contains(&true)),
            "none fell"
        );
        rows
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn what_does_not_fit_is_refused() {
    let mut environment = environment(calm(StartKind::Sitting), 10);
    assert!(matches!(
        environment.step(&[0.0; 5]),
        Err(GymError::Action(_))
    ));
    assert!(matches!(
        environment.step(&[f32::NAN; 6]),
        Err(GymError::Action(_))
    ));
    let options = Options {
        speed_mps: 9.0,
        ..Options::default()
    };
    let error = environment.set_options(options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "option speed_mps: 9 is not within 0 and 2.5"
    );
    let mut fleet = Fleet::new(&policy(), Options::default(), 1, 1, 1).expect("it arms");
    assert!(matches!(
        fleet.step(&[0.0; 5]),
        Err(GymError::Length { .. })
    ));
}

#[test]
fn a_policy_for_another_robot_is_refused() {
    let mut other = policy();
    other.joints.pop();
    let error = Environment::new(&other, Options::default(), 1)
        .err()
        .expect("refused");
    assert_eq!(error, GymError::OtherRobot(OtherRobot::Joints { found: 5 }));
    let mut fast = policy();
    fast.decimation = 1;
    let error = Environment::new(&fast, Options::default(), 1)
        .err()
        .expect("refused");
    assert!(matches!(error, GymError::Period { .. }), "{error}");
}
