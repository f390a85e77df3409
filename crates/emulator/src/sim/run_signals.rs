//! `emu.*`: what the emulator itself knows about the run.

use robot_plant::time::{self, Ps};

use super::{
    board::Board,
    signals::{SignalTable, Values},
};
use crate::machine::Stats;

const NAMES: [&str; 9] = [
    "emu.board_errors",
    "emu.cpu_load",
    "emu.missed_ticks",
    "emu.can1.load",
    "emu.can2.load",
    "emu.resets",
    "emu.att_error.total_deg",
    "emu.att_error.heading_deg",
    "emu.att_error.inclination_deg",
];

/// Run statistics are worked out this often, and at the end.
const STATS_PERIOD: Ps = 100 * time::MS;

/// Keeps the `emu.*` values up to date.
pub struct RunSignals {
    stats_due: Ps,
    counters: [Option<f64>; 5],
    /// When the statistics were last worked out, and how long each CAN bus had been busy by then, in seconds.
    can_busy: (Ps, [f64; 2]),
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
            stats_due: 0,
            counters: [None; 5],
            can_busy: (0, [0.0; 2]),
            quaternion: match [part(0), part(1), part(2), part(3)] {
                [Some(w), Some(x), Some(y), Some(z)] => Some([w, x, y, z]),
                _ => None,
            },
            valid: table.index("diag.estimate.valid"),
        }
    }

    /// Appends the run's own values to those of world and firmware, taken at `now`.
    pub fn append(&mut self, board: &mut impl Board, now: Ps, last: bool, values: &mut Values) {
        if now >= self.stats_due || last {
            self.stats_due = now + STATS_PERIOD;
            let stats = board.stats();
            let [can1, can2] = self.can_load(&stats, now);
            self.counters = [
                Some(board.board_errors().len() as f64),
                Some(stats.cpu_load),
                Some(stats.missed as f64),
                can1,
                can2,
            ];
        }
        let error = self
            .estimate(values)
            .and_then(|q| board.attitude_error_deg(q));
        values.extend(self.counters);
        values.push(Some(board.resets() as f64));
        values.extend((0..3).map(|i| error.map(|e| e[i])));
    }

    /// Busy share of each bus since the statistics were last worked out.
    fn can_load(&mut self, stats: &Stats, now: Ps) -> [Option<f64>; 2] {
        let (before, busy_before) = self.can_busy;
        let busy = [0, 1].map(|i| stats.can.get(i).map(|bus| bus.load * time::to_seconds(now)));
        self.can_busy = (now, busy.map(Option::unwrap_or_default));
        let elapsed = time::to_seconds(now - before);
        [0, 1].map(|i| Some((busy[i]? - busy_before[i]) / elapsed).filter(|_| now > before))
    }

    /// The firmware's attitude, while it calls it valid.
    fn estimate(&self, values: &Values) -> Option<[f64; 4]> {
        values[self.valid?].filter(|v| *v != 0.0)?;
        let [w, x, y, z] = self.quaternion?;
        Some([values[w]?, values[x]?, values[y]?, values[z]?])
    }
}
