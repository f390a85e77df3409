//! Networks give what onnxruntime gives, and the program says what is wrong with others.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::OnceLock,
};

use allocation_counter::measure;
use robot_policy::{
    model::{Bench, Model, ModelError},
    observation::{Commands, Observer, Reading},
};
use robot_test_support::Python;
use serde::Deserialize;
use serde_json::Value;

const TOLERANCE: f32 = 1e-5;

#[derive(Deserialize)]
struct Sample {
    input: Vec<f32>,
    output: Vec<f32>,
}

/// The folder with the networks of the script, or `None` where there is no Python.
fn networks() -> Option<&'static Path> {
    static MADE: OnceLock<Option<PathBuf>> = OnceLock::new();
    let made = MADE.get_or_init(|| {
        let python = Python::with_networks()?;
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("networks");
        fs::create_dir_all(&folder).expect("a folder");
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/network/make.py");
        let mut command = python.command(script);
        command.arg(&folder);
        Python::answer(command, "");
        Some(folder)
    });
    made.as_deref()
}

fn succeeded(output: &Output) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{stderr}");
}

fn policy(arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_policy");
    let command = Command::new(program).args(arguments).output();
    command.expect("it starts")
}

fn refusal(file: &Path) -> ModelError {
    match Model::read(file) {
        Ok(_) => panic!("{} is refused", file.display()),
        Err(error) => error,
    }
}

#[test]
fn actions_are_those_of_onnxruntime() {
    let Some(folder) = networks() else { return };
    let expected = fs::read_to_string(folder.join("expected.json")).expect("a file");
    let expected: BTreeMap<String, Vec<Sample>> = serde_json::from_str(&expected).expect("samples");
    assert_eq!(expected.len(), 5);
    for (name, samples) in expected {
        let mut model = Model::read(&folder.join(format!("{name}.onnx"))).expect("a network");
        for sample in samples {
            let mut found = vec![0.0; model.output_len()];
            model.run(&sample.input, &mut found).expect("actions");
            assert_eq!(found.len(), sample.output.len(), "{name}");
            let near = |(a, b): (&f32, &f32)| (a - b).abs() <= TOLERANCE;
            let all_near = found.iter().zip(&sample.output).all(near);
            assert!(all_near, "{name}: {found:?} instead of {:?}", sample.output);
        }
    }
}

#[test]
fn metadata_are_those_of_the_file() {
    let Some(folder) = networks() else { return };
    let model = Model::read(&folder.join("two-outputs.onnx")).expect("a network");
    assert_eq!(model.metadata()["action_scale"], "0.250,0.500,5.000");
}

#[test]
fn networks_with_a_state_or_nameless_actions_are_refused() {
    let Some(folder) = networks() else { return };
    let error = refusal(&folder.join("two-inputs.onnx")).to_string();
    assert!(error.contains(r#"["obs", "time_step"]"#), "{error}");
    let error = refusal(&folder.join("no-actions.onnx")).to_string();
    assert!(error.contains(r#"["mean", "spread"]"#), "{error}");
}

#[test]
fn torch_script_is_refused_with_the_command_that_converts_it() {
    let error = refusal(Path::new("flat/policy.pt")).to_string();
    for part in ["torch.jit.load('flat/policy.pt'", "'flat/policy.onnx'"] {
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn a_file_that_is_no_network_is_named() {
    for file in ["no-such-file.onnx", "Cargo.toml"] {
        let error = refusal(Path::new(file)).to_string();
        assert!(error.starts_with(file), "{error}");
    }
}

#[test]
fn a_slice_of_another_length_is_refused() {
    let Some(folder) = networks() else { return };
    let mut model = Model::read(&folder.join("flat-22.onnx")).expect("a network");
    let error = model.run(&[0.0; 21], &mut [0.0; 6]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the input of the network has 22 values, not 21"
    );
}

#[test]
fn the_bench_sees_that_outputs_agree() {
    let Some(folder) = networks() else { return };
    let mut model = Model::read(&folder.join("elu-105.onnx")).expect("a network");
    let report = Bench { iterations: 20 }.run(&mut model).expect("a report");
    assert!(report.stable, "{report:?}");
    let times = [report.min_us, report.mean_us, report.p99_us, report.max_us];
    assert!(times.is_sorted(), "{report:?}");
    assert_eq!(
        [report.input, report.output, report.iterations],
        [105, 6, 20]
    );
}

#[test]
fn the_program_prints_the_verdict_and_json() {
    let Some(folder) = networks() else { return };
    let file = folder.join("elu-105.onnx");
    let file = file.to_str().expect("UTF-8");
    let output = policy(&["bench", file, "--input", "105", "--iterations", "10"]);
    succeeded(&output);
    assert!(String::from_utf8_lossy(&output.stdout).contains("✓ STABLE"));
    let output = policy(&["bench", file, "--iterations", "10", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["stable"], true);
    assert!(report["p99_us"].as_f64().expect("a number") > 0.0);
    let output = policy(&["bench", file, "--input", "126"]);
    assert!(!output.status.success());
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(
        stderr.contains("its input has 105 values, not 126"),
        "{stderr}"
    );
}

/// A folder of policies in which the network of `fivebar/flat` is one of the script's.
fn policies_with(folder: &Path, network: &str) -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/policies/fivebar");
    let policies = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("shown")
        .join(network);
    let robot = policies.join("fivebar");
    fs::create_dir_all(robot.join("flat")).expect("a folder");
    for file in ["base.yaml", "flat/config.yaml"] {
        fs::copy(own.join(file), robot.join(file)).expect("a file");
    }
    let onnx = folder.join(format!("{network}.onnx"));
    fs::copy(onnx, robot.join("flat/policy.onnx")).expect("a file");
    policies
}

#[test]
fn joints_in_another_order_are_refused() {
    let Some(folder) = networks() else { return };
    let policies = policies_with(folder, "swapped-69");
    let error = robot_policy::load(&policies, "fivebar", "flat").err();
    let error = error.expect("it is refused").to_string();
    for part in [
        "left_front_hip, right_front_hip",
        "left_front_hip, left_rear_hip",
        "joint_mapping",
    ] {
        assert!(error.contains(part), "{error}");
    }
    let error = robot_policy::load(&policies, "fivebar", "hilly").err();
    let error = error.expect("it is refused").to_string();
    assert!(
        error.contains("neither a config.yaml nor a deploy.yaml"),
        "{error}"
    );
}

fn show(policies: &Path) -> [String; 2] {
    let policies = policies.to_str().expect("UTF-8");
    let policy = [
        "--robot",
        "fivebar",
        "--config",
        "flat",
        "--policies",
        policies,
    ];
    let output = self::policy(&[&["show"], &policy[..]].concat());
    [output.stdout, output.stderr].map(|it| String::from_utf8(it).expect("UTF-8"))
}

#[test]
fn the_program_shows_a_policy_and_whether_its_network_fits() {
    let Some(folder) = networks() else { return };
    let [shown, _] = show(&policies_with(folder, "tanh-69"));
    for part in ["69 values", "left_front_hip", "motor 2", "policy.onnx fits"] {
        assert!(shown.contains(part), "{shown}");
    }
    let [shown, complaint] = show(&policies_with(folder, "elu-105"));
    assert!(shown.contains("69 values"), "{shown}");
    let mismatch = "the configuration gives 69 values, and the network takes 105";
    assert!(complaint.contains(mismatch), "{complaint}");
}

#[test]
fn the_program_writes_a_base_once() {
    let policies = Path::new(env!("CARGO_TARGET_TMPDIR")).join("written");
    let file = policies.join("fivebar/base.yaml");
    let _ = fs::remove_file(&file);
    let robot = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/fivebar.toml");
    let paths = [robot, policies].map(|path| path.to_str().expect("UTF-8").to_owned());
    let arguments = ["init", "--robot", &paths[0], "--policies", &paths[1]];
    succeeded(&policy(&arguments));
    let text = fs::read_to_string(&file).expect("a file");
    assert!(
        text.contains("  joint_mapping: [2, 3, 4, 5, 0, 1]\n"),
        "{text}"
    );
    let again = policy(&arguments);
    assert!(!again.status.success());
    let complaint = String::from_utf8_lossy(&again.stderr);
    assert!(complaint.contains("is there already"), "{complaint}");
}

#[test]
fn every_run_allocates_the_same_and_keeps_nothing() {
    let Some(folder) = networks() else { return };
    let mut model = Model::read(&folder.join("elu-105.onnx")).expect("a network");
    let (input, mut output) = (vec![0.1; 105], vec![0.0; 6]);
    let mut run = || measure(|| model.run(&input, &mut output).expect("actions"));
    let first = run();
    for _ in 0..100 {
        let next = run();
        assert_eq!(next.count_current, 0, "{next:?}");
        assert_eq!(
            [next.count_total, next.bytes_total],
            [first.count_total, first.bytes_total]
        );
    }
}

#[test]
fn the_policy_of_the_tree_fits_its_network() {
    let policies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../policy");
    let (policy, mut model) = robot_policy::load(&policies, "fivebar", "flat").expect("it fits");
    let mut observer = Observer::new(&policy);
    let reading = Reading::at_default_pose(&policy);
    let commands = Commands::default();
    let still = vec![0.0; policy.joints.len()];
    let input = observer.observe(&reading, &commands, &still);
    let mut actions = still.clone();
    model
        .run(input.expect("an input"), &mut actions)
        .expect("it runs");
    assert!(
        actions.iter().all(|it| it.is_finite()) && actions != still,
        "{actions:?}"
    );
}
