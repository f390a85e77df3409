//! `summary.json`: the run in numbers. Same ELF, scenario and seed give the same bytes up to `wall_seconds`.

use std::{collections::BTreeMap, time::Duration};

use robot_plant::time;
use serde::Serialize;
use serde_json::Value;

use super::{
    budgets::{self, Budget},
    expectation::Verdict,
    runner::RunResult,
    scenario::Scenario,
    tree::Tree,
};
use crate::{
    can_port::PortStats,
    machine::{CanStats, Distribution, FlashUse, LongestGapUs},
    pty::LinkStats,
};
use robot_emulator::soc::board_errors::BoardError;

#[derive(Debug, Serialize)]
pub struct Summary {
    pub scenario: String,
    pub seed: u64,
    pub ok: bool,
    pub failed_expectations: Vec<FailedExpectation>,
    /// Bounds judged, failed ones included.
    pub expectations: usize,
    /// Why the machine stopped before the end.
    pub stopped: Option<String>,
    /// Board errors that fail on silicon, and so have failed the run.
    pub board_errors: Vec<BoardErrorEntry>,
    pub allowed_board_errors: Vec<BoardErrorEntry>,
    /// Suspicious only.
    pub suspicions: Vec<BoardErrorEntry>,
    /// A PC took part: the same image, scenario and seed need not give the same run again.
    pub external_input: bool,
    pub reproducible: bool,
    /// Frames exchanged with a PC, by bus: `can1`, `can2`.
    pub can_ports: BTreeMap<String, PortStats>,
    /// Bytes exchanged with a PC over its link.
    pub link_port: Option<LinkStats>,
    pub sim_seconds: f64,
    pub control: Control,
    /// Busy share of the CPU, 0 … 1.
    pub cpu_load: f64,
    /// Share of all instructions by context, 0 … 1.
    pub executors: BTreeMap<String, f64>,
    pub can: Vec<CanStats>,
    pub flash: FlashUse,
    pub stack_peak_bytes: u64,
    pub resets: Vec<String>,
    /// Flags of `diag.safety.flags` that were set at some time, by name; `bit n` for one without a name.
    pub safety_flags_seen: Vec<String>,
    /// Error against the plant's truth or the recording's reference. Absent if nothing could be scored.
    pub attitude_error: Option<AttitudeError>,
    pub budgets: Vec<Budget>,
    #[serde(rename = "final")]
    pub last: Final,
    #[serde(flatten)]
    pub wall: Wall,
}

#[derive(Debug, Serialize)]
pub struct FailedExpectation {
    pub signal: String,
    pub expected: String,
    pub from: f64,
    pub to: f64,
    /// The value that decided, and when.
    pub measured: Option<f64>,
    pub at: Option<f64>,
    pub why: String,
    pub because: Option<String>,
}

#[derive(Debug, Serialize)]
pub struct BoardErrorEntry {
    pub at: f64,
    pub count: u64,
    pub message: String,
}

#[derive(Debug, Serialize)]
pub struct Control {
    pub ticks: u64,
    pub missed: u64,
    pub longest_gap_us: LongestGapUs,
    pub instructions: Distribution,
    pub release_jitter_us: Distribution,
}

/// Root mean square, degrees.
#[derive(Debug, Serialize)]
pub struct AttitudeError {
    pub samples: u64,
    pub total_rmse_deg: f64,
    pub heading_rmse_deg: f64,
    pub inclination_rmse_deg: f64,
}

#[derive(Debug, Serialize)]
pub struct Final {
    /// `diag.estimate.*`, null while the firmware has none.
    pub estimate: Value,
    /// `truth.wheel.*`.
    pub wheels: Value,
    /// `truth.joint.*`: null for plants without legs.
    pub joints: Value,
}

/// Figures that depend on the computer on which the run was made.
#[derive(Debug, Serialize)]
pub struct Wall {
    pub wall_seconds: f64,
    pub realtime_factor: f64,
}

impl Summary {
    /// Pretty-printed, with a final newline.
    pub fn to_json(&self) -> String {
        let json = serde_json::to_string_pretty(self).unwrap_or_default();
        json + "\n"
    }

    pub fn new(scenario: &Scenario, result: &RunResult, wall: Duration) -> Self {
        let stats = &result.stats;
        let external_input = !result.ports.is_empty() || result.link.is_some();
        let sim_seconds = time::to_seconds(result.ran);
        let wall_seconds = wall.as_secs_f64();
        Self {
            scenario: scenario.name.clone(),
            seed: scenario.seed,
            ok: result.ok(),
            failed_expectations: failed(&result.verdicts),
            expectations: result.verdicts.len(),
            stopped: result.stopped.clone(),
            board_errors: entries(&result.board_errors),
            allowed_board_errors: entries(&result.allowed_board_errors),
            suspicions: entries(&result.suspicions),
            external_input,
            reproducible: !external_input,
            can_ports: can_ports(result),
            link_port: result.link,
            sim_seconds,
            control: Control {
                ticks: stats.ticks,
                missed: stats.missed,
                longest_gap_us: stats.longest_gap_us,
                instructions: stats.tick_instructions.clone(),
                release_jitter_us: stats.release_jitter_us.clone(),
            },
            cpu_load: stats.cpu_load,
            executors: stats.executors.clone(),
            can: stats.can.clone(),
            flash: stats.flash.clone(),
            stack_peak_bytes: stats.stack_peak_bytes,
            resets: stats.resets.clone(),
            safety_flags_seen: flags_seen(result),
            attitude_error: attitude_error(result),
            budgets: budgets::image_budgets(result),
            last: Final {
                estimate: subtree(result, "diag.estimate."),
                wheels: subtree(result, "truth.wheel."),
                joints: subtree(result, "truth.joint."),
            },
            wall: Wall {
                wall_seconds,
                realtime_factor: sim_seconds / wall_seconds.max(1e-9),
            },
        }
    }
}

fn failed(verdicts: &[Verdict]) -> Vec<FailedExpectation> {
    let broken = verdicts
        .iter()
        .filter_map(|v| Some((v, v.failure.as_ref()?)));
    broken
        .map(|(verdict, why)| FailedExpectation {
            signal: verdict.signal.clone(),
            expected: verdict.expected.clone(),
            from: time::to_seconds(verdict.window.start),
            to: time::to_seconds(verdict.window.end),
            measured: verdict.decisive.map(|r| r.value),
            at: verdict.decisive.map(|r| time::to_seconds(r.at)),
            why: why.clone(),
            because: verdict.because.clone(),
        })
        .collect()
}

fn entries(errors: &[BoardError]) -> Vec<BoardErrorEntry> {
    errors
        .iter()
        .map(|e| BoardErrorEntry {
            at: time::to_seconds(e.at),
            count: e.count,
            message: e.message.clone(),
        })
        .collect()
}

fn can_ports(result: &RunResult) -> BTreeMap<String, PortStats> {
    let named = result.ports.iter().map(|(bus, stats)| {
        let name = format!("{bus:?}").to_lowercase();
        (name, *stats)
    });
    named.collect()
}

fn attitude_error(result: &RunResult) -> Option<AttitudeError> {
    let [total, heading, inclination] = result.attitude.rmse_deg()?;
    Some(AttitudeError {
        samples: result.attitude.samples(),
        total_rmse_deg: total,
        heading_rmse_deg: heading,
        inclination_rmse_deg: inclination,
    })
}

fn flags_seen(result: &RunResult) -> Vec<String> {
    let place = result.table.index("diag.safety.flags");
    let meaning = place.and_then(|place| result.table.meaning(place));
    let name = |bit| meaning.and_then(|m| m.bit(bit)).map(str::to_owned);
    (0..64)
        .filter(|bit| result.safety_flags_seen >> bit & 1 == 1)
        .map(|bit| name(bit).unwrap_or_else(|| format!("bit {bit}")))
        .collect()
}

fn subtree(result: &RunResult, prefix: &str) -> Value {
    let names = result.table.names().iter().enumerate();
    let inside = names.filter_map(|(place, name)| Some((name.strip_prefix(prefix)?, place)));
    let tree = Tree::new(inside);
    if !tree.has_value(&result.last_values) {
        return Value::Null;
    }
    // Numbers and string keys: nothing that JSON refuses.
    serde_json::to_value(tree.with(&result.last_values)).unwrap_or_default()
}
