//! Searches for joint values.

use nalgebra::{IsometryMatrix3, SVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::{
    IkError, Mask, Outcome, Solution,
    descent::{Patience, descend},
    problem::{Point, Problem},
};
use crate::kinematics::{Frame, Joint, Robot, finite};

/// A descent that does not halve the cost in three iterations seldom arrives, and another start is cheaper.
const SEARCH: Patience = Patience {
    iterations: 30,
    window: 3,
    fraction: 0.5,
};
/// The best of all descents that ended short is brought to its very end.
const FINISH: Patience = Patience {
    iterations: 200,
    window: 10,
    fraction: 1.0 - 1e-6,
};
/// One call in real time, which has to end soon.
const FOLLOW: Patience = Patience {
    iterations: 20,
    window: 5,
    fraction: 1.0 - 1e-6,
};

/// How joint values are searched for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solver {
    /// Distance in m, and angle in rad, that count as arrived.
    pub tolerance: f64,
    /// Descents at the most.
    pub searches: usize,
    /// Equal seeds give equal answers.
    pub seed: u64,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            searches: 100,
            seed: 0,
        }
    }
}

impl Solver {
    /// Searches for joint values with the tool at `target` (in the world), first from `q0`, then from random ones.
    ///
    /// The answer is within the joint limits, also if `q0` is not. It may be on another branch than `q0`, far away in the joints:
    /// a moving arm takes [`follow`](Self::follow).
    ///
    /// # Errors
    /// The target is not finite, or `q0` has not one finite value for each joint. A target that cannot be reached is none: the
    /// [outcome](Solution::outcome) says so, and the answer is the nearest pose found.
    pub fn solve(
        &self,
        robot: &Robot,
        target: &IsometryMatrix3<f64>,
        q0: &[f64],
        mask: Mask,
    ) -> Result<Solution, IkError> {
        self.ask(robot, target, q0, mask, None)
    }

    /// Takes one step towards `target` from where the joints are now: at most 20 iterations, no other branch, and no joint
    /// moves further than `largest_change`, rad or m. The tool never ends further away than it is, as the mask weighs it.
    ///
    /// A joint that is beyond its limits, as by hand, comes back by `largest_change` in a call, and the tool may then move away.
    ///
    /// # Errors
    /// As [`solve`](Self::solve), and `largest_change` is not positive and finite.
    pub fn follow(
        &self,
        robot: &Robot,
        target: &IsometryMatrix3<f64>,
        q: &[f64],
        mask: Mask,
        largest_change: f64,
    ) -> Result<Solution, IkError> {
        if !(largest_change.is_finite() && largest_change > 0.0) {
            return Err(IkError::Change(largest_change));
        }
        self.ask(robot, target, q, mask, Some(largest_change))
    }

    fn ask(
        &self,
        robot: &Robot,
        target: &IsometryMatrix3<f64>,
        q0: &[f64],
        mask: Mask,
        largest_change: Option<f64>,
    ) -> Result<Solution, IkError> {
        robot.check_values("q0", q0)?;
        finite("the target", target)?;
        let search = Search {
            solver: *self,
            robot,
            target: Frame::from(*target),
            mask,
        };
        // Matrices of a size that the compiler knows need no heap and are unrolled.
        Ok(match robot.joints().len() {
            1 => search.run::<1>(q0, largest_change),
            2 => search.run::<2>(q0, largest_change),
            3 => search.run::<3>(q0, largest_change),
            4 => search.run::<4>(q0, largest_change),
            5 => search.run::<5>(q0, largest_change),
            6 => search.run::<6>(q0, largest_change),
            7 => search.run::<7>(q0, largest_change),
            _ => search.run::<8>(q0, largest_change),
        })
    }
}

/// One question.
struct Search<'a> {
    solver: Solver,
    robot: &'a Robot,
    target: Frame,
    mask: Mask,
}

impl Search<'_> {
    fn run<const N: usize>(&self, q0: &[f64], largest_change: Option<f64>) -> Solution {
        let joints = self.robot.joints();
        let mut problem = Problem::new(
            self.robot.chain(),
            self.target,
            self.mask,
            self.solver.tolerance,
        );
        let start = SVector::<f64, N>::from_iterator(q0.iter().copied());
        problem.lower = SVector::from_iterator(joints.iter().map(Joint::lower));
        problem.upper = SVector::from_iterator(joints.iter().map(Joint::upper));
        match largest_change {
            None => self.search(&problem, start),
            Some(change) => self.follow(problem, start, change),
        }
    }

    fn search<const N: usize>(&self, problem: &Problem<'_, N>, q0: SVector<f64, N>) -> Solution {
        let mut random = Pcg64Mcg::seed_from_u64(self.solver.seed);
        let mut start = q0;
        let mut best: Option<Point<N>> = None;
        let mut iterations = 0;
        for search in 1..=self.solver.searches.max(1) {
            let (end, taken) = descend(problem, start, SEARCH);
            iterations += taken;
            if problem.is_solved(&end) {
                return self.solution(&end, Outcome::Converged, iterations, search);
            }
            if best.is_none_or(|best| end.cost < best.cost) {
                best = Some(end);
            }
            start = self.anywhere(&mut random);
        }
        let nearest = best.map_or(q0, |best| best.q);
        let (end, taken) = descend(problem, nearest, FINISH);
        let outcome = self.shortfall(problem, &end);
        self.solution(
            &end,
            outcome,
            iterations + taken,
            self.solver.searches.max(1),
        )
    }

    fn follow<const N: usize>(
        &self,
        mut problem: Problem<'_, N>,
        q: SVector<f64, N>,
        largest_change: f64,
    ) -> Solution {
        let change = SVector::repeat(largest_change);
        let limits = (problem.lower, problem.upper);
        // Beyond a limit, the way back to it is as long as may be.
        problem.lower = limits.0.sup(&(q - change)).inf(&(q + change));
        problem.upper = limits.1.inf(&(q + change)).sup(&(q - change));
        let (end, iterations) = descend(&problem, q, FOLLOW);
        (problem.lower, problem.upper) = limits;
        let is_at_change = (end.q - q).amax() >= largest_change * (1.0 - 1e-9);
        let outcome = match self.shortfall(&problem, &end) {
            Outcome::Converged => Outcome::Converged,
            _ if is_at_change => Outcome::OnTheWay,
            other => other,
        };
        self.solution(&end, outcome, iterations, 1)
    }

    /// Joint values that are drawn within the limits, or within a turn where there are none.
    fn anywhere<const N: usize>(&self, random: &mut Pcg64Mcg) -> SVector<f64, N> {
        let joints = self.robot.joints().iter();
        SVector::from_iterator(joints.map(|joint| {
            let lower = joint.lower().max(-std::f64::consts::PI);
            let upper = joint.upper().min(std::f64::consts::PI);
            lower + (upper - lower) * random.random::<f64>()
        }))
    }

    /// Why a search that went on to its end is not at the target.
    fn shortfall<const N: usize>(&self, problem: &Problem<'_, N>, end: &Point<N>) -> Outcome {
        if problem.is_solved(end) {
            return Outcome::Converged;
        }
        let axes = self.mask.axes();
        if axes > N {
            return Outcome::MaskTooWide { axes, joints: N };
        }
        let blocked = problem.blocked(end);
        let names = self.robot.joint_names().zip(blocked);
        let names = names
            .filter(|(_, blocked)| *blocked)
            .map(|(name, _)| name.to_owned());
        match names.collect::<Vec<_>>() {
            none if none.is_empty() => Outcome::OutOfReach,
            some => Outcome::AtLimits(some),
        }
    }

    fn solution<const N: usize>(
        &self,
        end: &Point<N>,
        outcome: Outcome,
        iterations: usize,
        searches: usize,
    ) -> Solution {
        Solution {
            q: end.q.iter().copied().collect(),
            outcome,
            remaining: end.remaining,
            iterations,
            searches,
        }
    }
}
