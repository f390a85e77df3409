//! An error and its causes form a chain. `robotctl` prints each message of it on a line, so no message repeats the next.

use std::{
    error::Error,
    io,
    path::{Path, PathBuf},
    process::Command,
};

use robotctl::{
    first_board::{Entry, Outcome, Report, WalkError},
    parameter_file::ParameterFile,
    recording::{self, Sensor},
};

fn chain(mut error: &dyn Error) -> Vec<String> {
    let mut messages = vec![error.to_string()];
    while let Some(cause) = error.source() {
        messages.push(cause.to_string());
        error = cause;
    }
    messages
}

/// Returns a path in a folder that does not exist.
fn nowhere() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("no-such-folder/file")
}

#[test]
fn each_cause_is_printed_once() {
    let path = nowhere();
    let mut report = Report::load_or_new(&path).unwrap();
    let entry = Entry::new(Outcome::Skipped, String::new(), None);
    let errors: [Box<dyn Error>; 6] = [
        Box::new(ParameterFile::load(&path).unwrap_err()),
        Box::new(ParameterFile::default().save(&path).unwrap_err()),
        Box::new(recording::load(&path, Sensor::Accelerometer).unwrap_err()),
        Box::new(Report::load_or_new(Path::new(env!("CARGO_TARGET_TMPDIR"))).unwrap_err()),
        Box::new(report.put("boot", entry).unwrap_err()),
        Box::new(WalkError::from(io::Error::other("the terminal is gone"))),
    ];
    for error in errors {
        let [message, cause] = &chain(error.as_ref())[..] else {
            panic!("{error:?} has other than one cause");
        };
        assert!(!message.contains(cause), "{message}");
    }
}

#[test]
fn a_missing_file_is_named_above_its_cause() {
    let path = nowhere();
    let mut command = Command::new(env!("CARGO_BIN_EXE_robotctl"));
    let output = command.args(["calibrate", "accel"]).arg(&path).output();
    let output = output.unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let lines: Vec<&str> = said.lines().collect();
    let [error, cause] = lines[..] else {
        panic!("{said}");
    };
    assert!(!output.status.success());
    assert_eq!(error, format!("Error: cannot read {}", path.display()));
    assert!(cause.starts_with("  because: "), "{said}");
}
