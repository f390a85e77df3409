//! How far the loop is from not holding.

use nalgebra::{Complex, SMatrix, SVector};

use crate::{
    discrete::DiscreteModel,
    model::{GainMatrix, INPUTS, STATES},
    regulator::TICK_S,
    stability::is_stable,
};

/// Frequencies at which the open loop is looked at, evenly spaced in their logarithm.
const FREQUENCIES: usize = 800;
const LOWEST_RPS: f64 = 0.1;
/// Larger factors, and their inverse, count as no limit.
const MOST_FACTOR: f64 = 20.0;
const MOST_EXTRA_TICKS: usize = 40;

/// Margins of one input, all other inputs being as they are.
#[derive(Clone, Copy, Debug)]
pub struct Margins {
    /// Factor on the input's torque below which the loop is unstable; 0.05 stands for less.
    pub least_gain: f64,
    /// Factor on the input's torque above which the loop is unstable; 20 stands for more.
    pub most_gain: f64,
    /// Least phase at which the loop broken at this input has gain 1, from instability, rad; π if it has none.
    pub phase_rad: f64,
    /// Least distance of the loop broken at this input from −1.
    pub modulus: f64,
}

/// Returns the margins of every input of a loop whose torques come `delay_ticks` late.
pub fn margins(model: &DiscreteModel, gains: &GainMatrix, delay_ticks: usize) -> [Margins; INPUTS] {
    [0, 1, 2, 3].map(|input| {
        let holds = |factor: f64| {
            let mut scaled = *gains;
            scaled.row_mut(input).scale_mut(factor);
            is_stable(model, &scaled, delay_ticks)
        };
        let (mut phase_rad, mut modulus) = (std::f64::consts::PI, f64::INFINITY);
        let mut before: Option<Complex<f64>> = None;
        for frequency_rps in frequencies_rps() {
            let open = open_loop(model, gains, delay_ticks, input, frequency_rps);
            modulus = modulus.min((open + 1.0).norm());
            let crosses = before.is_some_and(|it| (it.norm() > 1.0) != (open.norm() > 1.0));
            if crosses {
                phase_rad = phase_rad.min((-open).arg().abs());
            }
            before = Some(open);
        }
        Margins {
            least_gain: last_that(holds, 1.0 / MOST_FACTOR),
            most_gain: last_that(holds, MOST_FACTOR),
            phase_rad,
            modulus,
        }
    })
}

/// Returns how many ticks later all torques may come, up to 40.
pub fn extra_delay_ticks(model: &DiscreteModel, gains: &GainMatrix, delay_ticks: usize) -> usize {
    (1..=MOST_EXTRA_TICKS)
        .find(|extra| !is_stable(model, gains, delay_ticks + extra))
        .map_or(MOST_EXTRA_TICKS, |extra| extra - 1)
}

/// Returns the factor nearest to `end` up to which, from 1, the loop holds.
fn last_that(holds: impl Fn(f64) -> bool, end: f64) -> f64 {
    if holds(end) {
        return end;
    }
    let (mut good, mut bad) = (0.0, end.ln());
    for _ in 0..12 {
        let middle: f64 = (good + bad) / 2.0;
        if holds(middle.exp()) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    good.exp()
}

fn frequencies_rps() -> impl Iterator<Item = f64> {
    let highest_rps = std::f64::consts::PI / TICK_S;
    let span = (highest_rps / LOWEST_RPS).ln();
    (0..FREQUENCIES).map(move |i| LOWEST_RPS * (span * i as f64 / FREQUENCIES as f64).exp())
}

/// Returns what comes back at `input`, negated, of what goes in there.
fn open_loop(
    model: &DiscreteModel,
    gains: &GainMatrix,
    delay_ticks: usize,
    input: usize,
    frequency_rps: f64,
) -> Complex<f64> {
    let turn = Complex::from_polar(1.0, frequency_rps * TICK_S);
    let late = turn.powi(-i32::try_from(delay_ticks).unwrap_or(i32::MAX));
    let mut others = *gains;
    others.row_mut(input).fill(0.0);
    let feedback = model.b * others;
    let system = SMatrix::<Complex<f64>, STATES, STATES>::from_fn(|i, j| {
        let own = if i == j { turn } else { Complex::ZERO };
        own - model.a[(i, j)] + late * feedback[(i, j)]
    });
    let driven = SVector::<Complex<f64>, STATES>::from_fn(|i, _| late * model.b[(i, input)]);
    let Some(states) = system.lu().solve(&driven) else {
        return Complex::new(f64::INFINITY, 0.0);
    };
    (0..STATES).map(|j| states[j] * gains[(input, j)]).sum()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use robot_description::Robot;

    use super::*;
    use crate::regulator::{Regulator, delay_ticks};

    /// Gains are bounded by whether the loop holds in time, phases by the frequency response. At a bound the response,
    /// times the factor, passes through −1.
    #[test]
    fn the_response_passes_through_minus_one_where_the_loop_ceases_to_hold() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/fivebar.toml");
        let robot = Robot::read(Path::new(file)).expect("a robot of this repository");
        let regulator = Regulator::new(&robot, [0.2; 2]).expect("gains");
        let (model, gains) = (&regulator.discrete, &regulator.gains);
        // So late that the bounds lie at frequencies where the delay matters.
        let delay = delay_ticks(&robot) + 8;
        let mut bounds = 0;
        for (input, margins) in margins(model, gains, delay).iter().enumerate() {
            for factor in [margins.least_gain, margins.most_gain] {
                if factor == MOST_FACTOR || factor == 1.0 / MOST_FACTOR {
                    continue;
                }
                let distances = frequencies_rps()
                    .map(|rps| (open_loop(model, gains, delay, input, rps) * factor + 1.0).norm());
                let nearest = distances.fold(f64::INFINITY, f64::min);
                assert!(nearest < 0.06, "input {input}, {factor}: {nearest}");
                bounds += 1;
            }
            let least_rad = 2.0 * (margins.modulus / 2.0).asin();
            assert!(margins.phase_rad > least_rad - 0.02, "{margins:?}");
        }
        assert!(bounds >= 4, "{bounds}");
    }
}
