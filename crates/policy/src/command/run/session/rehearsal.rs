//! What the policy would do, without sending anything.

use std::{
    process::ExitCode,
    sync::atomic::Ordering,
    time::{Duration, Instant},
};

use anyhow::{Result, bail};
use robot_app::link::Uplink;
use robot_policy::{
    action::Target,
    command_source::Said,
    limits::{STALE_S, Stop},
    pace::Pace,
};

use super::Session;

/// One of so many runs of the network is printed.
const PRINT_EVERY: u64 = 25;

impl Session {
    /// Prints what the policy sees and would command, and sends nothing.
    pub fn rehearse(mut self, period: Duration) -> Result<ExitCode> {
        self.wait_for_robot()?;
        let started = Instant::now();
        let mut pace = Pace::new(period, started);
        let is_over = |seconds: f64| started.elapsed().as_secs_f64() >= seconds;
        let mut cycles = 0;
        while !self.interrupted.load(Ordering::Relaxed) && !self.seconds.is_some_and(is_over) {
            self.listen(pace.due())?;
            let late = pace.begin(Instant::now());
            if u64::is_multiple_of(cycles, self.decimation)
                && !self.rehearse_run(started, late, cycles / self.decimation)?
            {
                break;
            }
            cycles += 1;
        }
        self.finish()?;
        Ok(ExitCode::SUCCESS)
    }

    /// Runs the network once. Returns false if the user ends it.
    fn rehearse_run(&mut self, started: Instant, late: Duration, run: u64) -> Result<bool> {
        let age_s = self
            .heard
            .map_or(f64::INFINITY, |heard| heard.elapsed().as_secs_f64());
        if age_s > STALE_S {
            bail!(Stop::Stale { age_s });
        }
        let time_s = started.elapsed().as_secs_f64();
        let said = self
            .source
            .read(self.started.elapsed(), time_s, &self.robot.state.sticks)?;
        let Said::Commands(commands) = said else {
            return Ok(false);
        };
        let state = self.robot.state;
        self.runner.rehearse(&state, &commands)?;
        // Nobody waits for a command that is late.
        let _ = self.lateness.add(late);
        if run.is_multiple_of(PRINT_EVERY) {
            self.print(&state);
        }
        self.record(time_s, commands, late);
        Ok(true)
    }

    fn print(&self, state: &Uplink) {
        self.say(&format!("t = {:.2} s", state.time_s));
        for block in self.runner.layout().blocks() {
            let values = self.runner.input()[block.offset..].iter().take(block.len);
            let values = block.values.iter().zip(values);
            let values: Vec<_> = values
                .map(|(name, value)| format!("{name} {value:+.3}"))
                .collect();
            self.say(&format!(
                "  {:>4} {:<16} {:>2}  {}",
                block.offset,
                block.term,
                block.age,
                values.join("  ")
            ));
        }
        for (name, target) in self.names.iter().zip(self.runner.wanted()) {
            self.say(&match target {
                Target::Position { rad, kp, kd } => {
                    format!("       {name:<16} {rad:+.3} rad, Kp {kp} Kd {kd}")
                }
                Target::Speed { rps, kd } => format!("       {name:<16} {rps:+.3} rad/s, Kd {kd}"),
            });
        }
    }
}
