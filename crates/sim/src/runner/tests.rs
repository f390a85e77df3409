//! The runner with a minimal board, whose wheel current follows the stick.

use robot_plant::time::{MS, US};

use super::*;
use crate::{
    machine::{MachineError, Progress, diagnostics::meaning::Meaning},
    scenario::Event,
};

/// Current 100 mA from the moment the switch goes on; one command frame 300 µs past each millisecond.
#[derive(Default)]
struct FakeBoard {
    now: Ps,
    current_ma: f64,
    events: Vec<WireEvent>,
    stop_at: Option<Ps>,
    errors: Vec<BoardError>,
    suspicions: Vec<BoardError>,
    acted: Vec<(Ps, Event)>,
}

impl Simulation for FakeBoard {
    fn run_until(&mut self, until: Ps) -> Result<(), MachineError> {
        assert!(until > self.now, "time goes forward");
        if self.stop_at.is_some_and(|t| t <= until) {
            return Err(MachineError::Stopped("no such register".into()));
        }
        let frame = self.now / MS * MS + 300 * US;
        if (self.now..until).contains(&frame) {
            self.events.push(WireEvent {
                at: frame,
                signal: 0,
                value: self.current_ma,
            });
        }
        self.now = until;
        Ok(())
    }

    fn apply(&mut self, event: &Event) -> Result<(), EventError> {
        if let Event::Remote(input) = event {
            self.current_ma = if input.enable == Some(true) {
                100.0
            } else {
                0.0
            };
        }
        self.acted.push((self.now, event.clone()));
        Ok(())
    }

    fn serve(&mut self, _: &mut PcPorts) -> std::io::Result<()> {
        Ok(())
    }

    fn world_names(&mut self) -> Vec<String> {
        vec!["can.current_ma".into()]
    }

    fn sample_world(&mut self, out: &mut Vec<f64>) {
        out.push(self.current_ma);
    }

    fn drain_wire_events(&mut self, out: &mut Vec<WireEvent>) {
        out.append(&mut self.events);
    }

    fn diag_names(&mut self) -> Vec<String> {
        vec!["diag.safety.flags".into()]
    }

    /// A board that runs from 2 ms on and hangs from 10 ms on.
    fn sample_diag(&mut self, out: &mut Vec<f64>) -> bool {
        out.clear();
        out.push(if self.now < 5 * MS { 2.0 } else { 4.0 });
        (2 * MS..10 * MS).contains(&self.now)
    }

    fn attitude_error_deg(&mut self, _: [f64; 4]) -> Option<[f64; 3]> {
        None
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        Vec::new()
    }

    fn progress(&mut self) -> Progress {
        Progress::default()
    }

    fn stats(&mut self) -> Stats {
        Stats::default()
    }

    fn diag_meanings(&mut self) -> Vec<Option<Meaning>> {
        let names = [(1, "late".to_owned()), (2, "lost".to_owned())];
        vec![Some(Meaning::Flags(names.into()))]
    }

    fn resets(&mut self) -> usize {
        0
    }

    fn board_errors(&mut self) -> Vec<BoardError> {
        self.errors.clone()
    }

    fn suspicions(&mut self) -> Vec<BoardError> {
        self.suspicions.clone()
    }
}

fn run_double(board: &mut FakeBoard, body: &str) -> RunResult {
    let text = format!("name = \"n\"\nseconds = 0.05\nplant = \"stand\"\n{body}");
    let scenario = Scenario::parse(&text, "t.toml").unwrap();
    run(board, &scenario, &mut PcPorts::default(), &mut []).unwrap()
}

const PULSE: &str = "
    [[at]]
    t = 0.0102
    remote = { enable = true }
    [[at]]
    t = 0.0104
    remote = { enable = false }
";

#[test]
fn events_are_applied_at_their_time_and_in_order() {
    let mut board = FakeBoard::default();
    run_double(&mut board, PULSE);
    let times: Vec<Ps> = board.acted.iter().map(|(t, _)| *t).collect();
    assert_eq!(times, [10_200 * US, 10_400 * US]);
}

#[test]
fn a_pulse_between_two_samples_is_judged_by_its_frame() {
    let expect = "
        [[expect]]
        signal = \"can.current_ma\"
        from = 0.0
        to = 0.05
        max_abs = 0.0
    ";
    let result = run_double(&mut FakeBoard::default(), &format!("{PULSE}{expect}"));
    assert!(!result.ok());
    let seen = result.verdicts[0].decisive.unwrap();
    assert_eq!((seen.at, seen.value), (10_300 * US, 100.0));
    assert!(run_double(&mut FakeBoard::default(), expect).ok());
}

/// A user who ends the run at that time, and the time of the last sample.
struct Impatient {
    ends_at: Ps,
    last: Ps,
}

impl Observer for Impatient {
    fn sample(&mut self, at: Ps, _: &SignalTable, _: &Values) {
        self.last = at;
    }

    fn log(&mut self, _: &LogLine) {}

    fn ends_run(&self) -> bool {
        self.last >= self.ends_at
    }
}

#[test]
fn a_run_that_the_user_ends_is_judged_up_to_there() {
    let until = |to: f64, bound: &str| {
        format!("[[expect]]\nsignal = \"can.current_ma\"\nfrom = 0.0\nto = {to}\n{bound}\n")
    };
    let ended = |bound: &str| {
        let body = until(0.01, bound) + &until(0.05, "min = 1000.0");
        let text = format!("name = \"n\"\nseconds = 0.05\nplant = \"stand\"\n{body}");
        let scenario = Scenario::parse(&text, "t.toml").unwrap();
        let mut user = Impatient {
            ends_at: 19 * MS,
            last: 0,
        };
        let ports = &mut PcPorts::default();
        let result = run(
            &mut FakeBoard::default(),
            &scenario,
            ports,
            &mut [&mut user],
        );
        result.unwrap()
    };
    let result = ended("max_abs = 0.0");
    assert!(result.ok());
    let left = (result.ran, result.verdicts.len(), result.left_out);
    assert_eq!(left, (20 * MS, 1, 1));
    assert!(!ended("min = 1000.0").ok(), "what was judged before counts");
}

#[test]
fn diagnostics_that_are_not_there_or_stale_never_pass() {
    let expect = |from: f64, to: f64| {
        format!("[[expect]]\nsignal = \"diag.safety.flags\"\nfrom = {from}\nto = {to}\nmax = 4\n")
    };
    let ok = |from, to| run_double(&mut FakeBoard::default(), &expect(from, to)).ok();
    assert!(ok(0.0, 0.01));
    assert!(!ok(0.0, 0.001), "before the firmware is up");
    assert!(!ok(0.04, 0.05), "long after it hung");
}

#[test]
fn safety_flags_are_gathered_over_the_run() {
    let result = run_double(&mut FakeBoard::default(), "");
    assert_eq!(result.safety_flags_seen, 0b110);
}

#[test]
fn flags_are_judged_by_their_names() {
    let judged = |flag: &str| {
        let expect = format!(
            "[[expect]]\nsignal = \"diag.safety.flags\"\nfrom = 0.006\nto = 0.009\n{flag}\n"
        );
        let result = run_double(&mut FakeBoard::default(), &expect);
        (result.ok(), result.verdicts[0].clone())
    };
    assert!(judged("has_flag = \"lost\"").0);
    assert!(judged("lacks_flag = \"late\"").0);
    assert!(!judged("has_flag = \"late\"").0);
    let (ok, verdict) = judged("has_flag = \"later\"");
    let why = verdict.failure.unwrap_or_default();
    assert!(!ok && why.contains("late, lost"), "{why}");
}

#[test]
fn an_unknown_signal_fails_and_suggests() {
    let body = "[[expect]]\nsignal = \"can.curent_ma\"\nat = 0.01\nmax = 1\n";
    let result = run_double(&mut FakeBoard::default(), body);
    let why = result.verdicts[0].failure.clone().unwrap();
    assert!(why.contains("did you mean `can.current_ma`"), "{why}");
}

#[test]
fn a_stopped_machine_fails_the_run_and_open_windows() {
    let mut board = FakeBoard {
        stop_at: Some(20 * MS),
        ..FakeBoard::default()
    };
    let body = "[[expect]]\nsignal = \"can.current_ma\"\nfrom = 0\nto = 0.05\nmax_abs = 0\n";
    let result = run_double(&mut board, body);
    assert_eq!(result.stopped.as_deref(), Some("no such register"));
    assert!(
        result.verdicts[0]
            .failure
            .as_ref()
            .unwrap()
            .contains("run ended")
    );
    assert_eq!(result.ran, 19 * MS);
}

fn board_error() -> BoardError {
    BoardError {
        at: MS,
        count: 1,
        message: "CAN1: bit timing gives 500 kb/s".into(),
    }
}

#[test]
fn suspicions_are_kept_and_fail_nothing() {
    let mut board = FakeBoard {
        suspicions: vec![board_error()],
        ..FakeBoard::default()
    };
    let result = run_double(&mut board, "");
    assert!(result.ok());
    assert_eq!(result.suspicions, [board_error()]);
}

#[test]
fn board_errors_fail_unless_allowed() {
    let mut board = FakeBoard {
        errors: vec![board_error()],
        ..FakeBoard::default()
    };
    assert!(!run_double(&mut board, "").ok());
    let allowed = run_double(
        &mut FakeBoard {
            errors: board.errors,
            ..FakeBoard::default()
        },
        "allow_board_errors = [\"bit timing\"]",
    );
    assert!(allowed.ok());
    assert_eq!(allowed.allowed_board_errors.len(), 1);
}
