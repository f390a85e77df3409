//! A robot's `base.yaml`, for policies whose own files know neither motors nor limits.

use std::path::Path;

use super::{
    ConfigError, joints,
    keys::{KNOWN, Keys},
};
use crate::Drive;

/// A robot as its `base.yaml` describes it, in an order of its own.
pub(super) struct Base {
    pub(super) file: String,
    pub(super) control_period_s: f32,
    pub(super) decimation: u32,
    pub(super) joints: Vec<BaseJoint>,
}

/// A joint, or a wheel.
#[derive(Clone, Debug)]
pub(super) struct BaseJoint {
    pub(super) name: String,
    pub(super) motor: usize,
    pub(super) direction: i8,
    pub(super) drive: Drive,
    pub(super) fixed_kp: f32,
    pub(super) fixed_kd: f32,
    pub(super) torque_limit_nm: f32,
}

impl Base {
    pub(super) fn read(policies: &Path, robot: &str) -> Result<Self, ConfigError> {
        let file = policies.join(robot).join("base.yaml");
        let keys = Keys::default().read_below(&file, robot)?;
        keys.know_only(&KNOWN)?;
        let count = joints::count(&keys)?;
        let mapping = joints::mapping(&keys, count)?;
        let drives = joints::drives(&keys, count)?;
        let names = joints::names(&keys, &mapping, &drives)?;
        let fixed = joints::fixed_gains(&keys, &names, &drives)?;
        let torque_limits_nm = joints::torque_limits(&keys, count)?;
        let joints = names.into_iter().enumerate().map(|(n, name)| BaseJoint {
            name,
            motor: mapping.motors()[n],
            direction: if mapping.directions()[n] < 0.0 { -1 } else { 1 },
            drive: drives[n],
            fixed_kp: fixed[n][0],
            fixed_kd: fixed[n][1],
            torque_limit_nm: torque_limits_nm[n],
        });
        let (control_period_s, decimation) = joints::periods(&keys)?;
        Ok(Self {
            file: file.display().to_string(),
            control_period_s,
            decimation,
            joints: joints.collect(),
        })
    }

    /// Returns the joint that a motor turns.
    pub(super) fn of_motor(&self, motor: usize) -> Option<&BaseJoint> {
        self.joints.iter().find(|joint| joint.motor == motor)
    }

    /// Returns the joint with a name.
    pub(super) fn named(&self, name: &str) -> Option<&BaseJoint> {
        self.joints.iter().find(|joint| joint.name == name)
    }
}
