//! A pose from a 4 × 4 matrix.

use nalgebra::{IsometryMatrix3, Matrix3, Matrix4, Rotation3, RowVector4};

use super::IkError;
use crate::kinematics::KinematicsError;

/// Off by this much, a rotation matrix was rounded; by more, it is none.
const ROUNDED: f64 = 1e-3;
/// Off by less, it is taken as it is.
const EXACT: f64 = 1e-9;

/// The pose that a homogeneous matrix stands for. A rotation of three or more digits is made exact.
///
/// # Errors
/// The matrix holds NaN or infinity, its last row is not `0 0 0 1`, or its rotation part is no rotation.
pub fn pose_of(matrix: &Matrix4<f64>) -> Result<IsometryMatrix3<f64>, IkError> {
    if !matrix.iter().all(|it| it.is_finite()) {
        let what = "the target";
        return Err(KinematicsError::NotFinite { what }.into());
    }
    let last = RowVector4::new(0.0, 0.0, 0.0, 1.0);
    if (matrix.row(3) - last).amax() > EXACT {
        return Err(IkError::NoPose("its last row is not 0 0 0 1"));
    }
    let rotation: Matrix3<f64> = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    let off = (rotation.transpose() * rotation - Matrix3::identity()).amax();
    if off > ROUNDED {
        let why = "the columns of its rotation are not at right angles and of length 1";
        return Err(IkError::NoPose(why));
    }
    if rotation.determinant() < 0.0 {
        return Err(IkError::NoPose("its rotation is a mirror"));
    }
    let rotation = if off > EXACT {
        Rotation3::from_matrix(&rotation)
    } else {
        Rotation3::from_matrix_unchecked(rotation)
    };
    let place = matrix.fixed_view::<3, 1>(0, 3).into_owned();
    Ok(IsometryMatrix3::from_parts(place.into(), rotation))
}
