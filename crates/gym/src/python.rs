//! The door to Python. `python/jiling_gym` makes Gymnasium's classes of it.

use std::path::{Path, PathBuf};

use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::{
    exceptions::{PyIndexError, PyKeyError, PyValueError},
    prelude::*,
    types::PyDict,
};
use robot_policy::{PolicyDescription, config, limits::Stop, observation::Commands};

use crate::{Environment, GymError, Options, Rows, StartKind, Truth};

/// Native part of `jiling_gym`.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::Fleet;
}

/// Environments that are stepped together in threads, without the interpreter's lock.
#[pyclass]
struct Fleet {
    policy: PolicyDescription,
    threads: usize,
    elf: Option<PathBuf>,
    fleet: crate::Fleet,
}

/// Observations, those before the reset, rewards, fallen, time over.
type Arrays<'py> = (
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
);

#[pymethods]
impl Fleet {
    /// Boots `count` robots for the policy `robot/config` below the folder `policies`, by default that of the source tree. With
    /// `elf`, this firmware image runs in the emulated board in place of the app.
    #[new]
    #[pyo3(signature = (count, threads, seed, resets, policies=None, robot="fivebar", config="flat", options=None, elf=None))]
    #[expect(clippy::too_many_arguments, reason = "Python names them")]
    fn new(
        py: Python<'_>,
        count: usize,
        threads: usize,
        seed: u64,
        resets: bool,
        policies: Option<PathBuf>,
        robot: &str,
        config: &str,
        options: Option<&Bound<'_, PyDict>>,
        elf: Option<PathBuf>,
    ) -> PyResult<Self> {
        if count == 0 {
            return Err(PyValueError::new_err("0 environments step nowhere"));
        }
        let policies = policies.unwrap_or_else(shipped_policies);
        let policy = config::read(&policies, robot, config).map_err(refused)?;
        let options = with(Options::default(), options)?;
        let boot = || crate::Fleet::of(&policy, options, seed, count, threads, elf.as_deref());
        let mut fleet = py.detach(boot).map_err(complaint)?;
        fleet.resets = resets;
        Ok(Self {
            policy,
            threads,
            elf,
            fleet,
        })
    }

    /// Begins another episode of each. With a seed, other robots are booted, always the same ones. Options count from now on.
    #[pyo3(signature = (seed=None, options=None))]
    fn reset<'py>(
        &mut self,
        py: Python<'py>,
        seed: Option<u64>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let now = self.fleet.environments()[0].options();
        let options = with(now, options)?;
        let Self {
            policy,
            threads,
            elf,
            fleet,
        } = self;
        let reset = || {
            if let Some(seed) = seed {
                let (count, resets) = (fleet.environments().len(), fleet.resets);
                *fleet = crate::Fleet::of(policy, options, seed, count, *threads, elf.as_deref())?;
                fleet.resets = resets;
                return Ok(());
            }
            let mut environments = fleet.environments_mut().iter_mut();
            environments.try_for_each(|it| it.set_options(options))?;
            fleet.reset()
        };
        py.detach(reset).map_err(complaint)?;
        let observations = self.fleet.observations();
        table(py, observations, self.fleet.observation_len())
    }

    /// Steps each environment with its row of actions.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        actions: PyReadonlyArray2<'py, f32>,
    ) -> PyResult<Arrays<'py>> {
        let wanted = [self.fleet.environments().len(), self.policy.joints.len()];
        if actions.shape() != wanted {
            let found = actions.shape();
            let message = format!("actions of shape {found:?}, and {wanted:?} is needed");
            return Err(PyValueError::new_err(message));
        }
        let actions = actions.as_array().iter().copied().collect::<Vec<f32>>();
        let fleet = &mut self.fleet;
        let rows = py.detach(|| fleet.step(&actions)).map_err(complaint)?;
        let len = fleet.observation_len();
        let Rows {
            observations,
            last_observations,
            rewards,
            fallen,
            over,
        } = rows;
        Ok((
            table(py, observations, len)?,
            table(py, last_observations, len)?,
            rewards.into_pyarray(py),
            fallen.into_pyarray(py),
            over.into_pyarray(py),
        ))
    }

    /// Values of an observation.
    #[getter]
    fn observation_len(&self) -> usize {
        self.fleet.observation_len()
    }

    /// Limits of the actions: lower, upper.
    #[getter]
    fn action_limits(&self) -> (Vec<f32>, Vec<f32>) {
        let clips = self.policy.joints.iter().map(|joint| joint.action.clip);
        clips.map(|[low, high]| (low, high)).unzip()
    }

    /// Names of the joints, in the policy's order.
    #[getter]
    fn joint_names(&self) -> Vec<String> {
        let joints = self.policy.joints.iter();
        joints.map(|joint| joint.name.clone()).collect()
    }

    /// Time of a step in s.
    #[getter]
    fn period_s(&self) -> f64 {
        self.policy.period_s()
    }

    /// Commands of all environments: forward in m/s, turn to the left in rad/s.
    fn commands<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let commands = self.fleet.environments().iter().map(Environment::commands);
        let rows = commands.flat_map(|it| [it.forward_mps, it.yaw_rps].map(f64::from));
        table(py, rows.collect(), 2)
    }

    /// Commands one environment until the end of its episode: forward in m/s, turn to the left in rad/s. It is seen from
    /// the next observation on.
    fn command(&mut self, index: usize, forward_mps: f32, yaw_rps: f32) -> PyResult<()> {
        self.environment(index)?.command(Commands {
            forward_mps,
            left_mps: 0.0,
            yaw_rps,
        });
        Ok(())
    }

    /// Pushes one robot, so that its speed forward and to the left changes by this, in m/s.
    fn push(&mut self, index: usize, forward_mps: f64, left_mps: f64) -> PyResult<()> {
        self.environment(index)?.push([forward_mps, left_mps]);
        Ok(())
    }

    /// What only the simulator knows of one robot, by name, and the limit of the runner that ended its episode, or None.
    fn truth<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyDict>> {
        let environments = self.fleet.environments();
        let environment = environments.get(index).ok_or_else(|| no_such(index))?;
        let truth = environment.truth();
        let Truth {
            forward_mps,
            yaw_rps,
            roll_pitch_rad: [roll_rad, pitch_rad],
            height_m,
            place_m,
            leg_m,
            wheel_nm,
            body_n,
            armed,
        } = truth;
        let dict = PyDict::new(py);
        dict.set_item("forward_mps", forward_mps)?;
        dict.set_item("yaw_rps", yaw_rps)?;
        dict.set_item("roll_rad", roll_rad)?;
        dict.set_item("pitch_rad", pitch_rad)?;
        dict.set_item("height_m", height_m)?;
        dict.set_item("place_m", place_m)?;
        dict.set_item("leg_m", leg_m)?;
        dict.set_item("wheel_nm", wheel_nm)?;
        dict.set_item("body_n", body_n)?;
        dict.set_item("tilt_rad", truth.tilt_rad())?;
        dict.set_item("armed", armed)?;
        dict.set_item("stop", environment.stopped_by().map(Stop::name))?;
        Ok(dict)
    }
}

impl Fleet {
    fn environment(&mut self, index: usize) -> PyResult<&mut Environment> {
        let environments = self.fleet.environments_mut();
        environments.get_mut(index).ok_or_else(|| no_such(index))
    }
}

/// The folder `policy` of the source tree that this was built from.
fn shipped_policies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../policy")
}

fn table<T: numpy::Element>(
    py: Python<'_>,
    values: Vec<T>,
    width: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let height = values.len() / width;
    values.into_pyarray(py).reshape([height, width])
}

fn no_such(index: usize) -> PyErr {
    PyIndexError::new_err(format!("there is no environment {index}"))
}

fn complaint(error: GymError) -> PyErr {
    refused(error)
}

fn refused(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The options with those of a dictionary.
fn with(mut options: Options, changes: Option<&Bound<'_, PyDict>>) -> PyResult<Options> {
    let Some(changes) = changes else {
        return Ok(options);
    };
    for (key, value) in changes.iter() {
        let key: String = key.extract()?;
        match key.as_str() {
            "start" => options.start = start_of(&value.extract::<String>()?)?,
            "built_in" => options.built_in = value.extract()?,
            "vary" => options.vary = value.extract()?,
            "push_mps" => options.push_mps = value.extract()?,
            "push_every_s" => options.push_every_s = value.extract()?,
            "speed_mps" => options.speed_mps = value.extract()?,
            "turn_rps" => options.turn_rps = value.extract()?,
            "command_every_s" => options.command_every_s = value.extract()?,
            "episode_s" => options.episode_s = value.extract()?,
            "episodes_per_robot" => options.episodes_per_robot = value.extract()?,
            _ => {
                let known = "start, built_in, vary, push_mps, push_every_s, speed_mps, turn_rps, command_every_s, episode_s, \
                             episodes_per_robot";
                let message = format!("there is no option {key}: there are {known}");
                return Err(PyKeyError::new_err(message));
            }
        }
    }
    options.check().map_err(complaint)?;
    Ok(options)
}

fn start_of(name: &str) -> PyResult<StartKind> {
    match name {
        "mixed" => Ok(StartKind::Mixed),
        "sitting" => Ok(StartKind::Sitting),
        "standing" => Ok(StartKind::Standing),
        _ => {
            let message = format!("start: {name} is none of mixed, sitting, standing");
            Err(PyValueError::new_err(message))
        }
    }
}
