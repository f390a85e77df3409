//! The budgets that a run can be checked against, with the measured values.

use serde::Serialize;

use super::runner::RunResult;

pub const TICK_MEAN_INSTRUCTIONS: f64 = 6_000.0;
pub const TICK_MAX_INSTRUCTIONS: f64 = 12_000.0;
/// Of a robot that may balance, mean and greatest.
pub const BALANCING_TICK_INSTRUCTIONS: [f64; 2] = [9_000.0, 16_000.0];
pub const RELEASE_JITTER_US: f64 = 5.0;
/// Limits of loads, as shares of the time.
pub const CPU_LOAD: f64 = 0.2;
pub const CAN_LOAD: f64 = 0.8;

#[derive(Clone, Debug, Serialize)]
pub struct Budget {
    pub name: &'static str,
    pub limit: String,
    pub measured: String,
    pub ok: bool,
}

impl Budget {
    fn at_most(name: &'static str, measured: f64, limit: f64, unit: &str) -> Self {
        Self {
            name,
            limit: format!("≤ {limit}{unit}"),
            measured: format!("{}{unit}", rounded(measured)),
            ok: measured <= limit,
        }
    }
}

fn rounded(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// Budgets of the image: the same for every run of the same scenario.
pub fn image_budgets(result: &RunResult) -> Vec<Budget> {
    let stats = &result.stats;
    let can_balance = result.table.index("truth.leg.0.length_m").is_some();
    let [mean, max] = if can_balance {
        BALANCING_TICK_INSTRUCTIONS
    } else {
        [TICK_MEAN_INSTRUCTIONS, TICK_MAX_INSTRUCTIONS]
    };
    let mut budgets = vec![
        Budget::at_most(
            "control tick, mean",
            stats.tick_instructions.mean,
            mean,
            " instr.",
        ),
        Budget::at_most(
            "control tick, max",
            stats.tick_instructions.max,
            max,
            " instr.",
        ),
        Budget::at_most(
            "release jitter, max",
            stats.release_jitter_us.max,
            RELEASE_JITTER_US,
            " µs",
        ),
        Budget::at_most("missed ticks", stats.missed as f64, 0.0, ""),
        Budget::at_most("CPU load", stats.cpu_load * 100.0, CPU_LOAD * 100.0, " %"),
    ];
    if stats.ticks == 0 {
        budgets.retain(|b| b.name == "CPU load");
        budgets.push(Budget {
            name: "control ticks",
            limit: "≥ 1".into(),
            measured: "0".into(),
            ok: false,
        });
    }
    for (name, bus) in ["CAN1 load", "CAN2 load"].into_iter().zip(&stats.can) {
        budgets.push(Budget::at_most(
            name,
            bus.load * 100.0,
            CAN_LOAD * 100.0,
            " %",
        ));
    }
    budgets
}

/// Budget of the emulator itself, which depends on the computer.
pub fn speed_budget(realtime_factor: f64) -> Budget {
    Budget {
        name: "emulator speed",
        limit: "≥ 5 × real time".into(),
        measured: format!("{} × real time", rounded(realtime_factor)),
        ok: realtime_factor >= 5.0,
    }
}
