//! A Python program that knows only the document drives the shipped image over the PC link, is killed in the middle of a
//! motion and started again.
//!
//! The board waits for the program, so that nothing here depends on the speed of the computer.

mod support;

use std::{
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
    process::{Child, Stdio},
    sync::mpsc::{self, Receiver},
    time::Duration,
};

use robot_plant::time::{MS, Ps};
use robot_sim::{
    machine::LogLine,
    runner::Observer,
    scenario::Scenario,
    signals::{SignalTable, Values},
};
use robot_test_support::Python;

const SCENARIO: &str = r#"
name = "a Python program drives"
seconds = 7.5
plant = "stand"
[[at]]
t = 0.5
remote = { mode = 1 }
[[at]]
t = 2.5
remote = { enable = true }
"#;

/// The program drives from 3 s on, and is killed at 4 s. The second one asks for the same motion, until it rests at 6 s.
const FIRST: [&str; 2] = ["0=0", "3=5"];
const KILLED: Ps = 4_000 * MS;
const STARTED_AGAIN: Ps = 4_900 * MS;
const SECOND: [&str; 3] = ["0=5", "6=0", "6.5=5"];
const RESTS: Ps = 6_000 * MS;
const END: Ps = 7_500 * MS;

/// 100 ms after the last whole frame, and 3 ms to zero on both buses. Samples are a millisecond apart; the fault matrix
/// measures the same time on the wires.
const ALL_ZERO_WITHIN: Ps = 103 * MS;
/// The program may be this far behind the robot, in the robot's seconds.
const BEHIND_S: f64 = 0.02;
const PATIENCE: Duration = Duration::from_secs(60);

/// The program, and the lines that it prints.
struct Program {
    child: Child,
    lines: Receiver<String>,
    /// Time of the last state that it has read.
    read_s: f64,
}

impl Program {
    fn start(python: &Python, device: &Path, timetable: &[&str]) -> Self {
        let here = robot_test_support::repository();
        let mut child = python
            .command(here.join("crates/sim/tests/link_python/timetable.py"))
            .arg(here.join("examples"))
            .arg(device)
            .args(timetable)
            .stdout(Stdio::piped())
            .spawn()
            .expect("Python starts");
        let output = child.stdout.take().expect("its output is piped");
        let (sender, lines) = mpsc::channel();
        std::thread::spawn(move || {
            let lines = BufReader::new(output).lines().map_while(Result::ok);
            lines.for_each(|line| sender.send(line).unwrap_or_default());
        });
        let mut program = Self {
            child,
            lines,
            read_s: 0.0,
        };
        assert_eq!(program.line(), "open");
        program
    }

    fn line(&mut self) -> String {
        let line = self.lines.recv_timeout(PATIENCE);
        line.expect("the program goes on")
    }

    /// Waits until it has read the state of `time_s`, or nearly.
    fn catch_up(&mut self, time_s: f64) {
        while self.read_s < time_s - BEHIND_S {
            self.read_s = self.line().parse().expect("a time in seconds");
        }
    }

    fn kill(mut self) {
        self.child.kill().expect("it runs");
        self.child.wait().expect("it ends");
    }
}

/// One sample.
#[derive(Clone, Copy, Debug)]
struct Sample {
    at: Ps,
    /// Frames of the PC that reached the board.
    frames: f64,
    wheel_rps: f64,
    joint_rad: f64,
    /// Largest magnitude of both currents in mA and all four torques in N·m.
    current_ma: f64,
    torque_nm: f64,
}

struct Run<'a> {
    python: &'a Python,
    device: PathBuf,
    program: Option<Program>,
    samples: Vec<Sample>,
}

impl Observer for Run<'_> {
    fn sample(&mut self, at: Ps, table: &SignalTable, values: &Values) {
        let value = |name: &str| values[table.index(name).expect(name)].expect(name);
        let most = |names: Vec<String>| {
            let magnitudes = names.iter().map(|name| value(name).abs());
            magnitudes.fold(0.0, f64::max)
        };
        self.samples.push(Sample {
            at,
            frames: value("link.down.frames"),
            wheel_rps: value("truth.wheel.0.speed_rps"),
            joint_rad: value("truth.joint.0.pos_rad"),
            current_ma: most(
                (0..2)
                    .map(|n| format!("can.m3508.{n}.current_ma"))
                    .collect(),
            ),
            torque_nm: most((0..4).map(|n| format!("can.joint.{n}.torque_nm")).collect()),
        });
        match at {
            KILLED | END => self.program.take().expect("it runs").kill(),
            STARTED_AGAIN => {
                let again = Program::start(self.python, &self.device, &SECOND);
                self.program = Some(again);
            }
            _ => {}
        }
        // A state that was sent before the program opened the port is lost.
        let heard = at > STARTED_AGAIN + 20 * MS || at < KILLED && at > 500 * MS;
        if let Some(program) = self.program.as_mut().filter(|_| heard) {
            program.catch_up(value("link.up.time_s"));
        }
    }

    fn log(&mut self, _: &LogLine) {}

    fn link_port(&mut self, device: &Path) {
        self.device = device.to_owned();
        self.program = Some(Program::start(self.python, device, &FIRST));
    }
}

fn samples(python: &Python) -> Vec<Sample> {
    let mut job = support::job(Scenario::parse(SCENARIO, "python").expect("it parses"));
    job.pc.link_on_pty = true;
    let mut run = Run {
        python,
        device: PathBuf::new(),
        program: None,
        samples: Vec::new(),
    };
    let outcome = job.run(&mut [&mut run]).expect("the machine starts");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(outcome.summary.control.missed, 0);
    run.samples
}

#[test]
fn a_killed_program_stops_the_robot_and_a_new_one_moves_it_only_from_rest() {
    let Some(python) = Python::with_packages() else {
        return;
    };
    let samples = samples(&python);
    let at = |time: Ps| samples.iter().find(|s| s.at >= time).expect("a sample");

    let before = at(KILLED);
    assert!((4.5..5.1).contains(&before.wheel_rps), "{before:?}");
    assert!((0.15..0.25).contains(&before.joint_rad), "{before:?}");

    let silent = at(STARTED_AGAIN);
    let last = samples.iter().find(|s| s.frames == silent.frames);
    let last = last.expect("the program sent something").at;
    assert!((KILLED - 20 * MS..KILLED + 20 * MS).contains(&last));
    let zero = samples.iter().rfind(|s| s.at < RESTS && is_moved(s));
    let zero = zero.expect("it moved before").at + MS;
    println!(
        "all zero {} ms after the program's last frame",
        (zero - last) / MS
    );
    assert!(zero > last + 90 * MS, "it waits as long as it may");
    assert!(zero <= last + ALL_ZERO_WITHIN, "{}", (zero - last) / MS);

    let asked = at(RESTS).frames - silent.frames;
    assert!(asked > 90.0, "the second program is heard: {asked}");
    let again = samples.last().expect("there are samples");
    assert!((4.5..5.1).contains(&again.wheel_rps), "{again:?}");
    // Friction had kept the legs from falling all the way.
    let lifted_rad = again.joint_rad - at(RESTS + 400 * MS).joint_rad;
    assert!((0.15..0.25).contains(&lifted_rad), "{again:?}");
}

/// An MIT frame has no code for zero torque; the nearest is less than 0.01 N·m.
fn is_moved(sample: &Sample) -> bool {
    sample.current_ma != 0.0 || sample.torque_nm > 0.01
}
