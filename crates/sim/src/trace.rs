//! Signals over time, thinned out to the resolution of a plot.

use robot_plant::time::{self, Ps};

use super::{
    runner::{Observer, SAMPLE_PERIOD},
    signals::{SignalTable, Values},
};
use crate::machine::LogLine;

/// Number of points over the width of a plot.
const POINTS: u64 = 2_000;

/// The signals and the log of a run.
pub struct Traces {
    period: Ps,
    table: Option<SignalTable>,
    times_s: Vec<f64>,
    samples: Vec<Values>,
    log: Vec<LogLine>,
}

impl Traces {
    /// Traces for a run of `length`.
    pub fn new(length: Ps) -> Self {
        let samples = length / POINTS / SAMPLE_PERIOD;
        Self {
            period: samples.max(1) * SAMPLE_PERIOD,
            table: None,
            times_s: Vec::new(),
            samples: Vec::new(),
            log: Vec::new(),
        }
    }

    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    pub fn log(&self) -> &[LogLine] {
        &self.log
    }

    /// All values at each of `times_s`.
    pub fn samples(&self) -> impl Iterator<Item = (f64, &Values)> {
        self.times_s.iter().copied().zip(&self.samples)
    }

    /// The values of a signal at `times_s`; `None` if there is no signal of this name.
    pub fn signal(&self, name: &str) -> Option<Vec<Option<f64>>> {
        let place = self.table.as_ref()?.index(name)?;
        Some(self.samples.iter().map(|values| values[place]).collect())
    }
}

impl Observer for Traces {
    fn sample(&mut self, at: Ps, table: &SignalTable, values: &Values) {
        if self.table.is_none() {
            self.table = Some(table.clone());
        }
        if at.is_multiple_of(self.period) {
            self.times_s.push(time::to_seconds(at));
            self.samples.push(values.clone());
        }
    }

    fn log(&mut self, line: &LogLine) {
        self.log.push(line.clone());
    }
}
