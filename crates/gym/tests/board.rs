//! Episodes of the shipped image in the emulated board.

use std::path::Path;

use robot_gym::{Environment, GymError, Options, StartKind};
use robot_policy::{PolicyDescription, config, observation::Commands};
use robot_test_support::image;

const STILL: [f32; 6] = [0.0; 6];

fn policy() -> PolicyDescription {
    let policies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../policy");
    config::read(&policies, "fivebar", "flat").expect("the policy of the tree")
}

fn calm() -> Options {
    Options {
        start: StartKind::Sitting,
        push_mps: 0.0,
        ..Options::default()
    }
}

/// The board differs from the app by the latency of its cable and the phase of its sensors.
#[test]
fn image_and_app_are_one_robot() {
    let mut app = Environment::new(&policy(), calm(), 3).expect("it arms");
    let mut board = Environment::on_board(&policy(), calm(), 3, &image()).expect("it arms");
    let [on_app, on_board] = [&app, &board].map(|it| it.truth());
    assert!(on_board.armed && on_board.body_n > 1.0, "{on_board:?}");
    let pitches = [on_app, on_board].map(|it| it.roll_pitch_rad[1]);
    assert!((pitches[0] - pitches[1]).abs() < 0.02, "{pitches:?}");
    for step in 0..25 {
        let hips = 0.3 * (step as f32 / 25.0);
        let actions = [hips, -hips, hips, -hips, 0.0, 0.0];
        for environment in [&mut app, &mut board] {
            assert!(!environment.step(&actions).expect("six numbers").fallen);
        }
        let seen = app.observation().iter().zip(board.observation());
        let joints = seen.take(4).map(|(one, other)| (one - other).abs());
        let most = joints.fold(0.0, f32::max);
        assert!(most < 0.05, "step {step}: hips differ by {most}");
    }
    // More than the 2.4 N·m that a robot as delivered gives: the limit of current was read from flash.
    let spin = [0.0, 0.0, 0.0, 0.0, 8.0, 8.0];
    for (name, environment) in [("app", &mut app), ("board", &mut board)] {
        environment.step(&spin).expect("six numbers");
        let torques_nm = environment.truth().wheel_nm;
        assert!(
            torques_nm.iter().all(|it| *it > 3.0),
            "{name}: {torques_nm:?}"
        );
    }
}

/// Equal seeds give equal episodes, also after a reset, for which the board boots again.
#[test]
fn the_robots_own_controller_stands_up_and_drives_on_the_board() {
    let options = Options {
        built_in: true,
        vary: false,
        episodes_per_robot: 2,
        ..calm()
    };
    let mut environment = Environment::on_board(&policy(), options, 1, &image()).expect("it arms");
    let episode = |environment: &mut Environment| {
        environment.command(Commands::default());
        let mut seen = Vec::new();
        for step in 0..250 {
            if step == 150 {
                environment.command(Commands {
                    forward_mps: 0.5,
                    ..Commands::default()
                });
            }
            assert!(!environment.step(&STILL).expect("six numbers").fallen);
            seen.extend_from_slice(environment.observation());
        }
        (seen, environment.truth())
    };
    let (first, truth) = episode(&mut environment);
    assert!((truth.forward_mps - 0.5).abs() < 0.15, "{truth:?}");
    assert!(truth.tilt_rad() < 0.2 && truth.body_n == 0.0, "{truth:?}");
    environment.reset().expect("it boots");
    let (again, _) = episode(&mut environment);
    assert!(first == again, "the same robot does something else");
}

#[test]
fn an_image_of_another_robot_and_one_that_is_not_there_are_refused() {
    let other = std::env::var_os("ROBOT_ELF_DBUS_RS00").map(|other| (other, "fivebar-rs00"));
    for (image, says) in other.into_iter().chain([("nowhere".into(), "nowhere")]) {
        let refused = Environment::on_board(&policy(), calm(), 1, Path::new(&image)).map(|_| ());
        let error = refused.expect_err("no robot can boot");
        assert!(matches!(error, GymError::Board(_)), "{error}");
        assert!(error.to_string().contains(says), "{error}");
    }
}
