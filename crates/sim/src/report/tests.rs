//! A report over a board whose signals are plain functions of time.

use std::time::Duration;

use robot_plant::{
    time::{self, Ps},
    world::WireEvent,
};

use super::*;
use crate::{
    faults::EventError,
    machine::{CanStats, LogLine, MachineError, Progress, Stats},
    pc::PcPorts,
    runner,
    scenario::{Event, Scenario},
    simulation::Simulation,
    summary::Summary,
    trace::Traces,
};
use robot_emulator::soc::board_errors::BoardError;

const WORLD: [&str; 12] = [
    "radio.vx",
    "radio.wz",
    "radio.enable",
    "truth.wheel.0.speed_mps",
    "truth.wheel.1.speed_mps",
    "can.m3508.0.current_ma",
    "truth.attitude.w",
    "truth.attitude.x",
    "truth.attitude.y",
    "truth.attitude.z",
    "truth.body.x",
    "truth.body.y",
];
const DIAG: [&str; 7] = [
    "diag.arming.state",
    "diag.safety.flags",
    "diag.estimate.q_wxyz.0",
    "diag.estimate.q_wxyz.1",
    "diag.estimate.q_wxyz.2",
    "diag.estimate.q_wxyz.3",
    "diag.estimate.valid",
];

#[derive(Default)]
struct Waves {
    now: Ps,
}

impl Waves {
    fn t(&self) -> f64 {
        time::to_seconds(self.now)
    }
}

impl Simulation for Waves {
    fn run_until(&mut self, until: Ps) -> Result<(), MachineError> {
        self.now = until;
        Ok(())
    }
    fn apply(&mut self, _: &Event) -> Result<(), EventError> {
        Ok(())
    }
    fn serve(&mut self, _: &mut PcPorts) -> std::io::Result<()> {
        Ok(())
    }

    fn world_names(&mut self) -> Vec<String> {
        WORLD.map(String::from).to_vec()
    }
    fn sample_world(&mut self, out: &mut Vec<f64>) {
        let t = self.t();
        let (s, c) = (t.sin(), t.cos());
        let on = f64::from(t > 2.5);
        out.extend([
            0.4 * on,
            0.2 * s,
            on,
            0.6 * on,
            0.5 * on * c,
            4000.0 * s * on,
        ]);
        out.extend([(0.5 * t).cos(), 0.0, 0.0, (0.5 * t).sin(), s, 1.0 - c]);
    }
    fn drain_wire_events(&mut self, _: &mut Vec<WireEvent>) {}
    fn diag_names(&mut self) -> Vec<String> {
        DIAG.map(String::from).to_vec()
    }
    fn sample_diag(&mut self, out: &mut Vec<f64>) -> bool {
        let t = self.t();
        out.clear();
        out.extend([
            f64::from(t > 2.6) + f64::from(t > 1.0),
            f64::from(t > 7.0) * 5.0,
        ]);
        out.extend([(0.49 * t).cos(), 0.0, 0.0, (0.49 * t).sin(), 1.0]);
        t > 0.5
    }
    fn attitude_error_deg(&mut self, _: [f64; 4]) -> Option<[f64; 3]> {
        Some([2.0 * self.t(), 1.5 * self.t(), 0.3])
    }
    fn take_log(&mut self) -> Vec<LogLine> {
        let due = self.now.is_multiple_of(time::SECOND);
        let line = LogLine {
            at: self.now,
            level: "info".into(),
            text: "a < b & c".into(),
        };
        due.then_some(line).into_iter().collect()
    }
    fn diag_meanings(&mut self) -> Vec<Option<crate::machine::diagnostics::meaning::Meaning>> {
        Vec::new()
    }

    fn resets(&mut self) -> usize {
        0
    }

    /// Words are programmed at 5 s, and nothing is ever erased.
    fn progress(&mut self) -> Progress {
        Progress {
            flash_programs: if self.t() < 5.0 { 0 } else { 24 },
            ..Progress::default()
        }
    }

    fn stats(&mut self) -> Stats {
        Stats {
            ticks: 10_000,
            jitter_bins: vec![9_000, 900, 90, 0, 3],
            can: vec![
                CanStats {
                    load: 0.3,
                    ..CanStats::default()
                };
                2
            ],
            executors: [("thread".to_owned(), 0.4), ("UART5".to_owned(), 0.6)].into(),
            ..Stats::default()
        }
    }
    fn board_errors(&mut self) -> Vec<BoardError> {
        Vec::new()
    }

    fn suspicions(&mut self) -> Vec<BoardError> {
        vec![BoardError {
            at: time::MS,
            count: 2,
            message: "SCK > 10 MHz".into(),
        }]
    }
}

const SCENARIO: &str = r#"
    name = "waves"
    seconds = 10
    plant = "rolling"
    [[at]]
    t = 2.5
    remote = { enable = true, vx = 0.4 }
    [[expect]]
    signal = "truth.wheel.0.speed_mps"
    from = 3.0
    to = 9.0
    within = [0.6, 0.03]
    because = "the stick asks for it"
    [[expect]]
    signal = "can.m3508.0.current_ma"
    from = 3.0
    to = 9.0
    max_abs = 100
"#;

fn rendered(board: &mut impl Simulation) -> String {
    let scenario = Scenario::parse(SCENARIO, "waves.toml").unwrap();
    let mut traces = Traces::new(scenario.length);
    let result = runner::run(
        board,
        &scenario,
        &mut PcPorts::default(),
        &mut [&mut traces],
    )
    .unwrap();
    let summary = Summary::new(&scenario, &result, Duration::from_secs(1));
    render(&Report {
        scenario: &scenario,
        result: &result,
        summary: &summary,
        traces: &traces,
    })
    .unwrap()
}

#[test]
fn shows_verdict_plots_failures_and_escaped_log() {
    let html = rendered(&mut Waves::default());
    for title in [
        "Sticks",
        "Wheel speed",
        "Commanded current",
        "Path on the ground",
        "Speed over ground",
        "Position",
        "Arming and safety",
        "Attitude",
        "Attitude error",
        "CAN load",
        "Release jitter",
    ] {
        assert!(html.contains(&format!("<h2>{title}")), "no plot {title}");
    }
    assert!(html.contains("settings written") && !html.contains("flash erased"));
    assert!(html.contains("FAIL") && html.contains("1 of 2 expectations held"));
    assert!(html.contains("suspicious at 0.0010 s (2×): SCK &gt; 10 MHz"));
    assert!(html.contains("a &lt; b &amp; c") && !html.contains("a < b"));
    assert_eq!(html.matches("<svg").count(), html.matches("</svg>").count());
}
