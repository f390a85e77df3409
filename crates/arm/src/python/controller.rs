//! `ServoController`, as the arm's scripts know it.

use std::{
    collections::BTreeMap,
    ffi::CString,
    path::PathBuf,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc::{RecvTimeoutError, channel},
    },
    thread,
    time::Duration,
};

use pyo3::{
    create_exception,
    exceptions::{
        PyConnectionError, PyFileNotFoundError, PyRuntimeError, PyUserWarning, PyValueError,
    },
    prelude::*,
    types::PyDict,
};

use crate::{
    bus::BusError,
    calibration::CalibrationError,
    controller::{ControllerError, ServoController, Warning},
};

create_exception!(
    jiling_arm.driver.ftservo_controller,
    ServoError,
    PyRuntimeError,
    "A servo did not answer as it should. The others can still be asked."
);

/// Time between two looks whether Ctrl-C was pressed.
const LOOK_EVERY: Duration = Duration::from_millis(20);

type Steps = BTreeMap<String, i32>;

/// An arm on a bus.
#[pyclass(
    name = "ServoController",
    module = "jiling_arm.driver.ftservo_controller",
    subclass,
    weakref
)]
pub(super) struct PyServoController {
    /// None once it is closed.
    arm: Mutex<Option<ServoController>>,
    stop: Arc<AtomicBool>,
}

#[pymethods]
impl PyServoController {
    /// Opens a port, reads a calibration, and asks all servos whether they are there.
    #[new]
    #[pyo3(signature = (port, baudrate=1_000_000, config_path=PathBuf::from("servo_config.json"), ending="hold"))]
    fn new(
        py: Python<'_>,
        port: &str,
        baudrate: u32,
        config_path: PathBuf,
        ending: &str,
    ) -> PyResult<Self> {
        let ending = ending.parse().map_err(PyValueError::new_err)?;
        let open = || ServoController::open(port, baudrate, &config_path);
        let mut arm = py.detach(open).map_err(raised)?;
        arm.set_ending(ending);
        let stop = arm.stop_flag();
        warn(py, arm.take_warnings())?;
        Ok(Self {
            arm: Mutex::new(Some(arm)),
            stop,
        })
    }

    #[getter]
    fn joint_names(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.with(py, |arm| Ok(arm.joint_names()))
    }

    #[getter]
    fn home_pose(&self, py: Python<'_>) -> PyResult<Steps> {
        self.with(py, |arm| Ok(arm.home_pose()))
    }

    #[getter]
    fn has_torque(&self, py: Python<'_>) -> PyResult<bool> {
        self.with(py, |arm| Ok(arm.has_torque()))
    }

    fn move_all_home(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, ServoController::move_all_home)
    }

    #[pyo3(signature = (step_count=20, interval=0.05))]
    fn soft_move_to_home(&self, py: Python<'_>, step_count: u32, interval: f64) -> PyResult<()> {
        let interval = seconds("interval", interval)?;
        self.motion(py, |arm| arm.soft_move_to_home(step_count, interval))
    }

    #[pyo3(signature = (targets, step_count=20, interval=0.05))]
    fn soft_move_to_pose(
        &self,
        py: Python<'_>,
        targets: Steps,
        step_count: u32,
        interval: f64,
    ) -> PyResult<()> {
        let interval = seconds("interval", interval)?;
        self.motion(py, |arm| {
            arm.soft_move_to_pose(&targets, step_count, interval)
        })
    }

    #[pyo3(signature = (targets, speed=0))]
    fn fast_move_to_pose(&self, py: Python<'_>, targets: Steps, speed: i32) -> PyResult<()> {
        self.with(py, |arm| arm.fast_move_to_pose(&targets, speed))
    }

    fn read_servo_positions(&self, py: Python<'_>) -> PyResult<Steps> {
        self.with(py, ServoController::read_servo_positions)
    }

    /// What each servo says of itself, by joint.
    fn read_states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let states = self.with(py, ServoController::read_states)?;
        if let Some(error) = states.errors.into_iter().next() {
            return Err(raised(error.into()));
        }
        let all = PyDict::new(py);
        for (name, state) in states.joints {
            let one = PyDict::new(py);
            one.set_item("position_steps", state.position_steps)?;
            one.set_item("speed_steps_s", state.speed_steps_s)?;
            one.set_item("load_permille", state.load_permille)?;
            one.set_item("voltage_v", f64::from(state.voltage_dv) / 10.0)?;
            one.set_item("temperature_c", state.temperature_c)?;
            one.set_item("current_ma", state.current_ma)?;
            all.set_item(name, one)?;
        }
        Ok(all)
    }

    fn limit_position(&self, py: Python<'_>, name: &str, steps: i32) -> PyResult<i32> {
        self.with(py, |arm| arm.limit_position(name, steps))
    }

    fn enable_torque(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, ServoController::enable_torque)
    }

    fn hold(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, ServoController::hold)
    }

    fn release(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, ServoController::release)
    }

    fn recover(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        self.with(py, |arm| Ok(arm.recover(name)?.to_string()))
    }

    #[pyo3(signature = (timeout=10.0))]
    fn reconnect(&self, py: Python<'_>, timeout: f64) -> PyResult<()> {
        let timeout = seconds("timeout", timeout)?;
        self.motion(py, |arm| arm.reconnect(timeout))
    }

    /// Ends: the arm holds or is released, as `ending` says, and the port is free.
    fn close(&self, py: Python<'_>) {
        py.detach(|| drop(self.arm().take()));
    }

    fn __enter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    #[pyo3(signature = (*_why))]
    fn __exit__(&self, py: Python<'_>, _why: &Bound<'_, PyAny>) {
        self.close(py);
    }
}

impl PyServoController {
    fn arm(&self) -> MutexGuard<'_, Option<ServoController>> {
        // What a panic left behind is an arm that can still be told to stop.
        self.arm.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Talks to the bus without the interpreter's lock, so that other threads go on.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut ServoController) -> Result<T, ControllerError> + Send,
    ) -> PyResult<T> {
        finish(py, py.detach(|| self.work(work)))
    }

    /// As [`with`](Self::with), for what takes long. Ctrl-C stops it, and the arm holds where it is.
    fn motion<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut ServoController) -> Result<T, ControllerError> + Send,
    ) -> PyResult<T> {
        self.stop.store(false, Ordering::Relaxed);
        let (send, done) = channel();
        // A receiver alone would not be lent to code without the interpreter's lock.
        let done = Mutex::new(done);
        let wait = || {
            let done = done.lock().unwrap_or_else(PoisonError::into_inner);
            done.recv_timeout(LOOK_EVERY)
        };
        let mut interrupt = None;
        let done = thread::scope(|scope| {
            scope.spawn(move || {
                // Nobody waits for it any more only if this thread is about to end as well.
                let _ = send.send(self.work(work));
            });
            loop {
                match py.detach(wait) {
                    Ok(done) => return done,
                    Err(RecvTimeoutError::Disconnected) => return None,
                    Err(RecvTimeoutError::Timeout) => {}
                }
                if let Err(signal) = py.check_signals() {
                    self.stop.store(true, Ordering::Relaxed);
                    interrupt.get_or_insert(signal);
                }
            }
        });
        self.stop.store(false, Ordering::Relaxed);
        interrupt.map_or_else(|| finish(py, done), Err)
    }

    fn work<T>(
        &self,
        work: impl FnOnce(&mut ServoController) -> Result<T, ControllerError>,
    ) -> Option<Done<T>> {
        let mut arm = self.arm();
        let arm = arm.as_mut()?;
        let result = work(arm);
        let warnings = arm.take_warnings();
        Some(Done { result, warnings })
    }
}

/// What came of a call. None of it is of an arm that is closed.
struct Done<T> {
    result: Result<T, ControllerError>,
    warnings: Vec<Warning>,
}

fn finish<T>(py: Python<'_>, done: Option<Done<T>>) -> PyResult<T> {
    let closed = || PyValueError::new_err("this ServoController is closed");
    let Done { result, warnings } = done.ok_or_else(closed)?;
    warn(py, warnings)?;
    result.map_err(raised)
}

/// Passes warnings on to Python's own.
fn warn(py: Python<'_>, warnings: Vec<Warning>) -> PyResult<()> {
    let category = py.get_type::<PyUserWarning>();
    for warning in warnings {
        let text = CString::new(warning.to_string().replace('\0', ""))?;
        PyErr::warn(py, &category, &text, 1)?;
    }
    Ok(())
}

fn seconds(name: &str, value: f64) -> PyResult<Duration> {
    Duration::try_from_secs_f64(value).map_err(|_| {
        PyValueError::new_err(format!(
            "{name} = {value}: it is a time in s, and not below 0"
        ))
    })
}

/// The exception of an error: the port's, a servo's, or that of an argument.
fn raised(error: ControllerError) -> PyErr {
    let text = error.to_string();
    match error {
        ControllerError::Bus(BusError::Wire(_)) | ControllerError::NotBack { .. } => {
            PyConnectionError::new_err(text)
        }
        ControllerError::Bus(BusError::Servo(_)) | ControllerError::Stopped => {
            ServoError::new_err(text)
        }
        ControllerError::Calibration(CalibrationError::Read { .. }) => {
            PyFileNotFoundError::new_err(text)
        }
        _ => PyValueError::new_err(text),
    }
}
