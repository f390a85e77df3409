//! An arm: joints by name in place of ids and registers.
//!
//! ```no_run
//! use std::{collections::BTreeMap, path::Path, time::Duration};
//! use robot_arm::controller::ServoController;
//!
//! let mut arm = ServoController::open("/dev/ttyACM0", 1_000_000, Path::new("left_arm.json"))?;
//! arm.soft_move_to_home(20, Duration::from_millis(50))?;
//! let targets = BTreeMap::from([("shoulder_pan".to_owned(), 2048), ("shoulder_lift".to_owned(), 2000)]);
//! arm.fast_move_to_pose(&targets, 0)?;
//! println!("{:?}", arm.read_servo_positions()?);
//! # Ok::<(), robot_arm::controller::ControllerError>(())
//! ```
//!
//! **When it ends.** By [`Ending`]: as it is made, the arm stays where it is when the controller is dropped, which is at the end of
//! a program, after Ctrl-C that [`stop_flag`](ServoController::stop_flag) is told of, and in a panic. An arm whose torque goes off
//! falls, onto whatever is below. When the cable is out, nothing can be sent: the servos hold their last goals by themselves.

mod ending;
mod error;
mod limits;
mod mismatch;
mod motion;
mod plausible;
mod positions;
mod reconnect;
mod recovery;
mod setup;
mod torque;

use std::{
    collections::BTreeMap,
    path::Path,
    sync::{Arc, atomic::AtomicBool},
};

pub use ending::Ending;
pub use error::{ControllerError, Warning};
pub use mismatch::Mismatch;
pub use positions::{JointState, Positions, States};
pub use recovery::Recovery;

use crate::{
    bus::ServoBus,
    calibration::{Calibration, JointCalibration},
};
use plausible::Plausible;
use torque::Torque;

/// One joint of the arm.
struct Joint {
    name: String,
    calibration: JointCalibration,
    home: i32,
    plausible: Plausible,
    /// True while its goals are limited, which is warned of once.
    is_limited: bool,
    /// It did not answer the last reading.
    is_missing: bool,
    torque: Torque,
}

/// An arm on a bus.
pub struct ServoController {
    bus: ServoBus,
    calibration: Calibration,
    joints: Vec<Joint>,
    ending: Ending,
    stop: Arc<AtomicBool>,
    warnings: Vec<Warning>,
}

impl ServoController {
    /// Opens a port and reads a calibration of either format.
    pub fn open(port: &str, bps: u32, config_path: &Path) -> Result<Self, ControllerError> {
        let calibration = Calibration::load(config_path)?;
        let bus = ServoBus::open(port, bps)?;
        Self::new(bus, calibration)
    }

    /// Takes an arm whose servos all answer.
    pub fn new(bus: ServoBus, calibration: Calibration) -> Result<Self, ControllerError> {
        let mut arm = Self::unchecked(bus, calibration);
        arm.check_servos()?;
        Ok(arm)
    }

    /// Takes an arm without asking its servos anything.
    fn unchecked(mut bus: ServoBus, calibration: Calibration) -> Self {
        let joint = |(name, joint): &(String, JointCalibration)| {
            bus.name(joint.id, name);
            Joint {
                name: name.clone(),
                calibration: *joint,
                home: calibration.home(joint),
                plausible: Plausible::default(),
                is_limited: false,
                is_missing: false,
                torque: Torque::default(),
            }
        };
        Self {
            joints: calibration.joints().iter().map(joint).collect(),
            bus,
            calibration,
            ending: Ending::default(),
            stop: Arc::default(),
            warnings: Vec::new(),
        }
    }

    /// Names of the joints in the order of their file.
    pub fn joint_names(&self) -> Vec<String> {
        self.joints.iter().map(|joint| joint.name.clone()).collect()
    }

    /// Home of each joint in steps.
    pub fn home_pose(&self) -> BTreeMap<String, i32> {
        let homes = self
            .joints
            .iter()
            .map(|joint| (joint.name.clone(), joint.home));
        homes.collect()
    }

    pub fn calibration(&self) -> &Calibration {
        &self.calibration
    }

    /// The bus below, for what has no name here.
    pub fn bus(&mut self) -> &mut ServoBus {
        &mut self.bus
    }

    /// Sets what happens when the controller ends.
    pub fn set_ending(&mut self, ending: Ending) {
        self.ending = ending;
    }

    /// Once this is true, motions stop where they are. To be set by what catches Ctrl-C.
    pub fn stop_flag(&self) -> Arc<AtomicBool> {
        self.stop.clone()
    }

    /// Uses a flag of the caller's in place of its own.
    pub fn set_stop_flag(&mut self, flag: Arc<AtomicBool>) {
        self.stop = flag;
    }

    /// Returns the warnings since the last call.
    pub fn take_warnings(&mut self) -> Vec<Warning> {
        std::mem::take(&mut self.warnings)
    }

    fn ids(&self) -> Vec<u8> {
        self.joints
            .iter()
            .map(|joint| joint.calibration.id)
            .collect()
    }

    fn joint(&self, name: &str) -> Result<&Joint, ControllerError> {
        let found = self.joints.iter().find(|joint| joint.name == name);
        found.ok_or_else(|| ControllerError::UnknownJoint {
            name: name.to_owned(),
            known: self.joint_names().join(", "),
        })
    }
}
