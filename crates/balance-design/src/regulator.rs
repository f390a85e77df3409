//! Gains at one pair of leg lengths, for torques that come late.

use nalgebra::SMatrix;
use robot_description::{Robot, Weights};

use crate::{
    DesignError,
    discrete::DiscreteModel,
    model::{GainMatrix, LinearModel, StateMatrix},
    riccati,
};

/// Time in s from one control tick to the next.
pub(crate) const TICK_S: f64 = 0.001;

/// Returns the delay of the robot's file in whole ticks.
pub fn delay_ticks(robot: &Robot) -> usize {
    // At most some dozens: no figure is lost, and a negative one is none.
    (robot.control.delay_s / TICK_S).round() as usize
}

/// The gains at one pair of leg lengths and what they are for.
#[derive(Clone, Debug)]
pub struct Regulator {
    /// The robot about standing still.
    pub model: LinearModel,
    /// The same in ticks.
    pub discrete: DiscreteModel,
    /// Least-cost gains if torques came at once.
    pub undelayed: GainMatrix,
    /// Gains for torques that come `delay_ticks` late: `u = −gains · (x − x_ref)`.
    pub gains: GainMatrix,
}

impl Regulator {
    /// Designs the gains at these lengths of the left and the right leg, in m.
    ///
    /// # Errors
    /// [`DesignError`] where the links do not reach, or weights keep the cost from settling.
    pub fn new(robot: &Robot, length_m: [f64; 2]) -> Result<Self, DesignError> {
        let model = LinearModel::new(robot, length_m)?;
        let discrete = DiscreteModel::new(&model, TICK_S);
        let Weights { q, r } = &robot.control.weights;
        let q = StateMatrix::from_diagonal(&(*q).into()) * TICK_S;
        let r = SMatrix::<f64, 4, 4>::from_diagonal(&(*r).into()) * TICK_S;
        let undelayed = riccati::optimal_gains(&discrete, &q, &r).ok_or(DesignError::Cost {
            left_m: length_m[0],
            right_m: length_m[1],
        })?;
        // With delay d, u(k) is due at k + d. Where the loop has moved by then, it moved as the loop without delay moves, so
        // u(k) = −K x(k+d) = −K (a − b K)^d x(k): that loop's poles stay as they are, and only fast ones come in addition.
        let closed = discrete.a - discrete.b * undelayed;
        let gains = (0..delay_ticks(robot)).fold(undelayed, |gains, _| gains * closed);
        Ok(Self {
            model,
            discrete,
            undelayed,
            gains,
        })
    }
}
