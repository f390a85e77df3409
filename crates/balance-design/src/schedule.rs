//! Gains as functions of both leg lengths.

use nalgebra::{SMatrix, SVector};
use robot_description::Robot;

use crate::{
    DesignError,
    model::{GainMatrix, INPUTS, STATES},
    regulator::{Regulator, delay_ticks},
    stability::is_stable,
};

/// Number of coefficients of a gain: those of 1, l, r, l², l·r, r².
pub const COEFFICIENTS: usize = 6;
/// Lengths a leg at which gains are designed and fitted.
const FITTED: usize = 7;
/// The loop must hold with torques that come so much later than the file says.
const EXTRA_DELAY_TICKS: usize = 5;

/// Each of the gains is a quadratic function of l and r, by which the left and the right leg are longer than `centre_m`.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// Leg length in m from which the lengths count.
    pub centre_m: f64,
    /// Shortest leg length in m for which the fit holds.
    pub min_m: f64,
    /// Longest leg length in m for which the fit holds.
    pub max_m: f64,
    /// Coefficients of 1, l, r, l², l·r, r², with l and r in m; by input and state.
    pub coefficients: [[[f64; COEFFICIENTS]; STATES]; INPUTS],
    /// Largest deviation of the fit anywhere, as a part of the largest value of that gain.
    pub worst_fit: f64,
}

impl Schedule {
    /// Designs gains over the leg's range, fits them, and checks that the loop holds with the fitted ones.
    ///
    /// # Errors
    /// [`DesignError`] where the design has no solution or the loop does not hold with 5 ms more delay.
    pub fn new(robot: &Robot) -> Result<Self, DesignError> {
        let (min_m, max_m) = (robot.legs.min_m, robot.legs.max_m);
        let centre_m = (min_m + max_m) / 2.0;
        let lengths = lengths_m(min_m, max_m, FITTED);
        let mut designs = Vec::with_capacity(FITTED * FITTED);
        for (i, left_m) in lengths.iter().enumerate() {
            for right_m in lengths.iter().skip(i) {
                let length_m = [*left_m, *right_m];
                let regulator = Regulator::new(robot, length_m)?;
                let gains = regulator.gains;
                designs.push((length_m, gains, regulator));
            }
        }
        let samples = designs.iter().flat_map(|(length_m, gains, _)| {
            let [left_m, right_m] = *length_m;
            // The mirror image, which on the diagonal is the same robot.
            [
                ([left_m, right_m], *gains),
                ([right_m, left_m], mirrored(gains)),
            ]
        });
        let samples: Vec<_> = samples.collect();
        let coefficients = fit(centre_m, &samples);
        let mut schedule = Self {
            centre_m,
            min_m,
            max_m,
            coefficients,
            worst_fit: 0.0,
        };
        schedule.worst_fit = schedule.deviation(&samples);
        for (length_m, _, regulator) in &designs {
            schedule.hold(robot, *length_m, regulator)?;
        }
        Ok(schedule)
    }

    /// Returns the gains at these lengths of the left and the right leg, in m.
    pub fn gains(&self, length_m: [f64; 2]) -> GainMatrix {
        let terms = terms(self.centre_m, length_m);
        GainMatrix::from_fn(|input, state| {
            let coefficients = &self.coefficients[input][state];
            coefficients.iter().zip(&terms).map(|(c, t)| c * t).sum()
        })
    }

    /// Checks that the loop holds at the delay of the file and at a longer one.
    fn hold(
        &self,
        robot: &Robot,
        length_m: [f64; 2],
        regulator: &Regulator,
    ) -> Result<(), DesignError> {
        let gains = self.gains(length_m);
        let delay = delay_ticks(robot);
        for ticks in [delay, delay + EXTRA_DELAY_TICKS] {
            if !is_stable(&regulator.discrete, &gains, ticks) {
                return Err(DesignError::Unstable {
                    left_m: length_m[0],
                    right_m: length_m[1],
                    delay_ms: ticks,
                });
            }
        }
        Ok(())
    }

    fn deviation(&self, samples: &[([f64; 2], GainMatrix)]) -> f64 {
        let mut largest = GainMatrix::zeros();
        let mut deviation = GainMatrix::zeros();
        for (length_m, gains) in samples {
            largest = largest.sup(&gains.abs());
            deviation = deviation.sup(&(self.gains(*length_m) - gains).abs());
        }
        deviation.component_div(&largest).max()
    }
}

/// Returns `count` lengths from the shortest to the longest, evenly spaced.
pub fn lengths_m(min_m: f64, max_m: f64, count: usize) -> Vec<f64> {
    let step_m = (max_m - min_m) / (count - 1) as f64;
    (0..count).map(|i| min_m + step_m * i as f64).collect()
}

/// Returns the gains of the robot's mirror image: left and right change places, and yaw its sign.
fn mirrored(gains: &GainMatrix) -> GainMatrix {
    let input = [1, 0, 3, 2];
    let state = [0, 1, 2, 3, 6, 7, 4, 5, 8, 9];
    GainMatrix::from_fn(|i, j| {
        let sign = if j == 2 || j == 3 { -1.0 } else { 1.0 };
        sign * gains[(input[i], state[j])]
    })
}

fn terms(centre_m: f64, length_m: [f64; 2]) -> [f64; COEFFICIENTS] {
    let [l, r] = length_m.map(|length| length - centre_m);
    [1.0, l, r, l * l, l * r, r * r]
}

/// Least squares over all samples, for each gain.
fn fit(
    centre_m: f64,
    samples: &[([f64; 2], GainMatrix)],
) -> [[[f64; COEFFICIENTS]; STATES]; INPUTS] {
    // Lengths in tenths of a metre keep the normal equations well scaled.
    let scale = terms(0.0, [0.1, 0.1]);
    let scale = SVector::<f64, COEFFICIENTS>::from(scale);
    let row = |length_m: [f64; 2]| {
        SVector::<f64, COEFFICIENTS>::from(terms(centre_m, length_m)).component_div(&scale)
    };
    let mut normal = SMatrix::<f64, COEFFICIENTS, COEFFICIENTS>::zeros();
    for (length_m, _) in samples {
        normal += row(*length_m) * row(*length_m).transpose();
    }
    let solver = normal.lu();
    let mut coefficients = [[[0.0; COEFFICIENTS]; STATES]; INPUTS];
    for (input, gains_of_input) in coefficients.iter_mut().enumerate() {
        for (state, of_gain) in gains_of_input.iter_mut().enumerate() {
            let mut wanted = SVector::<f64, COEFFICIENTS>::zeros();
            for (length_m, gains) in samples {
                wanted += row(*length_m) * gains[(input, state)];
            }
            if let Some(solution) = solver.solve(&wanted) {
                *of_gain = solution.component_div(&scale).into();
            }
        }
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn robot(name: &str) -> Robot {
        let file = format!("{}/../../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        Robot::read(Path::new(&file)).expect("a robot of this repository")
    }

    #[test]
    fn the_mirror_image_of_the_robot_has_mirrored_gains() {
        let schedule = Schedule::new(&robot("fivebar")).expect("a loop that holds");
        let [left_m, right_m] = [0.15, 0.24];
        let here = schedule.gains([left_m, right_m]);
        let there = mirrored(&schedule.gains([right_m, left_m]));
        assert!((here - there).amax() < 1e-9 * here.amax(), "{here}{there}");
        let own = Regulator::new(&robot("fivebar"), [left_m, right_m]).expect("gains");
        let mirror = Regulator::new(&robot("fivebar"), [right_m, left_m]).expect("gains");
        assert!((own.gains - mirrored(&mirror.gains)).amax() < 1e-6);
    }

    #[test]
    fn the_loop_holds_between_the_fitted_lengths() {
        for name in ["fivebar", "fivebar-rs00"] {
            let robot = robot(name);
            let schedule = Schedule::new(&robot).expect("a loop that holds");
            let lengths = lengths_m(schedule.min_m, schedule.max_m, 12);
            for left_m in &lengths {
                for right_m in &lengths {
                    let length_m = [*left_m, *right_m];
                    let regulator = Regulator::new(&robot, length_m).expect("gains");
                    let held = schedule.hold(&robot, length_m, &regulator);
                    assert_eq!(held, Ok(()), "{name}");
                }
            }
        }
    }

    #[test]
    fn weights_without_a_solution_are_an_error() {
        let mut robot = robot("fivebar");
        robot.control.weights.r[1] = 0.0;
        let error = Schedule::new(&robot).expect_err("a wheel that costs nothing");
        assert!(matches!(error, DesignError::Cost { .. }), "{error}");
    }

    #[test]
    fn a_loop_that_cannot_wait_is_an_error() {
        let mut robot = robot("fivebar");
        robot.control.delay_s = 0.03;
        let error = Schedule::new(&robot).expect_err("torques come too late");
        assert!(matches!(error, DesignError::Unstable { .. }), "{error}");
    }
}
