//! Files that mean nothing are refused, with file, line, key or term, and the cure. Those that `policy init` writes are not.

use std::{
    fs,
    path::{Path, PathBuf},
};

use robot_description::{Hold, Robot};
use robot_policy::{Drive, PolicyDescription, base_yaml, config, observation::Layout};

/// A folder of policies with `fivebar/flat`, in which `change` edits the two files.
fn policies(test: &str, change: impl Fn(&str, &str) -> String) -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/policies/fivebar");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("files")
        .join(test);
    let robot = folder.join("fivebar");
    fs::create_dir_all(robot.join("flat")).expect("a folder");
    for file in ["base.yaml", "flat/config.yaml"] {
        let text = fs::read_to_string(own.join(file)).expect("a file");
        fs::write(robot.join(file), change(file, &text)).expect("a folder");
    }
    folder
}

/// What is said of `fivebar/flat` with its `config.yaml` line for `key` replaced.
fn complaint(test: &str, key: &str, line: &str) -> String {
    let start = format!("  {key}:");
    let folder = policies(test, |file, text| {
        if file == "base.yaml" {
            return text.to_owned();
        }
        let lines = text.lines().filter(|line| !line.starts_with(&start));
        let mut lines: Vec<_> = lines.collect();
        lines.push(line);
        lines.join("\n") + "\n"
    });
    match config::read(&folder, "fivebar", "flat") {
        Ok(_) => panic!("{test}: {line:?} is refused"),
        Err(error) => error.to_string(),
    }
}

fn flat(file: &str, change: impl Fn(&str) -> String) -> PolicyDescription {
    let folder = policies(file, |_, text| change(text));
    config::read(&folder, "fivebar", "flat").expect("a policy")
}

#[test]
fn what_is_wrong_is_named_with_its_key() {
    for (test, key, line, parts) in [
        (
            "unknown term",
            "observations",
            r#"  observations: ["dof_pos", "dof_velocity"]"#,
            &[
                "config.yaml:",
                "observations:",
                "dof_velocity",
                "wheel_joint_vel",
            ][..],
        ),
        (
            "term of a motion",
            "observations",
            r#"  observations: ["RoboMimic_Deploy/phase"]"#,
            &["RoboMimic_Deploy/phase", "recorded motion"],
        ),
        (
            "unknown key",
            "clip_obs",
            "  clip_observations: 5.0",
            &["clip_observations", "unknown"],
        ),
        (
            "missing clip",
            "clip_obs",
            "",
            &["base.yaml", "config.yaml", "clip_obs is missing"],
        ),
        (
            "missing scale",
            "ang_vel_scale",
            "",
            &["ang_vel_scale is missing", "the term ang_vel"],
        ),
        (
            "missing order",
            "observations_history_priority",
            "",
            &["observations_history_priority is missing"],
        ),
        (
            "wrong order",
            "observations_history_priority",
            r#"  observations_history_priority: "newest""#,
            &["\"time\"", "\"term\"", "\"newest\""],
        ),
        (
            "short list",
            "action_scale",
            "  action_scale: [0.25, 0.25]",
            &["action_scale: 2 values", "6"],
        ),
        (
            "not a list",
            "action_scale",
            "  action_scale: fast",
            &["config.yaml:", "action_scale:"],
        ),
        (
            "length of nothing",
            "num_observations",
            "  num_observations: 105",
            &[
                "105",
                "a frame (22, with observations_nonstack 25)",
                "69 values",
                "66 … 68",
            ],
        ),
        (
            "stiff wheel",
            "rl_kp",
            "  rl_kp: [20.0, 20.0, 20.0, 20.0, 5.0, 0.0]",
            &["left_wheel is a wheel with a stiffness of 5"],
        ),
        (
            "half a clip",
            "clip_actions_upper",
            "",
            &["clip_actions_upper is missing"],
        ),
        (
            "clip upside down",
            "clip_actions_lower",
            "  clip_actions_lower: [0, 0, 0, 0, 0, 200]",
            &["clip_actions_lower: value 5"],
        ),
        (
            "motor of two",
            "joint_mapping",
            "  joint_mapping: [2, 3, 4, 5, 0, 0]",
            &["joint_mapping", "once"],
        ),
        (
            "motion",
            "motion_file",
            "  motion_file: \"dance.csv\"",
            &["motion_file", "recorded motion"],
        ),
        (
            "names of the policy",
            "joint_names",
            r#"  joint_names: ["a", "b", "c", "d", "left_wheel", "right_wheel"]"#,
            &[
                "joint_names",
                "joint 2 of the policy is called left_wheel",
                "joint_names[joint_mapping[i]]",
            ],
        ),
        (
            "direction 2",
            "joint_directions",
            "  joint_directions: [1, 1, 1, 1, 1, 2]",
            &["1 or -1"],
        ),
        (
            "wheel 6",
            "wheel_indices",
            "  wheel_indices: [6]",
            &["there is no joint 6"],
        ),
        ("no period", "dt", "  dt: 0.0", &["dt: 0 s"]),
        (
            "never",
            "decimation",
            "  decimation: 0",
            &["decimation", "at least 1"],
        ),
        (
            "commands crossed",
            "commands_lower",
            "  commands_lower: [1, 1, 1]\n  commands_upper: [0, 2, 2]",
            &["commands_lower"],
        ),
    ] {
        let said = complaint(test, key, line);
        let named = parts.iter().all(|part| said.contains(part));
        assert!(named, "{test}: {said}");
    }
}

#[test]
fn the_line_is_that_of_the_value() {
    let folder = policies("line", |file, text| match file {
        "base.yaml" => text.replace("decimation: 4", "decimation: many"),
        _ => text.to_owned(),
    });
    let said = config::read(&folder, "fivebar", "flat")
        .unwrap_err()
        .to_string();
    assert!(said.contains("base.yaml:3: decimation: "), "{said}");
}

#[test]
fn a_file_of_another_folder_is_refused() {
    let folder = policies("folder", |_, text| {
        text.replace("fivebar/flat:", "tita/robot_lab:")
    });
    let said = config::read(&folder, "fivebar", "flat")
        .unwrap_err()
        .to_string();
    for part in ["tita/robot_lab", "fivebar/flat"] {
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn a_folder_without_files_and_with_two_forms_is_named() {
    let folder = policies("forms", |_, text| text.to_owned());
    let said = config::read(&folder, "fivebar", "hilly")
        .unwrap_err()
        .to_string();
    assert!(said.contains("neither"), "{said}");
    fs::write(folder.join("fivebar/flat/deploy.yaml"), "").expect("a folder");
    let said = config::read(&folder, "fivebar", "flat")
        .unwrap_err()
        .to_string();
    fs::remove_file(folder.join("fivebar/flat/deploy.yaml")).expect("a file");
    assert!(said.contains("config.yaml, deploy.yaml"), "{said}");
}

#[test]
fn the_config_overrides_the_base() {
    let policy = flat("overrides", |text| {
        text.replace("fivebar/flat:", "fivebar/flat:\n  decimation: 2")
    });
    assert_eq!(policy.decimation, 2);
    assert!((policy.period_s() - 0.01).abs() < 1e-9);
}

#[test]
fn a_mismatch_shows_both_inputs_and_what_is_likely() {
    let layout = Layout::new(&flat("mismatch", str::to_owned));
    for (model, parts) in [
        // A history of two frames.
        (
            47,
            &[
                "69 values, and the network takes 47",
                "a history of 2 frames of 22 values",
                "47 values",
            ][..],
        ),
        // Without the commands.
        (
            66,
            &[
                "the network does not know commands (3 values too many)",
                "66 values",
            ],
        ),
        // The wheels are in joint positions and speeds of each frame.
        (
            81,
            &[
                "the network knows the wheels in dof_pos and dof_vel as well",
                "    0 … 5       6  dof_pos",
            ],
        ),
        // rl_sar's own form.
        (
            75,
            &["the network knows the wheels in dof_pos and dof_vel, and no wheel_joint_vel"],
        ),
        // Without actions.
        (
            51,
            &["the network does not know actions (18 values too many)"],
        ),
        // The user's own count: 34 values in a frame.
        (105, &["a term of 12 values is missing in each frame"]),
        // No single change.
        (2, &["No single term"]),
    ] {
        let said = layout.check(model).unwrap_err().to_string();
        for part in parts {
            assert!(said.contains(part), "{model}: {said}");
        }
        assert!(said.contains("    0 … 3       4  dof_pos"), "{said}");
        assert!(said.contains("left_front_hip left_rear_hip"), "{said}");
    }
    assert!(layout.check(69).is_ok());
}

#[test]
fn every_value_has_a_name_of_its_own() {
    let layout = Layout::new(&flat("names", str::to_owned));
    let mut names = layout.value_names();
    assert_eq!(names.len(), 69);
    assert_eq!(names[0], "dof_pos[left_front_hip]");
    assert_eq!(names[22 + 8], "wheel_joint_vel[left_wheel]@-1");
    assert_eq!(names[68], "commands[yaw]");
    names.sort();
    names.dedup();
    assert_eq!(names.len(), 69);
}

#[test]
fn a_base_that_was_written_is_the_robot() {
    for name in ["fivebar", "fivebar-rs00"] {
        let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
        let robot = Robot::read(&robots.join(format!("{name}.toml"))).expect("a robot");
        let base = base_yaml(&robot).expect("a base");
        let own = format!("{name}:");
        let folder = policies(name, |file, text| match file {
            "base.yaml" => base.replace(&own, "fivebar:"),
            // What the base says is not overridden.
            _ => text.to_owned(),
        });
        let policy = config::read(&folder, "fivebar", "flat").expect("a policy");
        let mjcf = robot.mjcf(Hold::Free);
        for joint in &policy.joints {
            let named = format!("joint name=\"{}\"", joint.name);
            assert!(mjcf.contains(&named), "{named}");
        }
        let wheels: Vec<_> = policy
            .joints
            .iter()
            .map(|it| it.drive == Drive::Speed)
            .collect();
        assert_eq!(wheels, [false, false, false, false, true, true]);
        let hips = &policy.joints[..2];
        let ranges = &robot.joints.range_rad;
        for (joint, [low, high]) in hips.iter().zip([ranges.front, ranges.rear]) {
            let angle = f64::from(joint.default_rad);
            assert!((low..=high).contains(&angle), "{angle}");
        }
        assert_eq!(policy.mapping.motors(), [2, 3, 4, 5, 0, 1]);
    }
}
