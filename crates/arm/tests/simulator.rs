//! `armctl sim`, and `armctl` on it.
#![cfg(unix)]

use std::{
    fs,
    io::{BufRead, BufReader, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, ChildStdout, Command, Output, Stdio},
};

const ARMCTL: &str = env!("CARGO_BIN_EXE_armctl");

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// `armctl sim` with a keyboard, and its port.
struct Sim {
    child: Child,
    keyboard: ChildStdin,
    output: BufReader<ChildStdout>,
    port: PathBuf,
}

impl Sim {
    fn start(name: &str, words: &[&str]) -> Self {
        let port = folder(name);
        let mut command = Command::new(ARMCTL);
        command.args(["sim", "--at"]).arg(&port).args(words);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("it starts");
        let keyboard = child.stdin.take().expect("a pipe");
        let output = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut sim = Self {
            child,
            keyboard,
            output,
            port,
        };
        let heading = sim.line();
        assert!(heading.starts_with(&sim.port.display().to_string()));
        sim
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.output.read_line(&mut line).expect("text");
        line
    }

    /// Types a line, and reads what is said to it.
    fn types(&mut self, line: &str) -> String {
        writeln!(self.keyboard, "{line}").expect("it reads");
        loop {
            let said = self.line();
            assert!(!said.is_empty(), "it has ended");
            if let Some(said) = said.strip_prefix("> ") {
                return said.trim_end().to_owned();
            }
        }
    }

    fn armctl(&self, words: &[&str]) -> String {
        let (name, rest) = words.split_first().expect("a command");
        let mut command = Command::new(ARMCTL);
        command.args([name, "--port"]).arg(&self.port).args(rest);
        let Output { stdout, stderr, .. } = command.output().expect("it starts");
        String::from_utf8([stdout, stderr].concat()).expect("text")
    }

    fn quit(mut self) {
        writeln!(self.keyboard, "quit").expect("it reads");
        assert!(self.child.wait().expect("it ran").success());
        assert!(fs::symlink_metadata(&self.port).is_err(), "the port stays");
    }
}

impl Drop for Sim {
    /// A test that fails leaves none behind.
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn servos_are_found_on_its_port_until_they_are_unplugged() {
    let mut sim = Sim::start("sim-plain", &[]);
    for id in ["1", "3", "6"] {
        let answer = sim.armctl(&["ping", id]);
        assert!(answer.contains("alarms: none"), "{answer}");
    }
    assert_eq!(sim.types("gone=3"), "gone=3 starts");
    let answer = sim.armctl(&["ping", "3"]);
    assert!(answer.contains("no answer"), "{answer}");
    assert_eq!(sim.types("gone=3"), "gone=3 ends");
    let answer = sim.armctl(&["ping", "3"]);
    assert!(answer.contains("alarms: none"), "{answer}");
    assert!(sim.types("gone=7e").starts_with("gone=7e is none of"));
    sim.quit();
}

#[test]
fn new_servos_get_their_ids_one_after_the_other() {
    let mut sim = Sim::start("sim-factory", &["--factory"]);
    let answer = sim.armctl(&["set-id", "--from", "1", "--to", "5"]);
    assert!(!answer.contains("Error"), "{answer}");
    assert_eq!(sim.types("next"), "servo 2 alone is plugged in");
    let answer = sim.armctl(&["ping", "1", "5"]);
    assert!(answer.contains("no answer"), "{answer}");
    assert_eq!(sim.types("gone=1"), "gone=1 starts");
    assert_eq!(sim.types("gone=1"), "gone=1 ends");
    assert_eq!(sim.types("all"), "all servos are plugged in");
    let answer = sim.armctl(&["ping", "5"]);
    assert!(answer.contains("alarms: none"), "{answer}");
    sim.quit();
}

#[test]
fn the_servos_are_those_of_a_calibration() {
    let file = folder("sim-arm.json");
    let names = [
        "shoulder_pan",
        "shoulder_lift",
        "elbow_flex",
        "wrist_flex",
        "wrist_roll",
        "gripper",
    ];
    let joint = |id| {
        format!(
            r#"{{"id": {id}, "drive_mode": 0, "homing_offset": -{id}, "range_min": 1000, "range_max": 3000}}"#
        )
    };
    let joints: Vec<String> = names
        .iter()
        .zip(11..)
        .map(|(name, id)| format!("\"{name}\": {}", joint(id)))
        .collect();
    fs::write(&file, format!("{{{}}}", joints.join(", "))).expect("a folder for it");
    let path = file.to_str().expect("text");
    let sim = Sim::start("sim-arm", &["--arm", path]);
    let answer = sim.armctl(&["read", "16", "homing_offset"]);
    assert!(answer.contains("-16"), "{answer}");
    sim.quit();
}

#[test]
fn an_unknown_fault_is_answered_with_the_list() {
    let mut command = Command::new(ARMCTL);
    command.args(["sim", "--fault", "gremlins"]);
    let output = command.output().expect("it starts");
    assert!(!output.status.success());
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(said.contains("corrupt-packet=1%"), "{said}");
}
