//! `armctl` on emulated servos behind a pseudo-terminal.
#![cfg(unix)]

mod moving;
mod screens;
mod setup;

use std::{
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use robot_servo_model::{Bus, Port, Servo, Version};

/// Six servos with ids 1 to 6 at angles of their own.
pub fn six() -> Port {
    port(six_servos())
}

pub fn six_servos() -> Vec<Servo> {
    let servo = |id: u8| {
        let angle = 1900.0 + 40.0 * f64::from(id);
        Servo::new(Version::Volts12, angle)
            .with_id(id)
            .with_return_delay(0)
    };
    (1..=6).map(servo).collect()
}

pub fn port(servos: Vec<Servo>) -> Port {
    Port::open(Bus::new(servos, 1)).expect("a pseudo-terminal")
}

/// Runs a command on a port; `words` come behind its name.
pub fn armctl(port: &Port, words: &[&str]) -> Output {
    command(port.path(), words).output().expect("armctl starts")
}

pub fn command(port: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command
        .arg(words[0])
        .arg("--port")
        .arg(port)
        .args(&words[1..]);
    command.stdin(Stdio::null());
    command
}

/// What a command printed; it has succeeded.
pub fn said(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}{errors}");
    text
}

/// What a command complained of; it has failed.
pub fn complained(output: &Output) -> String {
    assert!(!output.status.success());
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A file of this test run.
pub fn file(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("armctl");
    std::fs::create_dir_all(&folder).expect("a folder");
    folder.join(name)
}
