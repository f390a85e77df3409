//! Compares the figures with their limits.

use robot_replay::Figures;
use serde::Serialize;

use crate::{
    image_size::ImageSize,
    measure::{Costs, Measured, Spread},
    scenarios,
    table::{Group, Row},
    work::{FilterResult, Results},
};
use robot_sim::{budgets, summary::Summary};

/// Limits of the shipped image.
const IMAGE_FLASH_BYTES: f64 = 256.0 * 1024.0;
const IMAGE_RAM_BYTES: f64 = 64.0 * 1024.0;
/// Limits of the estimator.
pub const UPDATE_MEAN: f64 = 2_000.0;
pub const UPDATE_MAX: f64 = 3_000.0;
pub const EXTRAPOLATION_MEAN: f64 = 400.0;
pub const ESTIMATOR_FLASH_BYTES: f64 = 12.0 * 1024.0;

#[derive(Debug, Serialize)]
pub struct Report {
    pub ok: bool,
    /// Names of the motions that were the filters' input.
    pub motions: Vec<String>,
    pub groups: Vec<Group>,
    pub runs: Vec<Run>,
}

/// The figures of one filter over one motion, in instructions and degrees.
#[derive(Debug, Serialize)]
pub struct Run {
    filter: &'static str,
    motion: String,
    update_with_mag: Option<Spread>,
    update: Option<Spread>,
    extrapolation: Option<Spread>,
    error_at_samples: Option<Figures>,
    error_at_1_khz: Option<Figures>,
}

impl Report {
    pub fn new(image: Option<ImageSize>, results: &Results, motions: Vec<String>) -> Self {
        let mut groups = Vec::new();
        groups.extend(image.map(image_group));
        if !results.boards.is_empty() {
            groups.push(board_group(&results.boards));
        }
        groups.push(filter_group(&results.filters));
        let mut report = Self {
            ok: true,
            motions,
            groups,
            runs: results.filters.iter().flat_map(runs).collect(),
        };
        let broken = report.broken().count();
        report.ok = broken == 0;
        report
    }

    /// Returns the rows that exceed their limits.
    pub fn broken(&self) -> impl Iterator<Item = (&Group, &Row)> {
        let rows = self
            .groups
            .iter()
            .flat_map(|group| group.rows.iter().map(move |row| (group, row)));
        rows.filter(|(_, row)| !row.broken.is_empty())
    }

    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

fn runs(result: &FilterResult) -> impl Iterator<Item = Run> {
    let filter = result.entry.title();
    result.runs.iter().map(move |run| Run {
        filter,
        motion: run.motion.clone(),
        update_with_mag: Spread::of(&run.costs.update_with_mag),
        update: Spread::of(&run.costs.update),
        extrapolation: Spread::of(&run.costs.extrapolation),
        error_at_samples: run.at_samples,
        error_at_1_khz: run.at_1_khz,
    })
}

fn image_group(size: ImageSize) -> Group {
    let column = ["image".to_owned()];
    let mut group = Group::new("shipped image", column.clone());
    group
        .add("flash", "bytes", vec![Some(size.flash_bytes as f64)])
        .at_most(IMAGE_FLASH_BYTES, &column);
    group
        .add("static RAM", "bytes", vec![Some(size.ram_bytes as f64)])
        .at_most(IMAGE_RAM_BYTES, &column);
    group
}

fn board_group(boards: &[Summary]) -> Group {
    let columns = scenarios::NAMES.map(str::to_owned);
    let mut group = Group::new("emulated board", columns.clone());
    let of = |value: fn(&Summary) -> f64| boards.iter().map(|board| Some(value(board))).collect();
    group
        .add(
            "control tick, mean",
            "instr.",
            of(|b| b.control.instructions.mean),
        )
        .at_most(budgets::TICK_MEAN_INSTRUCTIONS, &columns);
    group.add(
        "control tick, p99",
        "instr.",
        of(|b| b.control.instructions.p99),
    );
    group
        .add(
            "control tick, max",
            "instr.",
            of(|b| b.control.instructions.max),
        )
        .at_most(budgets::TICK_MAX_INSTRUCTIONS, &columns);
    group
        .add(
            "release jitter, p99",
            "µs",
            of(|b| b.control.release_jitter_us.p99),
        )
        .decimals(2);
    group
        .add(
            "release jitter, max",
            "µs",
            of(|b| b.control.release_jitter_us.max),
        )
        .decimals(2)
        .at_most(budgets::RELEASE_JITTER_US, &columns);
    group
        .add("missed ticks", "", of(|b| b.control.missed as f64))
        .at_most(0.0, &columns);
    group
        .add("CPU load", "%", of(|b| b.cpu_load * 100.0))
        .decimals(1)
        .at_most(budgets::CPU_LOAD * 100.0, &columns);
    for (name, bus) in [("CAN1 load", 0), ("CAN2 load", 1)] {
        let load = |board: &Summary| board.can.get(bus).map(|can| can.load * 100.0);
        group
            .add(name, "%", boards.iter().map(load).collect())
            .decimals(1)
            .at_most(budgets::CAN_LOAD * 100.0, &columns);
    }
    group.add("stack peak", "bytes", of(|b| b.stack_peak_bytes as f64));
    group
}

fn filter_group(filters: &[FilterResult]) -> Group {
    let title = |result: &FilterResult| result.entry.title().to_owned();
    let mut group = Group::new("filters on the Cortex-M4F", filters.iter().map(title));
    let ours = filters.iter().filter(|result| result.entry.is_ours());
    let ours: Vec<String> = ours.map(title).collect();
    let spread = |of: fn(&Costs) -> &Vec<u32>| -> Vec<Option<Spread>> {
        filters
            .iter()
            .map(|result| Spread::of(&ticks(result, of)))
            .collect()
    };
    let mean = |list: &[Option<Spread>]| list.iter().map(|s| Some(s.as_ref()?.mean)).collect();
    let max = |list: &[Option<Spread>]| list.iter().map(|s| Some(s.as_ref()?.max.into())).collect();
    let with_mag = spread(|costs| &costs.update_with_mag);
    group
        .add("update with magnetometer, mean", "instr.", mean(&with_mag))
        .at_most(UPDATE_MEAN, &ours);
    group
        .add("update with magnetometer, max", "instr.", max(&with_mag))
        .at_most(UPDATE_MAX, &ours);
    let update = spread(|costs| &costs.update);
    group.add("update without, mean", "instr.", mean(&update));
    group.add("update without, max", "instr.", max(&update));
    let between = spread(|costs| &costs.extrapolation);
    group
        .add("1 kHz extrapolation, mean", "instr.", mean(&between))
        .at_most(EXTRAPOLATION_MEAN, &ours);
    group.add("1 kHz extrapolation, max", "instr.", max(&between));
    let flash = filters.iter().map(|result| Some(result.flash_bytes as f64));
    group
        .add("flash", "bytes", flash.collect())
        .at_most(ESTIMATOR_FLASH_BYTES, &ours);
    let samples = errors(filters, |run| run.at_samples);
    let part =
        |of: fn(&Figures) -> f64| samples.iter().map(|all| Some(of(all.as_ref()?))).collect();
    group
        .add("error, total", "° RMS", part(|all| all.total_deg))
        .decimals(2);
    group
        .add("error, heading", "° RMS", part(|all| all.heading_deg))
        .decimals(2);
    group
        .add(
            "error, inclination",
            "° RMS",
            part(|all| all.inclination_deg),
        )
        .decimals(2);
    let ticks = errors(filters, |run| run.at_1_khz);
    let total = ticks.iter().map(|all| Some(all.as_ref()?.total_deg));
    group
        .add("error at 1 kHz, total", "° RMS", total.collect())
        .decimals(2);
    group
}

fn ticks(result: &FilterResult, of: fn(&Costs) -> &Vec<u32>) -> Vec<u32> {
    let runs = result.runs.iter().flat_map(|run| of(&run.costs));
    runs.copied().collect()
}

/// Returns the mean error of each filter over the motions that have a reference.
fn errors(filters: &[FilterResult], of: fn(&Measured) -> Option<Figures>) -> Vec<Option<Figures>> {
    let mean = |result: &FilterResult| {
        let known: Vec<Figures> = result.runs.iter().filter_map(of).collect();
        Figures::mean(&known)
    };
    filters.iter().map(mean).collect()
}
