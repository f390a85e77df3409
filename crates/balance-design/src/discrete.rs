//! A linear system whose input holds for one tick.

use nalgebra::SMatrix;

use crate::model::{INPUTS, InputMatrix, LinearModel, STATES, StateMatrix};

/// `x(k+1) = a x(k) + b u(k)`, one tick from k to k+1.
#[derive(Clone, Debug)]
pub struct DiscreteModel {
    /// States over the states one tick before.
    pub a: StateMatrix,
    /// States over the inputs that held for the tick.
    pub b: InputMatrix,
}

impl DiscreteModel {
    /// Returns what the system does in one tick, exactly.
    pub fn new(model: &LinearModel, tick_s: f64) -> Self {
        const BOTH: usize = STATES + INPUTS;
        let mut rate = SMatrix::<f64, BOTH, BOTH>::zeros();
        rate.fixed_view_mut::<STATES, STATES>(0, 0)
            .copy_from(&(model.a * tick_s));
        rate.fixed_view_mut::<STATES, INPUTS>(0, STATES)
            .copy_from(&(model.b * tick_s));
        // The series of the exponential: a tick is short, so a few terms reach the last bit.
        let mut sum = SMatrix::<f64, BOTH, BOTH>::identity();
        let mut term = sum;
        for order in 1..40 {
            term = term * rate / f64::from(order);
            sum += term;
            if term.amax() < 1e-18 {
                break;
            }
        }
        Self {
            a: sum.fixed_view::<STATES, STATES>(0, 0).into(),
            b: sum.fixed_view::<STATES, INPUTS>(0, STATES).into(),
        }
    }
}
