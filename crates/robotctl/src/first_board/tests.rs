use std::{collections::VecDeque, io, path::PathBuf};

use robot_app::{
    diagnostics::DiagnosticsSnapshot,
    domain::{JointState, ResetCause},
    safety::SafetyFlags,
};

use super::*;
use crate::tuning::testing;

/// A user who gives prepared answers and keeps the text shown.
#[derive(Default)]
struct Script {
    answers: VecDeque<&'static str>,
    shown: String,
}

impl Dialogue for Script {
    fn show(&mut self, text: &str) -> io::Result<()> {
        self.shown.push_str(text);
        Ok(())
    }

    fn ask(&mut self, question: &str) -> io::Result<Option<String>> {
        self.shown.push_str(question);
        Ok(self.answers.pop_front().map(str::to_owned))
    }
}

fn path(test: &str) -> PathBuf {
    let name = format!("robotctl-first-board-{test}-{}.toml", std::process::id());
    let path = std::env::temp_dir().join(name);
    // Remove the file of an earlier run.
    let _ = std::fs::remove_file(&path);
    path
}

fn healthy(diagnostics: &mut DiagnosticsSnapshot) {
    diagnostics.reset_cause = ResetCause::PowerOn;
    diagnostics.imu_health.ready = true;
    diagnostics.mag_health.ready = true;
    diagnostics.battery_v = 24.2;
    let imu = &mut diagnostics.sensors.imu;
    (imu.accel_mps2, imu.ts_us) = ([0.1, -0.2, 9.8], 1);
    imu.gyro_dps = [1.0, -2.0, 45.0];
    for joint in &mut diagnostics.sensors.motor.joints {
        (joint.state, joint.ts_us, joint.age_us) = (JointState::Disabled, 1, 2_000);
    }
}

fn go(report: &mut Report, answers: &[&'static str], from: Option<usize>, alone: bool) -> String {
    let mut client = testing::client(healthy);
    let mut user = Script {
        answers: answers.iter().copied().collect(),
        ..Script::default()
    };
    walk(&mut client, report, &mut user, WalkOptions { from, alone }).unwrap();
    user.shown
}

#[test]
fn a_walk_is_resumed_where_it_was_left() {
    let path = path("resumed");
    let mut report = Report::load_or_new(&path).unwrap();
    // The boot passes, the user calls the battery wrong, and then stops.
    let shown = go(
        &mut report,
        &["", "on the desk", "", "n", "23.1 V", "q"],
        None,
        false,
    );
    assert!(shown.contains("1 of 24: The board starts"), "{shown}");
    let mut report = Report::load_or_new(&path).unwrap();
    let battery = report.entry("battery").unwrap();
    assert_eq!(
        (battery.outcome, battery.note.as_str()),
        (Outcome::Wrong, "23.1 V")
    );
    assert_eq!(battery.measured["battery-v"].as_float(), Some(24.2));
    assert_eq!(report.entry("boot").unwrap().note, "on the desk");
    // The radio is silent. It is wrong twice, and then skipped with a reason.
    let shown = go(
        &mut report,
        &["", "y", "s", "no receiver", "q"],
        None,
        false,
    );
    assert!(shown.contains("\n3 of 24"), "{shown}");
    assert!(shown.contains("WRONG: no byte came"), "{shown}");
    let report = Report::load_or_new(&path).unwrap();
    let radio = report.entry("radio").unwrap();
    assert_eq!(
        (radio.outcome, radio.note.as_str()),
        (Outcome::Skipped, "no receiver")
    );
    assert_eq!(
        (
            report.count(Outcome::AsItMustBe),
            report.count(Outcome::Wrong)
        ),
        (1, 1)
    );
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn without_a_user_only_automatic_checks_are_made() {
    let path = path("alone");
    let mut report = Report::load_or_new(&path).unwrap();
    go(&mut report, &[], None, true);
    assert_eq!(report.count(Outcome::AsItMustBe), 1);
    assert_eq!(report.count(Outcome::Skipped), CHECKS.len() - 1);
    let from = CHECKS
        .iter()
        .position(|check| check.id == "gyro-hour")
        .unwrap()
        + 1;
    let shown = go(&mut report, &["", "", ""], Some(from), false);
    assert!(shown.contains("has not run for an hour"), "{shown}");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(
        text.contains("[gyro-hour]") && text.contains("fastest-z-dps = 45.0"),
        "{text}"
    );
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn a_file_that_is_no_report_is_not_overwritten() {
    let path = path("other");
    std::fs::write(&path, "[boot]\nx = 1\n").unwrap();
    let error = Report::load_or_new(&path).unwrap_err().to_string();
    assert!(error.contains("[boot] has no outcome"), "{error}");
    std::fs::remove_file(&path).unwrap();
}

fn verdict(id: &str, fill: impl FnOnce(&mut DiagnosticsSnapshot)) -> Verdict {
    let check = CHECKS.iter().find(|check| check.id == id).unwrap();
    let (Method::Alone(measure) | Method::Prepared(measure)) = check.how else {
        panic!("{id} is measured");
    };
    let mut client = testing::client(|diagnostics| {
        healthy(diagnostics);
        fill(diagnostics);
    });
    measure(&mut client).unwrap().verdict
}

fn complains(id: &str, fill: impl FnOnce(&mut DiagnosticsSnapshot)) -> bool {
    matches!(verdict(id, fill), Verdict::Wrong(_))
}

#[test]
fn measurements_are_judged() {
    assert_eq!(verdict("boot", |_| {}), Verdict::AsItMustBe);
    assert!(complains("boot", |d| d.reset_cause = ResetCause::BrownOut));
    assert!(complains("boot", |d| d.mag_health.ready = false));
    assert!(complains("boot", |d| d.tick.missed = 1));
    assert_eq!(verdict("battery", |_| {}), Verdict::ForTheUser);
    assert!(complains("battery", |d| d.battery_v = 0.0));
    assert!(complains("radio-off", |_| {}));
    assert!(!complains("radio-off", |d| d.safety.flags = SafetyFlags::REMOTE_LOST));
    assert!(!complains("joints-answer", |_| {}));
    assert!(complains("joints-answer", |d| {
        d.sensors.motor.joints[2].state = JointState::Silent;
    }));
    assert!(complains("joints-answer", |d| {
        d.sensors.motor.joints[1].reports_enabled = true;
    }));
    assert!(complains("joints-answer", |d| d.sensors.motor.joints[3]
        .age_us = 30_000));
    let lies =
        |accel: [f32; 3]| move |d: &mut DiagnosticsSnapshot| d.sensors.imu.accel_mps2 = accel;
    for (id, accel) in [
        ("imu-flat", [0.0, 0.0, 9.8]),
        ("imu-upside-down", [0.0, 0.0, -9.8]),
        ("imu-nose-up", [9.8, 0.0, 0.0]),
        ("imu-left-up", [0.0, 9.8, 0.0]),
    ] {
        assert!(!complains(id, lies(accel)), "{id}");
        assert!(complains(id, lies(accel.map(|axis| -axis))), "{id}");
        let [x, y, z] = accel;
        assert!(complains(id, lies([y, z, x])), "{id}");
    }
    assert!(!complains("gyro-left", |_| {}));
    assert!(complains("gyro-left", |d| d.sensors.imu.gyro_dps = [45.0, 0.0, 0.0]));
    assert!(complains("gyro-left", |d| d.sensors.imu.gyro_dps = [0.0, 0.0, -45.0]));
    assert!(!complains("tick-jitter", |d| d.tick.max_jitter_cycles = 840));
    assert!(complains("tick-jitter", |d| d.tick.max_jitter_cycles = 841));
    assert!(complains("tick-jitter", |_| {}));
}

/// docs/first-board.md has the same checks as the tool.
#[test]
fn the_document_has_the_same_checks() {
    let mut expected = String::new();
    for (number, check) in (1..).zip(&CHECKS) {
        expected.push_str(&format!("### {number}. {}\n\n", check.title));
        for (what, words) in [
            ("Connect", check.connect),
            ("Do", check.act),
            ("Must be seen", check.see),
            ("Note", check.note),
        ] {
            if !words.is_empty() {
                expected.push_str(&format!("- **{what}:** {words}\n"));
            }
        }
        expected.push('\n');
    }
    let document = include_str!("../../../../docs/first-board.md");
    let (_, list) = document.split_once("## The checks\n\n").unwrap();
    let (list, _) = list.split_once("\n## ").unwrap_or((list, ""));
    assert!(list.trim() == expected.trim(), "expected:\n{expected}");
}
