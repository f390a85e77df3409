//! Solves least-squares problems with few parameters (Levenberg–Marquardt on the normal equations).

use nalgebra::{SMatrix, SVector};

/// Largest number of steps, far more than a fit that starts near its minimum takes.
const MAX_STEPS: usize = 100;
/// A step that moves no parameter by more than this share of its scale ends the search.
const STILL: f64 = 1e-10;
const MIN_DAMPING: f64 = 1e-12;
const MAX_DAMPING: f64 = 1e12;

/// A residual and its derivatives with respect to the parameters.
pub(super) type Equation<const N: usize> = (f64, SVector<f64, N>);

/// Returns the parameters near `start` with the least sum of squared residuals, or `None` if the samples do not
/// determine them.
pub(super) fn minimise<const N: usize, I>(
    start: SVector<f64, N>,
    equations: impl Fn(&SVector<f64, N>) -> I,
) -> Option<SVector<f64, N>>
where
    I: Iterator<Item = Equation<N>>,
{
    let mut parameters = start;
    let mut system = System::of(equations(&parameters));
    let mut damping = 1e-3;
    for _ in 0..MAX_STEPS {
        let step = system.step(damping)?;
        let next = parameters + step;
        let next_system = System::of(equations(&next));
        let still = step.amax() <= STILL * parameters.amax().max(1.0);
        if next_system.cost.is_finite() && next_system.cost <= system.cost {
            parameters = next;
            system = next_system;
            damping = f64::max(damping * 0.1, MIN_DAMPING);
        } else {
            damping *= 10.0;
        }
        if still || damping > MAX_DAMPING {
            return Some(parameters);
        }
    }
    None
}

/// The normal equations at one point.
struct System<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    gradient: SVector<f64, N>,
    cost: f64,
}

impl<const N: usize> System<N> {
    fn of(equations: impl Iterator<Item = Equation<N>>) -> Self {
        let mut system = Self {
            matrix: SMatrix::zeros(),
            gradient: SVector::zeros(),
            cost: 0.0,
        };
        for (residual, derivatives) in equations {
            system.matrix += derivatives * derivatives.transpose();
            system.gradient += derivatives * residual;
            system.cost += residual * residual;
        }
        system
    }

    /// Returns `None` if a parameter is not determined.
    fn step(&self, damping: f64) -> Option<SVector<f64, N>> {
        let mut matrix = self.matrix;
        for index in 0..N {
            matrix[(index, index)] *= 1.0 + damping;
        }
        Some(-matrix.cholesky()?.solve(&self.gradient))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::*;

    /// The curve y = a·exp(b·x) goes through exact points of a = 2, b = −0.5.
    #[test]
    fn an_exponential_is_recovered_from_a_poor_start() {
        let points: Vec<(f64, f64)> = (0..10)
            .map(|x| (f64::from(x), 2.0 * (-0.5 * f64::from(x)).exp()))
            .collect();
        let found = minimise(Vector2::new(1.0, 0.0), |p| {
            let (a, b) = (p[0], p[1]);
            points.iter().map(move |(x, y)| {
                let curve = (b * x).exp();
                (a * curve - y, Vector2::new(curve, a * x * curve))
            })
        });
        assert!((found.unwrap() - Vector2::new(2.0, -0.5)).norm() < 1e-8);
    }

    #[test]
    fn an_undetermined_parameter_gives_no_fit() {
        let found = minimise(Vector2::new(1.0, 1.0), |p| {
            let residual = p[0] - 3.0;
            (0..4).map(move |_| (residual, Vector2::new(1.0, 0.0)))
        });
        assert_eq!(found, None);
    }
}
