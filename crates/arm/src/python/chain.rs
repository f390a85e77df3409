//! What an arm is described with.

use pyo3::{exceptions::PyValueError, prelude::*};

use super::numbers::{isometry, refused};
use crate::kinematics::{DhConvention, DhRow, ElementaryTransform, Joint, JointKind, Robot};

/// An elementary transform: `ET.Rz(0.3)` is fixed, and `ET.Rz()` a joint.
#[pyclass(name = "ET", module = "jiling_arm.ik.et", frozen)]

pub(super) struct PyEt(pub(super) ElementaryTransform);

type Make = fn(f64) -> ElementaryTransform;

fn et(eta: Option<f64>, flip: bool, fixed: Make, joint: fn() -> ElementaryTransform) -> PyEt {
    let transform = eta.map_or_else(joint, fixed);
    PyEt(if flip { transform.flipped() } else { transform })
}

#[pymethods]
#[expect(non_snake_case, reason = "the names of roboticstoolbox")]
impl PyEt {
    #[staticmethod]
    #[pyo3(signature = (eta=None, flip=false))]
    fn Rx(eta: Option<f64>, flip: bool) -> Self {
        et(
            eta,
            flip,
            ElementaryTransform::rx,
            ElementaryTransform::joint_rx,
        )
    }

    #[staticmethod]
    #[pyo3(signature = (eta=None, flip=false))]
    fn Ry(eta: Option<f64>, flip: bool) -> Self {
        et(
            eta,
            flip,
            ElementaryTransform::ry,
            ElementaryTransform::joint_ry,
        )
    }

    #[staticmethod]
    #[pyo3(signature = (eta=None, flip=false))]
    fn Rz(eta: Option<f64>, flip: bool) -> Self {
        et(
            eta,
            flip,
            ElementaryTransform::rz,
            ElementaryTransform::joint_rz,
        )
    }

    #[staticmethod]
    #[pyo3(signature = (eta=None, flip=false))]
    fn tx(eta: Option<f64>, flip: bool) -> Self {
        et(
            eta,
            flip,
            ElementaryTransform::tx,
            ElementaryTransform::joint_tx,
        )
    }

    #[staticmethod]
    #[pyo3(signature = (eta=None, flip=false))]
    fn ty(eta: Option<f64>, flip: bool) -> Self {
        et(
            eta,
            flip,
            ElementaryTransform::ty,
            ElementaryTransform::joint_ty,
        )
    }

    #[staticmethod]
    #[pyo3(signature = (eta=None, flip=false))]
    fn tz(eta: Option<f64>, flip: bool) -> Self {
        et(
            eta,
            flip,
            ElementaryTransform::tz,
            ElementaryTransform::joint_tz,
        )
    }

    /// A fixed pose, 4 x 4.
    #[staticmethod]
    fn SE3(pose: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self(ElementaryTransform::Fixed(isometry(pose)?)))
    }

    #[getter]
    fn isjoint(&self) -> bool {
        matches!(self.0, ElementaryTransform::Joint { .. })
    }
}

/// A row of Denavit-Hartenberg parameters.
#[pyclass(name = "DHLink", module = "jiling_arm.ik.DH", frozen)]

pub(super) struct PyDhLink(DhRow);

#[pymethods]
impl PyDhLink {
    #[new]
    #[pyo3(signature = (d=0.0, alpha=0.0, theta=0.0, a=0.0, prismatic=false, flip=false))]
    fn new(d: f64, alpha: f64, theta: f64, a: f64, prismatic: bool, flip: bool) -> Self {
        let kind = if prismatic {
            JointKind::Prismatic
        } else {
            JointKind::Revolute
        };
        Self(DhRow {
            kind,
            d_m: d,
            a_m: a,
            alpha_rad: alpha,
            theta_rad: theta,
            flipped: flip,
        })
    }
}

/// Joints of these names and limits, `[[lower, ...], [upper, ...]]`.
fn joints(names: &[String], qlim: Option<[Vec<f64>; 2]>) -> PyResult<Vec<Joint>> {
    let [lower, upper] = qlim.unwrap_or_else(|| {
        let pi = std::f64::consts::PI;
        [vec![-pi; names.len()], vec![pi; names.len()]]
    });
    if [lower.len(), upper.len()] != [names.len(); 2] {
        let message = "qlim is [[lower, ...], [upper, ...]] with one of each for every joint";
        return Err(PyValueError::new_err(message));
    }
    let limits = lower.into_iter().zip(upper);
    let joints = names
        .iter()
        .zip(limits)
        .map(|(name, (lower, upper))| Joint::new(name, lower, upper));
    joints.collect::<Result<_, _>>().map_err(refused)
}

pub(super) fn from_ets(
    ets: &[PyRef<'_, PyEt>],
    names: &[String],
    qlim: Option<[Vec<f64>; 2]>,
    name: &str,
) -> PyResult<Robot> {
    let transforms = ets.iter().map(|et| et.0).collect();
    Robot::from_elementary(name, transforms, joints(names, qlim)?).map_err(refused)
}

pub(super) fn from_dh(
    links: &[PyRef<'_, PyDhLink>],
    names: &[String],
    qlim: Option<[Vec<f64>; 2]>,
    is_modified: bool,
    name: &str,
) -> PyResult<Robot> {
    let rows: Vec<_> = links.iter().map(|link| link.0).collect();
    let convention = if is_modified {
        DhConvention::Modified
    } else {
        DhConvention::Standard
    };
    Robot::from_dh(name, convention, &rows, joints(names, qlim)?).map_err(refused)
}
