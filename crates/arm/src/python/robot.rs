//! `Robot`, as the arm's scripts know it.

use std::{collections::BTreeMap, fs, path::PathBuf};

use nalgebra::{IsometryMatrix3, Matrix4};
use numpy::{PyArray1, PyArray2};
use pyo3::{
    exceptions::{PyOSError, PyTypeError},
    prelude::*,
    types::PyDict,
};

use super::{
    chain::{PyDhLink, PyEt, from_dh, from_ets},
    numbers::{Row, Square, isometry, jacobian, matrix, refused, row, square, values},
};
use crate::{
    ik::{IkError, Mask, Solution, Solver, pose_of},
    kinematics::{Gear, Robot, create_so101_5dof as so101},
};

/// Joint values, whether they bring the tool to the target, and why or why not.
type Answer<'py> = (Bound<'py, PyArray1<f64>>, bool, String);

/// A serial arm.
#[pyclass(name = "Robot", module = "jiling_arm.ik.robot")]
pub(super) struct PyRobot {
    robot: Robot,
    /// Live dictionaries, since scripts write `robot.gear_sign["elbow_flex"] = -1`.
    gear_sign: Py<PyDict>,
    gear_ratio: Py<PyDict>,
}

/// The SO-101 without its gripper: five joints.
#[pyfunction]
pub(super) fn create_so101_5dof(py: Python<'_>) -> PyResult<PyRobot> {
    PyRobot::around(py, so101())
}

#[pymethods]
impl PyRobot {
    /// A chain of elementary transforms.
    #[new]
    #[pyo3(signature = (ets, joint_names, qlim=None, name="arm"))]
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 gives them away")]
    fn new(
        py: Python<'_>,
        ets: Vec<PyRef<'_, PyEt>>,
        joint_names: Vec<String>,
        qlim: Option<[Vec<f64>; 2]>,
        name: &str,
    ) -> PyResult<Self> {
        Self::around(py, from_ets(&ets, &joint_names, qlim, name)?)
    }

    /// A chain of Denavit-Hartenberg rows.
    #[staticmethod]
    #[pyo3(signature = (links, joint_names, qlim=None, modified=false, name="arm"))]
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 gives them away")]
    fn from_dh(
        py: Python<'_>,
        links: Vec<PyRef<'_, PyDhLink>>,
        joint_names: Vec<String>,
        qlim: Option<[Vec<f64>; 2]>,
        modified: bool,
        name: &str,
    ) -> PyResult<Self> {
        Self::around(py, from_dh(&links, &joint_names, qlim, modified, name)?)
    }

    /// The arm between two links of a URDF file.
    #[staticmethod]
    #[pyo3(signature = (path, base=None, tip=None))]
    fn from_urdf(
        py: Python<'_>,
        path: PathBuf,
        base: Option<&str>,
        tip: Option<&str>,
    ) -> PyResult<Self> {
        let file = path.display();
        let urdf = fs::read_to_string(&path)
            .map_err(|error| PyOSError::new_err(format!("{file}: cannot be read: {error}")))?;
        let robot = Robot::from_urdf(&urdf, base, tip);
        Self::around(
            py,
            robot.map_err(|error| refused(format!("{file}: {error}")))?,
        )
    }

    #[getter]
    fn name(&self) -> &str {
        self.robot.name()
    }

    #[getter]
    fn n(&self) -> usize {
        self.robot.joints().len()
    }

    #[getter]
    fn joint_names(&self) -> Vec<&str> {
        self.robot.joint_names().collect()
    }

    /// Limits: `[[lower, ...], [upper, ...]]`.
    #[getter]
    fn qlim<'py>(&self, py: Python<'py>) -> PyResult<Square<'py>> {
        let joints = self.robot.joints().iter();
        let (lower, upper) = joints.map(|it| (it.lower(), it.upper())).unzip();
        Ok(PyArray2::from_vec2(py, &[lower, upper])?)
    }

    #[getter]
    fn gear_sign(&self, py: Python<'_>) -> Py<PyDict> {
        self.gear_sign.clone_ref(py)
    }

    #[setter]
    fn set_gear_sign(&mut self, signs: Py<PyDict>) {
        self.gear_sign = signs;
    }

    #[getter]
    fn gear_ratio(&self, py: Python<'_>) -> Py<PyDict> {
        self.gear_ratio.clone_ref(py)
    }

    #[setter]
    fn set_gear_ratio(&mut self, ratios: Py<PyDict>) {
        self.gear_ratio = ratios;
    }

    #[getter]
    fn base<'py>(&self, py: Python<'py>) -> Square<'py> {
        square(py, self.robot.base())
    }

    #[setter]
    fn set_base(&mut self, pose: &Bound<'_, PyAny>) -> PyResult<()> {
        self.robot.set_base(isometry(pose)?).map_err(refused)
    }

    #[getter]
    fn tool<'py>(&self, py: Python<'py>) -> Square<'py> {
        square(py, self.robot.tool())
    }

    #[setter]
    fn set_tool(&mut self, pose: &Bound<'_, PyAny>) -> PyResult<()> {
        self.robot.set_tool(isometry(pose)?).map_err(refused)
    }

    /// Pose of the tool in the world, 4 x 4.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 gives it away")]
    fn fkine<'py>(&self, py: Python<'py>, q: Row<'py>) -> PyResult<Square<'py>> {
        let pose = self.robot.fkine(&values(&q)).map_err(refused)?;
        Ok(square(py, &pose))
    }

    /// Jacobian along the world's axes, 6 x n.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 gives it away")]
    fn jacob0<'py>(&self, py: Python<'py>, q: Row<'py>) -> PyResult<Square<'py>> {
        let matrix = self.robot.jacob0(&values(&q)).map_err(refused)?;
        Ok(jacobian(py, &matrix))
    }

    /// Jacobian along the tool's axes, 6 x n.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 gives it away")]
    fn jacobe<'py>(&self, py: Python<'py>, q: Row<'py>) -> PyResult<Square<'py>> {
        let matrix = self.robot.jacobe(&values(&q)).map_err(refused)?;
        Ok(jacobian(py, &matrix))
    }

    /// Joint values for a pose of the tool: `(q, success, reason)`.
    #[pyo3(signature = (Tep, q0=None, mask=None, *, tol=1e-6, searches=100, seed=0))]
    #[expect(
        clippy::too_many_arguments,
        non_snake_case,
        reason = "Python names them"
    )]
    fn ikine_LM<'py>(
        &self,
        py: Python<'py>,
        Tep: &Bound<'py, PyAny>,
        q0: Option<Row<'py>>,
        mask: Option<Row<'py>>,
        tol: f64,
        searches: usize,
        seed: u64,
    ) -> PyResult<Answer<'py>> {
        let q0 = q0.map_or_else(|| self.robot.middle(), |q0| values(&q0));
        let (target, mask) = (matrix(Tep)?, mask.map(|mask| values(&mask)));
        let solver = Solver {
            tolerance: tol,
            searches,
            seed,
        };
        let robot = &self.robot;
        let solve = |target: IsometryMatrix3<f64>, mask| solver.solve(robot, &target, &q0, mask);
        Ok(answer(py, &q0, || ask(&target, mask.as_deref(), solve)))
    }

    /// One bounded step towards a pose, for control in real time: `(q, success, reason)`.
    #[pyo3(signature = (Tep, q, mask=None, *, largest_change=0.05, tol=1e-6))]
    #[expect(non_snake_case, reason = "Python names them")]
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 gives it away")]
    fn ik_follow<'py>(
        &self,
        py: Python<'py>,
        Tep: &Bound<'py, PyAny>,
        q: Row<'py>,
        mask: Option<Row<'py>>,
        largest_change: f64,
        tol: f64,
    ) -> PyResult<Answer<'py>> {
        let q = values(&q);
        let (target, mask) = (matrix(Tep)?, mask.map(|mask| values(&mask)));
        let solver = Solver {
            tolerance: tol,
            ..Solver::default()
        };
        let robot = &self.robot;
        let solve = |target: IsometryMatrix3<f64>, mask| {
            solver.follow(robot, &target, &q, mask, largest_change)
        };
        Ok(answer(py, &q, || ask(&target, mask.as_deref(), solve)))
    }

    /// Servo steps for joint angles in rad, by name.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 gives it away")]
    fn q_to_servo_targets(
        &mut self,
        py: Python<'_>,
        q_rad: Row<'_>,
        joint_names: Vec<String>,
        home_pose: BTreeMap<String, i32>,
    ) -> PyResult<BTreeMap<String, i32>> {
        self.take_gears(py)?;
        let q_rad = values(&q_rad);
        let targets = self
            .robot
            .q_to_servo_targets(&q_rad, &joint_names, &home_pose);
        targets.map_err(refused)
    }

    /// Joint angles in rad, of `positions` or of the arm that `home_pose` belongs to.
    #[pyo3(signature = (joint_names, home_pose, positions=None))]
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 gives it away")]
    fn read_joint_angles<'py>(
        &mut self,
        py: Python<'py>,
        joint_names: Vec<String>,
        home_pose: &Bound<'py, PyAny>,
        positions: Option<BTreeMap<String, i32>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let positions = match positions {
            Some(positions) => positions,
            None => read_positions(home_pose)?,
        };
        self.take_gears(py)?;
        let home_pose = home_pose.extract()?;
        let angles = self
            .robot
            .read_joint_angles(&joint_names, &home_pose, &positions);
        Ok(row(py, angles.map_err(refused)?))
    }
}

impl PyRobot {
    fn around(py: Python<'_>, robot: Robot) -> PyResult<Self> {
        let (gear_sign, gear_ratio) = (PyDict::new(py), PyDict::new(py));
        for joint in robot.joints() {
            gear_sign.set_item(joint.name(), joint.gear().sign())?;
            gear_ratio.set_item(joint.name(), joint.gear().ratio())?;
        }
        Ok(Self {
            robot,
            gear_sign: gear_sign.unbind(),
            gear_ratio: gear_ratio.unbind(),
        })
    }

    /// Takes signs and ratios from their dictionaries. What they do not name is 1.
    fn take_gears(&mut self, py: Python<'_>) -> PyResult<()> {
        let signs: BTreeMap<String, f64> = self.gear_sign.extract(py)?;
        let ratios: BTreeMap<String, f64> = self.gear_ratio.extract(py)?;
        let names: Vec<String> = self.robot.joint_names().map(str::to_owned).collect();
        for name in names.iter().chain(signs.keys()).chain(ratios.keys()) {
            let of = |map: &BTreeMap<String, f64>| map.get(name).copied().unwrap_or(1.0);
            let gear = Gear::new(of(&signs), of(&ratios)).map_err(refused)?;
            self.robot.set_gear(name, gear).map_err(refused)?;
        }
        Ok(())
    }
}

/// Asks without the interpreter's lock. What the question lacks is said as the reason, as it is of a pose out of reach.
fn answer<'py>(
    py: Python<'py>,
    q: &[f64],
    ask: impl FnOnce() -> Result<Solution, IkError> + Send,
) -> Answer<'py> {
    match py.detach(ask) {
        Ok(solution) => {
            let (success, reason) = (solution.success(), solution.reason());
            (row(py, solution.q), success, reason)
        }
        Err(error) => (row(py, q.to_vec()), false, error.to_string()),
    }
}

fn ask(
    target: &Matrix4<f64>,
    mask: Option<&[f64]>,
    solve: impl FnOnce(IsometryMatrix3<f64>, Mask) -> Result<Solution, IkError>,
) -> Result<Solution, IkError> {
    let mask = match mask {
        None => Mask::POSE,
        Some(weights) => Mask::try_from(weights)?,
    };
    solve(pose_of(target)?, mask)
}

/// The `home_pose` of a `ServoController` knows its arm; any other dictionary does not.
fn read_positions(home_pose: &Bound<'_, PyAny>) -> PyResult<BTreeMap<String, i32>> {
    let Some(controller) = home_pose.getattr_opt("controller")? else {
        let message = "read_joint_angles: home_pose is not that of a ServoController, so that there is no arm to read: give \
                       positions=controller.read_servo_positions()";
        return Err(PyTypeError::new_err(message));
    };
    controller.call_method0("read_servo_positions")?.extract()
}
