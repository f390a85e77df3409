//! How many poses are solved, and how quickly.

use std::time::Instant;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::{IkError, Mask, Solver};
use crate::kinematics::Robot;

/// What [`measure`] found.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct BenchFigures {
    /// Poses that were asked for, each of them reachable within the limits.
    pub poses: usize,
    /// Poses that were solved.
    pub solved: usize,
    /// Mean time for a pose, µs.
    pub mean_us: f64,
    /// Time that 99 of 100 poses take at the most, µs.
    pub p99_us: f64,
    /// Longest time, µs.
    pub max_us: f64,
}

/// Solves random poses of an arm: those of the tool for joint values drawn within the limits, from other such values as `q0`.
///
/// # Errors
/// The arm has a joint without limits.
pub fn measure(
    robot: &Robot,
    mask: Mask,
    poses: usize,
    seed: u64,
) -> Result<BenchFigures, IkError> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut draw = || -> Vec<f64> {
        let joints = robot.joints().iter();
        let within = |lower: f64, upper: f64, part: f64| lower + (upper - lower) * part;
        joints
            .map(|joint| within(joint.lower(), joint.upper(), random.random()))
            .collect()
    };
    let solver = Solver::default();
    let mut solved = 0;
    let mut times = Vec::with_capacity(poses);
    for _ in 0..poses {
        let target = robot.fkine(&draw())?;
        let q0 = draw();
        let begin = Instant::now();
        let solution = solver.solve(robot, &target, &q0, mask)?;
        times.push(begin.elapsed().as_secs_f64() * 1e6);
        solved += usize::from(solution.success());
    }
    times.sort_unstable_by(f64::total_cmp);
    let at = |index: usize| times.get(index).copied().unwrap_or(0.0);
    Ok(BenchFigures {
        poses,
        solved,
        mean_us: times.iter().sum::<f64>() / poses.max(1) as f64,
        p99_us: at(poses.saturating_mul(99) / 100),
        max_us: at(poses.saturating_sub(1)),
    })
}
