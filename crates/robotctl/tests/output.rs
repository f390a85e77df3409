//! Checks the output of the tool.

use std::process::{Command, Stdio};

fn robotctl(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_robotctl"));
    command.args(arguments).env("RUST_BACKTRACE", "0");
    command
}

/// `robotctl tune list | head -1` stops reading in this way.
#[test]
fn the_reader_of_the_output_may_stop_early() {
    let mut command = robotctl(&["tune", "list"]);
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert!(output.status.success());
}

#[test]
fn ranges_are_shown_in_words() {
    let output = robotctl(&["tune", "list"]).output().unwrap();
    let list = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = |name: &str| list.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(line("joint-left-front.direction").ends_with("1 or -1"));
    assert!(line("heater.target-c").ends_with("degC       0 … 55"));
    assert!(line("safety.max-tx-failures").ends_with("a whole number, 1 … 1000"));
}

#[test]
fn without_a_bus_the_error_says_how_to_name_one() {
    for arguments in [
        &["status"][..],
        &["joint", "zero", "left-front"],
        &["record", "none.csv"],
        &["tune", "get", "heater.kp"],
    ] {
        let output = robotctl(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success());
        assert!(said.contains("--can COM3"), "{said}");
    }
}
