//! Whether the loop holds, with torques that come late.

use nalgebra::{Complex, DMatrix};

use crate::{
    discrete::DiscreteModel,
    model::{GainMatrix, INPUTS, STATES},
    regulator::TICK_S,
};

/// After 2¹⁷ ticks, two minutes, whatever does not vanish counts as unstable.
const MOST_DOUBLINGS: usize = 17;

/// Returns what a tick does to the states and the torques that are on their way: newest torque last.
fn closed_loop(model: &DiscreteModel, gains: &GainMatrix, delay_ticks: usize) -> DMatrix<f64> {
    let size = STATES + INPUTS * delay_ticks;
    let mut matrix = DMatrix::zeros(size, size);
    matrix
        .view_mut((0, 0), (STATES, STATES))
        .copy_from(&model.a);
    if delay_ticks == 0 {
        let feedback = model.b * gains;
        let mut block = matrix.view_mut((0, 0), (STATES, STATES));
        block -= feedback;
        return matrix;
    }
    matrix
        .view_mut((0, STATES), (STATES, INPUTS))
        .copy_from(&model.b);
    for i in STATES..size - INPUTS {
        matrix[(i, i + INPUTS)] = 1.0;
    }
    matrix
        .view_mut((size - INPUTS, 0), (INPUTS, STATES))
        .copy_from(&-gains);
    matrix
}

/// True if every motion of the loop vanishes.
pub(crate) fn is_stable(model: &DiscreteModel, gains: &GainMatrix, delay_ticks: usize) -> bool {
    let mut matrix = closed_loop(model, gains, delay_ticks);
    for _ in 0..MOST_DOUBLINGS {
        matrix = &matrix * &matrix;
        let largest = matrix.amax();
        if largest < 1e-3 {
            return true;
        }
        if largest.is_nan() || largest > 1e12 {
            return false;
        }
    }
    false
}

/// Returns the loop's poles in 1/s, the slowest first: the logarithms of what a tick multiplies its motions by.
pub fn poles(model: &DiscreteModel, gains: &GainMatrix, delay_ticks: usize) -> Vec<Complex<f64>> {
    let eigenvalues = closed_loop(model, gains, delay_ticks).complex_eigenvalues();
    let mut poles: Vec<_> = eigenvalues.iter().map(|z| z.ln() / TICK_S).collect();
    poles.sort_by(|a, b| b.re.total_cmp(&a.re));
    poles
}
