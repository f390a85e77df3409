//! One descent: from a start to where the error is least nearby.

use nalgebra::{Cholesky, SVector};

use super::problem::{Point, Problem};

/// Factor between what is left and the damping (Chan and Lawrence 1988): much far away, none at the target.
const DAMPING: f64 = 0.3;
/// The factor grows when a step made it worse, shrinks after each good one, and stays within these.
const WORSE: f64 = 4.0;
const BETTER: f64 = 0.5;
const DAMPING_LIMITS: [f64; 2] = [1e-3, 1e6];
/// Keeps the matrix positive at the target, where the damping above ends.
const LEAST_DAMPING: f64 = 1e-14;
/// No joint moves further in one iteration, rad or m.
const LONGEST_STEP: f64 = 1.5;

/// When a descent ends short of the target.
#[derive(Clone, Copy)]
pub(super) struct Patience {
    /// Iterations at the most.
    pub(super) iterations: usize,
    /// After each so many, it is looked whether the cost has fallen.
    pub(super) window: usize,
    /// The descent ends if more than this part of the cost is left after such a window.
    pub(super) fraction: f64,
}

/// Goes down from `start`, within the limits. The cost never grows. Returns where it ended, and the iterations.
pub(super) fn descend<const N: usize>(
    problem: &Problem<'_, N>,
    start: SVector<f64, N>,
    patience: Patience,
) -> (Point<N>, usize) {
    let mut here = problem.at(problem.within(start));
    let mut damping = DAMPING;
    let mut cost_before = here.cost;
    for iteration in 0..patience.iterations {
        if problem.is_solved(&here) || damping > DAMPING_LIMITS[1] {
            return (here, iteration);
        }
        if iteration % patience.window == patience.window - 1 {
            if here.cost > patience.fraction * cost_before {
                return (here, iteration);
            }
            cost_before = here.cost;
        }
        let next = step(problem, &here, damping).map(|q| problem.at(q));
        match next {
            // A step to NaN is none.
            Some(next) if next.cost <= here.cost => {
                here = next;
                damping = (damping * BETTER).max(DAMPING_LIMITS[0]);
            }
            _ => damping *= WORSE,
        }
    }
    (here, patience.iterations)
}

/// Where the next step leads, if the damped curvature can be inverted.
#[inline]
fn step<const N: usize>(
    problem: &Problem<'_, N>,
    here: &Point<N>,
    damping: f64,
) -> Option<SVector<f64, N>> {
    let mut down = here.down();
    let mut curvature = here.curvature();
    let held = problem.held(here, &down);
    let damping = damping * here.cost + LEAST_DAMPING;
    for (joint, held) in held.into_iter().enumerate() {
        curvature[(joint, joint)] += damping;
        if held {
            curvature.row_mut(joint).fill(0.0);
            curvature.column_mut(joint).fill(0.0);
            curvature[(joint, joint)] = 1.0;
            down[joint] = 0.0;
        }
    }
    let mut step = down;
    Cholesky::new(curvature)?.solve_mut(&mut step);
    let longest = SVector::repeat(LONGEST_STEP);
    Some(problem.within(here.q + step.sup(&-longest).inf(&longest)))
}
