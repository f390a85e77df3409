//! The door to Python. `python/jiling_arm` gives these classes the places where users look for them.

mod chain;
mod controller;
mod numbers;
mod robot;

use pyo3::prelude::*;

/// Native part of `jiling_arm`.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::{
        chain::{PyDhLink, PyEt},
        controller::{PyServoController, ServoError},
        robot::{PyRobot, create_so101_5dof},
    };
}
