//! `policy run` lets the policy of the tree drive the shipped image over the PC link: the robot gets up from the ground, balances,
//! follows commands, and gets down.
//!
//! Board and program wait for each other, so nothing here depends on the speed of the computer.

mod support;

use std::{
    env, fs,
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::mpsc::{self, Receiver},
    thread,
    time::Duration,
};

use robot_plant::time::{self, MS, Ps, SECOND};
use robot_sim::{
    machine::LogLine,
    runner::Observer,
    scenario::Scenario,
    signals::{SignalTable, Values},
};

/// For so long in s the policy drives, unless `ROBOT_POLICY_SECONDS` names a time. Each command lasts a fourth of it.
const SECONDS: f64 = 12.0;
/// Forward in m/s and turn to the left in rad/s.
const COMMANDS: [[f64; 2]; 4] = [[0.0, 0.0], [0.5, 0.0], [0.0, 1.0], [-0.3, 0.0]];
/// A new command is obeyed after this time in s: the first has the robot stand up.
const SETTLED_S: f64 = 1.5;
/// The robot waits for its pilot, and gets up before the policy drives.
const BEFORE: Ps = 9 * SECOND;
/// It folds its legs in 2 s, gets down in 2 s, and rests.
const AFTER: Ps = 6 * SECOND;
/// Time in s in which it folds its legs and balances.
const FOLDS_S: f64 = 1.9;
/// Greatest height and lean of a robot that balances with folded legs.
const FOLDED_M: f64 = 0.18;
const FOLDED_RAD: f64 = 0.3;
/// It tips over no faster than this, onto its nose or tail. With its legs stretched it falls on its back.
const TIPS_RPS: f64 = 8.0;

/// Root mean square of the difference to the commands over all of them. The first is what is wanted of a policy.
const SPEED_MPS: f64 = 0.15;
const TURN_RPS: f64 = 0.15;
/// A robot that stands, and one that lies.
const STANDS_M: f64 = 0.2;
const LEANS_RAD: f64 = 0.6;

const PATIENCE: Duration = Duration::from_secs(120);

fn policy_program() -> Option<PathBuf> {
    let test = env::current_exe().expect("a test has a file");
    // `cargo test` puts programs into the folder above that of the tests.
    let program = test.parent()?.parent()?.join("policy");
    if !program.is_file() {
        println!(
            "skipped: no {}: `cargo build -p robot-policy --profile host --target host-tuple` makes it",
            program.display()
        );
        return None;
    }
    Some(program)
}

fn seconds() -> f64 {
    let asked = env::var("ROBOT_POLICY_SECONDS").ok();
    asked.map_or(SECONDS, |text| text.parse().expect("a number of seconds"))
}

/// The policies of the tree in a folder of its own, with one text in base.yaml replaced.
fn policies(name: &str, change: [&str; 2]) -> PathBuf {
    let from = robot_test_support::repository().join("policy/fivebar");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(folder.join("fivebar/flat")).expect("a folder");
    let base = fs::read_to_string(from.join("base.yaml")).expect("it is in the tree");
    assert!(base.contains(change[0]), "{base}");
    let base = base.replacen(change[0], change[1], 1);
    fs::write(folder.join("fivebar/base.yaml"), base).expect("a file");
    for file in ["flat/config.yaml", "flat/policy.onnx"] {
        fs::copy(from.join(file), folder.join("fivebar").join(file)).expect("a copy");
    }
    folder
}

/// Times differ with the length of the run.
fn without_figures(line: &str) -> String {
    line.chars().filter(|it| !it.is_ascii_digit()).collect()
}

/// What docs/bring-your-own-policy.md shows from the line on that starts so.
fn shown(start: &str) -> Vec<String> {
    let page = robot_test_support::repository().join("docs/bring-your-own-policy.md");
    let page = fs::read_to_string(page).expect("a page");
    let from = page.lines().skip_while(|it| !it.starts_with(start));
    let lines = from.take_while(|it| *it != "```").map(without_figures);
    lines.collect()
}

/// The program, and the lines that it prints.
struct Program {
    child: Child,
    lines: Receiver<String>,
    said: Vec<String>,
}

impl Program {
    fn start(mut command: Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).spawn().expect("it starts");
        let output = child.stdout.take().expect("its output is piped");
        let (sender, lines) = mpsc::channel();
        thread::spawn(move || {
            let lines = BufReader::new(output).lines().map_while(Result::ok);
            lines.for_each(|line| sender.send(line).unwrap_or_default());
        });
        Self {
            child,
            lines,
            said: Vec::new(),
        }
    }

    /// Takes what it has printed.
    fn listen(&mut self) {
        self.said.extend(self.lines.try_iter());
    }

    fn has_said(&self, start: &str) -> bool {
        self.said.iter().any(|line| line.starts_with(start))
    }

    fn wait_for(&mut self, start: &str) {
        while !self.has_said(start) {
            let line = self.lines.recv_timeout(PATIENCE);
            let line = line.unwrap_or_else(|_| panic!("never {start:?}: {:?}", self.said));
            self.said.push(line);
        }
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // It has ended, or a check has failed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What the robot really does.
#[derive(Clone, Copy, Debug)]
struct Sample {
    at: Ps,
    height_m: f64,
    lean_rad: f64,
    forward_mps: f64,
    turn_rps: f64,
    /// Largest current of a wheel and torque of a joint.
    current_ma: f64,
    torque_nm: f64,
}

struct Run {
    command: Option<Command>,
    program: Option<Program>,
    /// When the policy took over, and when it ended.
    drives: Option<Ps>,
    ended: Option<Ps>,
    samples: Vec<Sample>,
}

impl Observer for Run {
    fn sample(&mut self, at: Ps, table: &SignalTable, values: &Values) {
        let value = |name: &str| values[table.index(name).expect(name)].expect(name);
        let most = |count, name: fn(usize) -> String| {
            let magnitudes = (0..count).map(|n| value(&name(n)).abs());
            magnitudes.fold(0.0, f64::max)
        };
        self.samples.push(Sample {
            at,
            height_m: value("truth.body.z"),
            lean_rad: value("truth.body.roll")
                .abs()
                .max(value("truth.body.pitch").abs()),
            forward_mps: value("truth.body.vx"),
            turn_rps: value("truth.body.wz"),
            current_ma: most(2, |n| format!("can.m3508.{n}.current_ma")),
            torque_nm: most(4, |n| format!("can.joint.{n}.torque_nm")),
        });
        let program = self.program.as_mut().expect("it has been started");
        if at == 500 * MS {
            // States wait for it. From its first command on, the board waits for it in turn.
            program.wait_for("the robot is heard");
        }
        program.listen();
        if program.has_said("the policy drives") {
            self.drives.get_or_insert(at);
        }
        if program.has_said("ended by") {
            self.ended.get_or_insert(at);
        }
    }

    fn log(&mut self, _: &LogLine) {}

    fn link_port(&mut self, device: &Path) {
        let mut command = self.command.take().expect("there is one link");
        command.arg("--link").arg(device);
        let program = self.program.insert(Program::start(command));
        program.wait_for("in lockstep");
    }

    fn ends_run(&self) -> bool {
        let now = self.samples.last().map_or(0, |sample| sample.at);
        self.ended.is_some_and(|ended| now > ended + SECOND)
    }
}

/// Lets the policy drive for so long in s, four commands after each other.
fn run(program: &Path, policies: &Path, seconds: f64) -> Run {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let file = folder.join(format!("policy-run-{seconds}.txt"));
    let lines = COMMANDS.iter().enumerate().map(|(n, [forward, turn])| {
        let at_s = n as f64 * seconds / COMMANDS.len() as f64;
        format!("{at_s} {forward} 0 {turn}\n")
    });
    fs::write(&file, lines.collect::<String>()).expect("a file");
    let mut command = Command::new(program);
    command
        .current_dir(robot_test_support::repository())
        .args([
            "run",
            "--robot",
            "fivebar",
            "--config",
            "flat",
            "--lockstep",
        ])
        .arg("--policies")
        .arg(policies)
        .args(["--commands", "file", "--file"])
        .arg(&file)
        .arg("--seconds")
        .arg(seconds.to_string());
    let pilot = robot_test_support::repository().join("scenarios/policy-pilot.toml");
    let mut job = support::job(Scenario::read(&pilot).expect("a scenario"));
    job.scenario.length = BEFORE + time::from_seconds(seconds) + AFTER;
    job.pc.link_on_pty = true;
    job.pc.lockstep = true;
    let mut run = Run {
        command: Some(command),
        program: None,
        drives: None,
        ended: None,
        samples: Vec::new(),
    };
    let outcome = job.run(&mut [&mut run]).expect("the machine starts");
    assert!(
        outcome.summary.ok,
        "{:?} {:?}",
        outcome.summary.board_errors, outcome.summary.failed_expectations
    );
    assert_eq!(outcome.summary.control.missed, 0);
    run
}

impl Run {
    /// Samples while the policy drove, with the time in s since it took over.
    fn driven(&self, seconds: f64) -> impl Iterator<Item = (f64, &Sample)> {
        let from = self.drives.expect("the policy drives");
        let samples = self.samples.iter().filter(move |it| it.at >= from);
        let timed = samples.map(move |it| (time::to_seconds(it.at - from), it));
        timed.take_while(move |(time_s, _)| *time_s < seconds)
    }

    /// Root mean square of the differences to the commands, once they are obeyed: of speed in m/s, of turn rate in rad/s.
    fn errors(&self, seconds: f64) -> [f64; 2] {
        let each_s = seconds / COMMANDS.len() as f64;
        let mut sums = [0.0; 2];
        let mut count = 0.0;
        for (time_s, sample) in self.driven(seconds) {
            if time_s % each_s < SETTLED_S {
                continue;
            }
            let [forward_mps, turn_rps] = COMMANDS[(time_s / each_s) as usize];
            sums[0] += (sample.forward_mps - forward_mps).powi(2);
            sums[1] += (sample.turn_rps - turn_rps).powi(2);
            count += 1.0;
        }
        sums.map(|sum| f64::sqrt(sum / count))
    }
}

#[test]
fn the_policy_of_the_tree_gets_the_robot_up_and_drives_it() {
    let Some(program) = policy_program() else {
        return;
    };
    let seconds = seconds();
    let run = run(
        &program,
        &robot_test_support::repository().join("policy"),
        seconds,
    );
    let said = &run.program.as_ref().expect("it ran").said;
    assert!(
        said.iter().any(|it| it.starts_with("ended by time-over")),
        "{said:?}"
    );
    assert!(said.iter().any(|it| it.contains("; 0 missed")), "{said:?}");
    assert!(
        !said.iter().any(|it| it.starts_with("note:")),
        "the current is set as the policy needs it: {said:?}"
    );

    let standing = run.driven(seconds).filter(|(at_s, _)| *at_s > SETTLED_S);
    for (at_s, sample) in standing {
        assert!(
            sample.height_m > STANDS_M && sample.lean_rad < LEANS_RAD,
            "{at_s} {sample:?}"
        );
    }
    let shown = shown("in lockstep");
    assert!(shown.len() > 8, "{shown:?}");
    for line in shown {
        assert!(
            said.iter().any(|it| without_figures(it) == line),
            "docs/bring-your-own-policy.md shows {line:?}: {said:?}"
        );
    }
    let [speed_mps, turn_rps] = run.errors(seconds);
    println!("off by {speed_mps:.3} m/s and {turn_rps:.3} rad/s rms in {seconds} s");
    assert!(speed_mps < SPEED_MPS, "{speed_mps}");
    assert!(turn_rps < TURN_RPS, "{turn_rps}");

    let folding = run.driven(seconds + FOLDS_S);
    let folding: Vec<_> = folding.filter(|(at_s, _)| *at_s > seconds).collect();
    assert!(folding.iter().all(|(_, it)| it.lean_rad < FOLDED_RAD));
    let (_, folded) = folding.last().expect("samples");
    assert!(folded.height_m < FOLDED_M, "{folded:?}");
    let leans: Vec<_> = run
        .driven(f64::INFINITY)
        .filter(|(at_s, _)| *at_s > seconds)
        .map(|(_, it)| it)
        .collect();
    let rates = leans.windows(2).map(|pair| {
        (pair[1].lean_rad - pair[0].lean_rad) / time::to_seconds(pair[1].at - pair[0].at)
    });
    let fastest_rps = rates.fold(0.0, f64::max);
    let most_rad = leans.iter().map(|it| it.lean_rad).fold(0.0, f64::max);
    println!("tips over with {fastest_rps:.1} rad/s, to {most_rad:.2} rad");
    assert!(fastest_rps < TIPS_RPS, "{fastest_rps}");

    let last = run.samples.last().expect("samples");
    assert!(
        last.current_ma == 0.0 && last.torque_nm < 0.01,
        "an MIT frame has no code for zero torque: {last:?}"
    );
}

#[test]
fn a_wheel_that_counts_the_other_way_round_ends_the_run() {
    let Some(program) = policy_program() else {
        return;
    };
    let reversed = [
        "  wheel_indices:",
        "  joint_directions: [1, 1, 1, 1, -1, 1]\n  wheel_indices:",
    ];
    let run = run(&program, &policies("wheel-reversed", reversed), 4.0);
    let said = &run.program.as_ref().expect("it ran").said;
    let end = said.iter().find(|it| it.starts_with("ended by"));
    let end = end.unwrap_or_else(|| panic!("it ends: {said:?}"));
    assert!(end.starts_with("ended by joint-torque"), "{said:?}");
    assert_eq!([without_figures(end)], *shown("ended by joint-torque"));
}
