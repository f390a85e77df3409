//! How long a network takes, and whether it gives the same each time.

use std::time::{Duration, Instant};

use serde::Serialize;

use super::{Model, ModelError};

/// Every value of the input.
const INPUT: f32 = 0.1;
/// Outputs of the same input differ by no more.
const AGREEMENT: f32 = 1e-5;
/// Runs before the first that counts: caches and clocks settle.
const WARM_UP: usize = 100;

/// A measurement to be made.
#[derive(Clone, Copy, Debug)]
pub struct Bench {
    /// Runs of the network that count, at least 1.
    pub iterations: usize,
}

/// What was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchReport {
    /// Length of the input.
    pub input: usize,
    /// Length of the output.
    pub output: usize,
    /// Runs of the network.
    pub iterations: usize,
    /// Shortest run in µs.
    pub min_us: f64,
    /// Mean in µs.
    pub mean_us: f64,
    /// 99 of 100 runs take at most this, in µs.
    pub p99_us: f64,
    /// Longest run in µs.
    pub max_us: f64,
    /// Largest difference of an output from the first one.
    pub largest_difference: f32,
    /// The outputs are finite and agree to 1e-5.
    pub stable: bool,
}

impl Bench {
    /// Runs the network over and over on an input of 0.1 in each place.
    ///
    /// # Errors
    /// The network fails.
    pub fn run(self, model: &mut Model) -> Result<BenchReport, ModelError> {
        let input = vec![INPUT; model.input_len()];
        let mut output = vec![0.0; model.output_len()];
        for _ in 0..WARM_UP {
            model.run(&input, &mut output)?;
        }
        let first = output.clone();
        let mut largest_difference = 0.0f32;
        let mut times = Vec::with_capacity(self.iterations);
        for _ in 0..self.iterations.max(1) {
            let start = Instant::now();
            model.run(&input, &mut output)?;
            times.push(start.elapsed());
            let differences = first.iter().zip(&output).map(|(a, b)| (a - b).abs());
            largest_difference = differences.fold(largest_difference, f32::max);
        }
        let is_finite = first.iter().chain(&output).all(|value| value.is_finite());
        times.sort_unstable();
        let total: Duration = times.iter().sum();
        let us = |time: Duration| time.as_secs_f64() * 1e6;
        let count = times.len();
        Ok(BenchReport {
            input: input.len(),
            output: output.len(),
            iterations: count,
            min_us: us(times[0]),
            mean_us: us(total) / count as f64,
            p99_us: us(times[(count * 99).div_ceil(100) - 1]),
            max_us: us(times[count - 1]),
            largest_difference,
            stable: is_finite && largest_difference <= AGREEMENT,
        })
    }
}
