//! One descent: from a start to where the error is least nearby.

use nalgebra::{Cholesky, SMatrix, SVector};

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
///
/// It goes straight to what the curvature says is best until a joint is at its limit. That joint stays there, and the others go on
/// to what is best beside it. A step that is only cut off at the limits leads astray, as each joint of it relies on the others.
#[inline]
fn step<const N: usize>(
    problem: &Problem<'_, N>,
    here: &Point<N>,
    damping: f64,
) -> Option<SVector<f64, N>> {
    let down = here.down();
    let mut curvature = here.curvature();
    let damping = damping * here.cost + LEAST_DAMPING;
    for joint in 0..N {
        curvature[(joint, joint)] += damping;
    }
    let longest = SVector::repeat(LONGEST_STEP);
    let [least, most] = [-longest, longest].map(|step| problem.within(here.q + step) - here.q);
    let mut step = SVector::zeros();
    let mut stopped = problem.held(here, &down).map(|held| held.then_some(0.0));
    loop {
        let rest = beside(&curvature, &down, &stopped)? - step;
        let mut part = 1.0;
        let mut first = None;
        for joint in 0..N {
            let room = if rest[joint] < 0.0 { least } else { most }[joint] - step[joint];
            if stopped[joint].is_none() && rest[joint] * part / room > 1.0 {
                part = room / rest[joint];
                first = Some(joint);
            }
        }
        step += rest * part;
        let Some(first) = first else {
            return Some(problem.within(here.q + step));
        };
        stopped[first] = Some(step[first]);
    }
}

/// The best step in which some joints move as far as is said.
#[inline]
fn beside<const N: usize>(
    curvature: &SMatrix<f64, N, N>,
    down: &SVector<f64, N>,
    stopped: &[Option<f64>; N],
) -> Option<SVector<f64, N>> {
    let (mut curvature, mut step) = (*curvature, *down);
    for (joint, change) in stopped.iter().enumerate() {
        let Some(change) = *change else { continue };
        step -= curvature.column(joint) * change;
        curvature.row_mut(joint).fill(0.0);
        curvature.column_mut(joint).fill(0.0);
        curvature[(joint, joint)] = 1.0;
        step[joint] = change;
    }
    Cholesky::new(curvature)?.solve_mut(&mut step);
    Some(step)
}
