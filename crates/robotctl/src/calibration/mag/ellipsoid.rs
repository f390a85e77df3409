//! Fits an ellipsoid to points by linear least squares, as the start of the nonlinear fit.

use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector3};

/// Smallest ratio of the shortest to the longest semi-axis. Points from one turn form a disc, which is flatter.
const MIN_AXIS_RATIO: f64 = 0.2;

/// The surface |shape · (point − centre)| = 1, where `shape` is symmetric and positive definite.
pub(super) struct Ellipsoid {
    pub centre: Vector3<f64>,
    pub shape: Matrix3<f64>,
}

impl Ellipsoid {
    /// Solves x'Mx + 2n'x = 1, which is linear in its nine unknowns. It returns `None` if the points lie on no
    /// ellipsoid.
    pub fn through(points: &[Vector3<f64>]) -> Option<Self> {
        // Around their mean and of size 1, so that squares and products are of one order.
        let mean = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
        let size = points.iter().map(|p| (p - mean).norm()).sum::<f64>() / points.len() as f64;
        let scaled = points.iter().map(|p| (p - mean) / size);
        let [xx, yy, zz, xy, xz, yz, x, y, z] = quadric(scaled)?.data.0[0];
        let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let linear = Vector3::new(x, y, z);

        let centre = -(matrix.try_inverse()? * linear);
        let at_centre = 1.0 - linear.dot(&centre);
        let unit = SymmetricEigen::new(matrix / at_centre);
        let (least, most) = (unit.eigenvalues.min(), unit.eigenvalues.max());
        let closed = least > 0.0 && (least / most).sqrt() >= MIN_AXIS_RATIO;
        let root = SymmetricEigen {
            eigenvalues: unit.eigenvalues.map(f64::sqrt),
            eigenvectors: unit.eigenvectors,
        };
        closed.then(|| Self {
            centre: mean + centre * size,
            shape: root.recompose() / size,
        })
    }
}

fn quadric(points: impl Iterator<Item = Vector3<f64>>) -> Option<SVector<f64, 9>> {
    let mut matrix = SMatrix::<f64, 9, 9>::zeros();
    let mut right = SVector::<f64, 9>::zeros();
    for p in points {
        let (x, y, z) = (p.x, p.y, p.z);
        let row = SVector::<f64, 9>::from([
            x * x,
            y * y,
            z * z,
            2.0 * x * y,
            2.0 * x * z,
            2.0 * y * z,
            2.0 * x,
            2.0 * y,
            2.0 * z,
        ]);
        matrix += row * row.transpose();
        right += row;
    }
    Some(matrix.cholesky()?.solve(&right))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a point of ((x − 1)/4)² + ((y + 2)/3)² + (z/2)² = 1 by its two angles.
    #[test]
    fn exact_points_give_the_ellipsoid() {
        let mut points = Vec::new();
        for latitude in -4..=4 {
            for longitude in 0..8 {
                let (a, b) = (f64::from(latitude) * 0.35, f64::from(longitude) * 0.79);
                points.push(Vector3::new(
                    1.0 + 4.0 * a.cos() * b.cos(),
                    -2.0 + 3.0 * a.cos() * b.sin(),
                    2.0 * a.sin(),
                ));
            }
        }
        let found = Ellipsoid::through(&points).unwrap();
        let shape = Matrix3::from_diagonal(&Vector3::new(1.0 / 4.0, 1.0 / 3.0, 1.0 / 2.0));
        assert!((found.centre - Vector3::new(1.0, -2.0, 0.0)).norm() < 1e-9);
        assert!((found.shape - shape).norm() < 1e-9, "{}", found.shape);
    }

    #[test]
    fn a_circle_is_no_ellipsoid() {
        let circle: Vec<_> = (0..100)
            .map(|i| f64::from(i) * 0.1)
            .map(|a| Vector3::new(20.0 * a.cos(), 20.0 * a.sin(), -40.0))
            .collect();
        assert!(Ellipsoid::through(&circle).is_none());
    }
}
