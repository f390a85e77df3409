//! The discrete algebraic Riccati equation, solved by doubling.

use nalgebra::SMatrix;

use crate::{
    discrete::DiscreteModel,
    model::{GainMatrix, INPUTS, StateMatrix},
};

/// Each step doubles the time that the cost covers; 2³⁰ ticks are two weeks.
const MOST_STEPS: usize = 30;

/// Returns the gains of least cost `Σ xᵀ q x + uᵀ r u`, or `None` if the cost does not settle.
///
/// Structure-preserving doubling: Chu, Fan, Lin and Wang, International Journal of Control 77 (2004), algorithm SDA.
pub(crate) fn optimal_gains(
    model: &DiscreteModel,
    q: &StateMatrix,
    r: &SMatrix<f64, INPUTS, INPUTS>,
) -> Option<GainMatrix> {
    let cost = cost(model, q, r)?;
    let (a, b) = (&model.a, &model.b);
    let weight = r + b.transpose() * cost * b;
    Some(weight.try_inverse()? * b.transpose() * cost * a)
}

fn cost(
    model: &DiscreteModel,
    q: &StateMatrix,
    r: &SMatrix<f64, INPUTS, INPUTS>,
) -> Option<StateMatrix> {
    let mut a = model.a;
    let mut g = model.b * r.try_inverse()? * model.b.transpose();
    let mut h = *q;
    for _ in 0..MOST_STEPS {
        let w = (StateMatrix::identity() + g * h).try_inverse()?;
        let next_h = h + a.transpose() * h * w * a;
        let next_g = g + a * w * g * a.transpose();
        a = a * w * a;
        let change = (next_h - h).amax() / next_h.amax();
        h = (next_h + next_h.transpose()) / 2.0;
        g = (next_g + next_g.transpose()) / 2.0;
        if change < 1e-14 {
            return h.iter().all(|v| v.is_finite()).then_some(h);
        }
    }
    None
}
