//! Arrays and errors on their way between NumPy and nalgebra.

use std::fmt::Display;

use nalgebra::{IsometryMatrix3, Matrix4, Matrix6xX};
use numpy::{
    AllowTypeChange, PyArray1, PyArray2, PyArrayLike1, PyArrayLike2, ToPyArray, ndarray::Array2,
};
use pyo3::{exceptions::PyValueError, prelude::*};

use crate::ik::pose_of;

/// Anything that NumPy makes a row of numbers of.
pub(super) type Row<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;

pub(super) type Square<'py> = Bound<'py, PyArray2<f64>>;

pub(super) fn values(row: &Row<'_>) -> Vec<f64> {
    row.as_array().iter().copied().collect()
}

pub(super) fn row(py: Python<'_>, values: Vec<f64>) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_vec(py, values)
}

/// A 4 × 4 matrix of anything that NumPy makes one of, or of spatialmath's SE3, whose matrix is called `A`.
pub(super) fn matrix(pose: &Bound<'_, PyAny>) -> PyResult<Matrix4<f64>> {
    let inner = pose.getattr_opt("A")?;
    let pose = inner.as_ref().unwrap_or(pose);
    let pose: PyArrayLike2<'_, f64, AllowTypeChange> = pose.extract()?;
    let array = pose.as_array();
    if array.dim() == (4, 4) {
        return Ok(Matrix4::from_row_iterator(array.iter().copied()));
    }
    let (rows, columns) = array.dim();
    let message = format!("a pose of {rows} x {columns} numbers, and 4 x 4 are needed");
    Err(PyValueError::new_err(message))
}

pub(super) fn isometry(pose: &Bound<'_, PyAny>) -> PyResult<IsometryMatrix3<f64>> {
    pose_of(&matrix(pose)?).map_err(refused)
}

pub(super) fn square<'py>(py: Python<'py>, pose: &IsometryMatrix3<f64>) -> Square<'py> {
    let matrix = pose.to_homogeneous();
    Array2::from_shape_fn((4, 4), |at| matrix[at]).to_pyarray(py)
}

pub(super) fn jacobian<'py>(py: Python<'py>, matrix: &Matrix6xX<f64>) -> Square<'py> {
    Array2::from_shape_fn((6, matrix.ncols()), |at| matrix[at]).to_pyarray(py)
}

pub(super) fn refused(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
