//! `cargo xtask test`: everything CI runs. One failed step does not hide the next.

mod host;
mod steps;
mod totals;
mod windows;

use std::{process::ExitCode, time::Instant};

use steps::Step;
use totals::Totals;

#[derive(clap::Args)]
pub struct Test {
    /// Run the longest tests whole, not a sample of them
    #[arg(long)]
    whole: bool,
}

impl Test {
    /// Runs every step, then shows a table and one line of totals.
    pub fn run(self) -> anyhow::Result<ExitCode> {
        let started = Instant::now();
        let mut rows = Vec::new();
        for step in steps::all(self.whole)? {
            println!("\n=== {}", step.name);
            rows.push(run_step(step));
        }
        println!("\n=== summary");
        let mut sum = Totals::default();
        for row in &rows {
            println!("{row}");
            sum += row.totals;
        }
        println!("took {} s", started.elapsed().as_secs());
        println!("{sum}");
        let failed = sum.failed > 0 || sum.passed == 0;
        Ok(if failed {
            ExitCode::FAILURE
        } else {
            ExitCode::SUCCESS
        })
    }
}

struct Row {
    name: &'static str,
    totals: Totals,
    seconds: u64,
}

impl std::fmt::Display for Row {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let verdict = match self.totals {
            Totals { failed: 1.., .. } => "FAILED",
            Totals { passed: 0, .. } => "skipped",
            _ => "ok",
        };
        let Self { name, seconds, .. } = self;
        write!(
            to,
            "{name:<34} {verdict:<8} {:<40} {seconds:>5} s",
            self.totals.to_string()
        )
    }
}

fn run_step(step: Step) -> Row {
    let started = Instant::now();
    let totals = (step.run)().unwrap_or_else(|error| {
        println!("error: {error:#}");
        Totals::FAILED
    });
    println!("{}: {totals}", step.name);
    Row {
        name: step.name,
        totals,
        seconds: started.elapsed().as_secs(),
    }
}
