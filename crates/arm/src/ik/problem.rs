//! What is asked, as the function that a descent makes small.

use nalgebra::{SMatrix, SVector, Vector6};

use super::{Mask, Remaining, pose_error::PoseError};
use crate::kinematics::{Chain, Frame};

/// A target for an arm of `N` joints.
pub(super) struct Problem<'a, const N: usize> {
    chain: &'a Chain,
    target: Frame,
    /// Square roots of the mask's weights.
    scale: Vector6<f64>,
    /// Which parts count: 1 or 0.
    counts: Vector6<f64>,
    /// Error of place in m and of orientation in rad that is small enough.
    tolerance: f64,
    /// Least joint values.
    pub(super) lower: SVector<f64, N>,
    /// Greatest joint values.
    pub(super) upper: SVector<f64, N>,
}

/// Joint values with what is left there.
#[derive(Clone, Copy)]
pub(super) struct Point<const N: usize> {
    pub(super) q: SVector<f64, N>,
    /// Half the weighted square of the error.
    pub(super) cost: f64,
    pub(super) remaining: Remaining,
    /// The weighted error, and how it shrinks with the joint values.
    error: Vector6<f64>,
    shrinking: SMatrix<f64, 6, N>,
}

impl<'a, const N: usize> Problem<'a, N> {
    pub(super) fn new(chain: &'a Chain, target: Frame, mask: Mask, tolerance: f64) -> Self {
        let weights = Vector6::from(mask.weights());
        Self {
            chain,
            target,
            scale: weights.map(f64::sqrt),
            counts: weights.map(|weight| if weight > 0.0 { 1.0 } else { 0.0 }),
            tolerance,
            lower: SVector::repeat(f64::NEG_INFINITY),
            upper: SVector::repeat(f64::INFINITY),
        }
    }

    /// What is left at these joint values.
    #[inline]
    pub(super) fn at(&self, q: SVector<f64, N>) -> Point<N> {
        let (frame, mut shrinking) = self.chain.pose_and_jacobian(&q.data.0[0]);
        let error = PoseError::between(&frame, &self.target);
        let turning = error.turning();
        for mut column in shrinking.column_iter_mut() {
            let turned = turning * column.fixed_rows::<3>(3);
            column.fixed_rows_mut::<3>(3).copy_from(&turned);
            column.component_mul_assign(&self.scale);
        }
        let all = error.all();
        let counted = all.component_mul(&self.counts);
        let error = all.component_mul(&self.scale);
        Point {
            q,
            cost: error.norm_squared() / 2.0,
            remaining: Remaining {
                position_m: counted.fixed_rows::<3>(0).norm(),
                rotation_rad: counted.fixed_rows::<3>(3).norm(),
            },
            error,
            shrinking,
        }
    }

    /// Whether what is left is small enough.
    #[inline]
    pub(super) fn is_solved(&self, point: &Point<N>) -> bool {
        let Remaining {
            position_m,
            rotation_rad,
        } = point.remaining;
        position_m <= self.tolerance && rotation_rad <= self.tolerance
    }

    /// Joint values brought within their limits.
    #[inline]
    pub(super) fn within(&self, q: SVector<f64, N>) -> SVector<f64, N> {
        // Not `clamp`, which panics where a limit is NaN.
        q.sup(&self.lower).inf(&self.upper)
    }

    /// Which joints are at a limit that the way down would cross.
    #[inline]
    pub(super) fn held(&self, point: &Point<N>, down: &SVector<f64, N>) -> [bool; N] {
        std::array::from_fn(|joint| {
            let (q, down) = (point.q[joint], down[joint]);
            (q <= self.lower[joint] && down <= 0.0) || (q >= self.upper[joint] && down >= 0.0)
        })
    }

    /// Which joints are at a limit beyond which the tool would come closer: by a twentieth of what the strongest joint could
    /// do, if the error were along its way. Less is not what keeps the tool away.
    pub(super) fn blocked(&self, point: &Point<N>) -> [bool; N] {
        let down = point.down();
        let held = self.held(point, &down);
        let strongest = point.shrinking.column_iter().map(|it| it.norm());
        let strongest = strongest.fold(0.0, f64::max);
        let least = 0.05 * strongest * point.error.norm();
        std::array::from_fn(|joint| held[joint] && down[joint].abs() > least)
    }
}

impl<const N: usize> Point<N> {
    /// The direction in which the cost falls most steeply.
    #[inline]
    pub(super) fn down(&self) -> SVector<f64, N> {
        self.shrinking.tr_mul(&self.error)
    }

    /// The cost's curvature, as Gauss and Newton take it.
    #[inline]
    pub(super) fn curvature(&self) -> SMatrix<f64, N, N> {
        self.shrinking.tr_mul(&self.shrinking)
    }
}
