//! State feedback whose gains follow the lengths of both legs.

use crate::{domain::GainSchedule, math::scalar};

/// Number of states.
pub const STATES: usize = 10;
/// Number of inputs: left wheel, right wheel, left leg, right leg.
pub const INPUTS: usize = 4;

/// The gains for the present lengths of the legs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    rows: [[f32; STATES]; INPUTS],
    /// The row that is renewed next.
    next: usize,
}

impl Gains {
    /// The gains for legs of these lengths in m.
    pub fn new(schedule: &GainSchedule, lengths_m: [f32; 2]) -> Self {
        let terms = terms(schedule, lengths_m);
        Self {
            rows: schedule.k.map(|row| evaluate(&row, &terms)),
            next: 0,
        }
    }

    /// Renews one row, as a tick has little time. Legs change their lengths little in four ticks.
    pub fn renew(&mut self, schedule: &GainSchedule, lengths_m: [f32; 2]) {
        let terms = terms(schedule, lengths_m);
        if let (Some(row), Some(polynomials)) =
            (self.rows.get_mut(self.next), schedule.k.get(self.next))
        {
            *row = evaluate(polynomials, &terms);
        }
        self.next = self.next.wrapping_add(1) % INPUTS;
    }

    /// Torques in N·m for this distance of the state from its reference.
    pub fn torques_nm(&self, error: &[f32; STATES]) -> [f32; INPUTS] {
        self.rows.each_ref().map(|row| {
            let products = row.iter().zip(error).map(|(gain, error)| gain * error);
            -products.sum::<f32>()
        })
    }
}

/// 1, l, r, l², l·r, r², within the lengths for which the polynomials hold.
fn terms(schedule: &GainSchedule, lengths_m: [f32; 2]) -> [f32; 6] {
    let [l, r] = lengths_m.map(|length_m| {
        scalar::clamp(length_m, schedule.min_m, schedule.max_m) - schedule.centre_m
    });
    [1.0, l, r, l * l, l * r, r * r]
}

fn evaluate(polynomials: &[[f32; 6]; STATES], terms: &[f32; 6]) -> [f32; STATES] {
    polynomials
        .each_ref()
        .map(|p| p.iter().zip(terms).map(|(a, term)| a * term).sum())
}

#[cfg(test)]
mod tests;
