//! What a run prints.

use std::process::ExitCode;

use anyhow::{Result, bail};
use robot_policy::{command_source::CommandSource, limits::Stop, machine::Phase};

use super::Session;

/// A joint at its largest torque in a greater share of the runs than this is named at the end.
const OFTEN: f64 = 0.05;

impl Session {
    /// Prints a line whenever something changes.
    pub fn tell(&mut self) {
        let machine = self.runner.machine();
        let headline = match (machine.phase(), machine.ended_by()) {
            (Phase::Passive, Some(_)) => "passive: no torque".to_owned(),
            (Phase::Passive, None) if self.robot.stands() => {
                "waits: the robot stands by itself; put the stand switch down".to_owned()
            }
            (Phase::Passive, None) => match self.runner.in_the_way() {
                Some(stop) => format!("waits: {stop}"),
                None => "waits: ready in a moment".to_owned(),
            },
            (Phase::GetUp, _) => "gets up".to_owned(),
            (Phase::Policy, _) => "the policy drives".to_owned(),
            (Phase::ToDefault | Phase::GetDown, Some(stop)) => format!("gets down: {stop}"),
            (Phase::ToDefault | Phase::GetDown, None) => "gets down".to_owned(),
        };
        // The figures in what is in the way may change with each cycle.
        let waits_for = match machine.ended_by() {
            None => self.runner.in_the_way(),
            Some(_) => None,
        };
        let key = match waits_for {
            Some(Stop::NotPermitted(_)) | None => headline.clone(),
            Some(stop) => stop.name().to_owned(),
        };
        if key != self.said {
            self.say(&headline);
            self.said = key;
        }
    }

    /// With the terminal's keys taken, a line needs its own return.
    pub fn say(&self, line: &str) {
        match self.source {
            CommandSource::Keyboard(..) => print!("{line}\r\n"),
            _ => println!("{line}"),
        }
    }

    /// Completes the log, and says how regular the runs were.
    pub fn finish(&mut self) -> Result<()> {
        if let Some(log) = self.log.take() {
            log.finish()?;
        }
        if let Some(jitter) = self.lateness.summary() {
            self.say(&format!(
                "{} runs of the network: late by min {:.0} µs, mean {:.0} µs, p99 {:.0} µs, max {:.0} µs; {} missed",
                jitter.runs, jitter.min_us, jitter.mean_us, jitter.p99_us, jitter.max_us, jitter.misses
            ));
        }
        for (name, share) in self.names.iter().zip(self.runner.held_shares()) {
            if share > OFTEN {
                self.say(&format!(
                    "{name} would have needed more than torque_limits in {:.0} % of the runs: as in training?",
                    1e2 * share
                ));
            }
        }
        Ok(())
    }

    /// Says why the run ended.
    pub fn verdict(&self) -> Result<ExitCode> {
        let Some(stop) = self.runner.machine().ended_by() else {
            bail!("the run has no end");
        };
        self.say(&format!("ended by {}: {stop}", stop.name()));
        Ok(if stop.is_wanted() {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        })
    }
}
