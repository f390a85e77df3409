//! `policy bench`: how long a network takes.

use std::{path::PathBuf, process::ExitCode};

use anyhow::ensure;
use robot_policy::model::{self, BenchReport, Model};

use super::priority;

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Bench {
    /// The network, an ONNX file
    model: PathBuf,
    /// Length that its input must have
    #[arg(long, value_name = "N")]
    input: Option<usize>,
    /// Runs of the network
    #[arg(long, default_value_t = 1000, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    iterations: u32,
    /// Print JSON, with p99_us and stable among others
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
It runs as `policy run` does, in real time where that is allowed. Every value of the input is 0.1. The exit code is 0 if the outputs are finite and agree to 1e-5.

Example:
  policy bench policy/fivebar/flat/policy.onnx --input 69 --iterations 1000";

impl Bench {
    pub fn run(self) -> anyhow::Result<ExitCode> {
        let mut model = Model::read(&self.model)?;
        if let Some(wanted) = self.input {
            ensure!(
                wanted == model.input_len(),
                "{}: its input has {} values, not {wanted}. `policy show` says what a configuration gives, term by term",
                self.model.display(),
                model.input_len(),
            );
        }
        let iterations = usize::try_from(self.iterations)?;
        // As in a run.
        let priority = priority::raise();
        let report = model::Bench { iterations }.run(&mut model)?;
        if self.json {
            println!("{}", serde_json::to_string(&report)?);
        } else {
            println!("{priority}");
            print(&report);
        }
        Ok(if report.stable {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        })
    }
}

fn print(report: &BenchReport) {
    let BenchReport {
        input,
        output,
        iterations,
        min_us,
        mean_us,
        p99_us,
        max_us,
        largest_difference,
        stable,
    } = report;
    println!("{input} values in, {output} out, {iterations} runs");
    println!("min {min_us:.1} µs, mean {mean_us:.1} µs, p99 {p99_us:.1} µs, max {max_us:.1} µs");
    let verdict = if *stable {
        "✓ STABLE"
    } else {
        "✗ UNSTABLE"
    };
    println!("{verdict}: outputs of the same input differ by {largest_difference:e} at most");
}
