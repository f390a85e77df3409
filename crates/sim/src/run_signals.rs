//! `emu.*`: the emulator's own measurements of the run.

use robot_plant::time::{self, Ps};

use super::{
    signals::{SignalTable, Values},
    simulation::Simulation,
};
use crate::machine::Progress;

const NAMES: [&str; 12] = [
    "emu.board_errors",
    "emu.cpu_load",
    "emu.missed_ticks",
    "emu.tick_period_us",
    "emu.can1.load",
    "emu.can2.load",
    "emu.flash.erases",
    "emu.flash.programs",
    "emu.resets",
    "emu.att_error.total_deg",
    "emu.att_error.heading_deg",
    "emu.att_error.inclination_deg",
];

/// Interval at which the measurements are taken; they are taken at the end too.
const PERIOD: Ps = 100 * time::MS;

/// Keeps the `emu.*` values up to date.
pub struct RunSignals {
    due: Ps,
    counters: [Option<f64>; 8],
    /// Time of the last measurement, and for how long each CAN bus had been busy by then.
    can_busy: (Ps, [Ps; 2]),
    /// Number of control ticks by then, and entry time of the last one.
    ticks: Option<(u64, Ps)>,
    quaternion: Option<[usize; 4]>,
    valid: Option<usize>,
}

impl RunSignals {
    pub fn names() -> &'static [&'static str] {
        &NAMES
    }

    pub fn new(table: &SignalTable) -> Self {
        let part = |i: usize| table.index(&format!("diag.estimate.q_wxyz.{i}"));
        Self {
            due: 0,
            counters: [None; 8],
            can_busy: (0, [0; 2]),
            ticks: None,
            quaternion: match [part(0), part(1), part(2), part(3)] {
                [Some(w), Some(x), Some(y), Some(z)] => Some([w, x, y, z]),
                _ => None,
            },
            valid: table.index("diag.estimate.valid"),
        }
    }

    /// Appends the run's own values to those of world and firmware, taken at `now`.
    pub fn append(
        &mut self,
        board: &mut impl Simulation,
        now: Ps,
        last: bool,
        values: &mut Values,
    ) {
        if now >= self.due || last {
            self.due = now + PERIOD;
            let progress = board.progress();
            let [can1, can2] = self.can_load(&progress, now);
            let tick_period_us = self.tick_period_us(&progress);
            self.counters = [
                Some(progress.board_errors as f64),
                Some(progress.cpu_load),
                Some(progress.missed as f64),
                tick_period_us,
                can1,
                can2,
                Some(progress.flash_erases as f64),
                Some(progress.flash_programs as f64),
            ];
        }
        let error = self
            .estimate(values)
            .and_then(|q| board.attitude_error_deg(q));
        values.extend(self.counters);
        values.push(Some(board.resets() as f64));
        values.extend((0..3).map(|i| error.map(|e| e[i])));
    }

    /// Busy share of each bus since the last measurement.
    fn can_load(&mut self, progress: &Progress, now: Ps) -> [Option<f64>; 2] {
        let (before, busy_before) = self.can_busy;
        self.can_busy = (now, progress.can_busy);
        let elapsed = (now > before).then(|| (now - before) as f64);
        [0, 1].map(|bus| Some((progress.can_busy[bus] - busy_before[bus]) as f64 / elapsed?))
    }

    /// Mean time between ticks since the last measurement, in the time of the crystal.
    fn tick_period_us(&mut self, progress: &Progress) -> Option<f64> {
        let before = std::mem::replace(&mut self.ticks, progress.ticks);
        let ((ticks_before, from), (ticks, to)) = (before?, progress.ticks?);
        let new = ticks.checked_sub(ticks_before).filter(|new| *new > 0)?;
        Some((to - from) as f64 / time::US as f64 / new as f64)
    }

    /// The firmware's attitude while it is valid.
    fn estimate(&self, values: &Values) -> Option<[f64; 4]> {
        values[self.valid?].filter(|v| *v != 0.0)?;
        let [w, x, y, z] = self.quaternion?;
        Some([values[w]?, values[x]?, values[y]?, values[z]?])
    }
}
