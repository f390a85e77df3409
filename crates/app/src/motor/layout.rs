//! Which motor sits where. A table that two motors could not share, or that loads a bus too much, does not compile.

mod checks;
mod default_config;
mod robot;

pub use robot::{ROBOT_LAYOUT, RS00_LAYOUT};

use super::{
    dm4310::Dm4310,
    m3508::{self, EscId},
    rs00::Rs00,
};
use crate::domain::{BusId, CanFrame, JointConfig, MotorBuses, StandardId};

/// Ticks from one reply of the tuning channel on a bus to the next: 250 a second at most, which is what the load of the
/// motors leaves room for.
pub const REPLY_PERIOD_TICKS: u32 = 4;

/// When a motor is commanded, in ticks of 1 ms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    every: u8,
    phase: u8,
}

impl Schedule {
    /// Each `every` ticks, `phase` ticks after the first one. `None` unless `every` is 1, 2, 4 or 8 and `phase` smaller.
    pub const fn new(every: u8, phase: u8) -> Option<Self> {
        if matches!(every, 1 | 2 | 4 | 8) && phase < every {
            Some(Self { every, phase })
        } else {
            None
        }
    }

    /// Time from one command to the next.
    pub fn period_s(self) -> f32 {
        f32::from(self.every) * 1e-3
    }

    /// `every` is a power of two, so the remainder is a mask.
    pub const fn is_due(self, tick: u8) -> bool {
        tick & self.every.wrapping_sub(1) == self.phase
    }
}

/// The wheels' M3508 with their C620, commanded in every tick by one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelGroup {
    pub bus: BusId,
    /// Left, right.
    pub escs: [EscId; 2],
    /// What each motor may get whatever the settings say.
    pub max_current_ma: f32,
}

/// The makes of joint motors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointMotor {
    Dm4310(Dm4310),
    Rs00(Rs00),
}

impl JointMotor {
    const fn identifiers(&self) -> [StandardId; 4] {
        match self {
            Self::Dm4310(motor) => motor.identifiers(),
            Self::Rs00(motor) => motor.identifiers(),
        }
    }

    /// The make's number in stored settings (docs/parameters.md); never changes.
    pub const fn make(&self) -> u8 {
        match self {
            Self::Dm4310(_) => 1,
            Self::Rs00(_) => 2,
        }
    }
}

/// One joint motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointSlot {
    pub bus: BusId,
    pub motor: JointMotor,
    pub schedule: Schedule,
    /// Until settings say otherwise.
    pub config: JointConfig,
    /// What this motor may give whatever the settings say.
    pub max_torque_nm: f32,
}

/// All motors of a robot, in the order of `ChassisCommand`.
///
/// A bus may be loaded to 80 %, and at most two frames for motors start on it in one tick, which leaves the third
/// mailbox to a tuning reply. Four DM4310 in every tick are too much:
///
/// ```compile_fail,E0080
/// # use robot_app::motor::layout::*;
/// const EVERY_TICK: Schedule = Schedule::new(1, 0).unwrap();
/// const JOINTS: [JointSlot; 4] = {
///     let mut joints = *ROBOT_LAYOUT.joints();
///     joints[0].schedule = EVERY_TICK;
///     joints[1].schedule = EVERY_TICK;
///     joints[2].schedule = EVERY_TICK;
///     joints[3].schedule = EVERY_TICK;
///     joints
/// };
/// const LAYOUT: MotorLayout = MotorLayout::new(*ROBOT_LAYOUT.wheels(), JOINTS);
/// ```
///
/// In every second tick they fit:
///
/// ```
/// # use robot_app::motor::layout::*;
/// const EVEN: Schedule = Schedule::new(2, 0).unwrap();
/// const ODD: Schedule = Schedule::new(2, 1).unwrap();
/// const JOINTS: [JointSlot; 4] = {
///     let mut joints = *ROBOT_LAYOUT.joints();
///     joints[0].schedule = ODD;
///     joints[1].schedule = EVEN;
///     joints[2].schedule = ODD;
///     joints[3].schedule = EVEN;
///     joints
/// };
/// const LAYOUT: MotorLayout = MotorLayout::new(*ROBOT_LAYOUT.wheels(), JOINTS);
/// ```
///
/// Nor may a frame that is not for a DM4310 have that motor's number in the low byte of its identifier: the motor
/// compares no more of it. Here joint 2 would answer each report of joint 1:
///
/// ```compile_fail,E0080
/// # use robot_app::motor::{dm4310::Dm4310, layout::*};
/// const JOINTS: [JointSlot; 4] = {
///     let mut joints = *ROBOT_LAYOUT.joints();
///     let JointMotor::Dm4310(motor) = joints[0].motor else { panic!() };
///     joints[0].motor = JointMotor::Dm4310(Dm4310::new(1, 0x302, *motor.ranges()).unwrap());
///     joints
/// };
/// const LAYOUT: MotorLayout = MotorLayout::new(*ROBOT_LAYOUT.wheels(), JOINTS);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MotorLayout {
    wheels: WheelGroup,
    joints: [JointSlot; 4],
}

impl MotorLayout {
    /// For constants: what is wrong with the table is a compile error there.
    ///
    /// # Panics
    /// If a bus is overloaded, two motors use the same identifier, or a DM4310 would hear what is not for it.
    pub const fn new(wheels: WheelGroup, joints: [JointSlot; 4]) -> Self {
        checks::no_identifier_clashes(&wheels, &joints);
        checks::load_fits_bus(&wheels, &joints);
        checks::frames_fit_mailboxes(&wheels, &joints);
        checks::limits_are_sound(&wheels, &joints);
        Self { wheels, joints }
    }

    pub const fn wheels(&self) -> &WheelGroup {
        &self.wheels
    }

    pub const fn joints(&self) -> &[JointSlot; 4] {
        &self.joints
    }

    /// A joint's motor has a time-out that only people can set: RS00.
    pub fn has_timeout_to_set_by_hand(&self) -> bool {
        let is_rs00 = |joint: &JointSlot| matches!(joint.motor, JointMotor::Rs00(_));
        self.joints.iter().any(is_rs00)
    }

    /// What stops every motor: zero current for speed controllers 1 to 4, then the disable frame of each joint.
    pub const fn safe_frames(&self) -> [(BusId, CanFrame); 5] {
        let zero = CanFrame::new(m3508::COMMAND_ID, [0; 8]);
        let [left_front, left_rear, right_front, right_rear] = &self.joints;
        [
            (self.wheels.bus, zero),
            (left_front.bus, left_front.motor.disable()),
            (left_rear.bus, left_rear.motor.disable()),
            (right_front.bus, right_front.motor.disable()),
            (right_rear.bus, right_rear.motor.disable()),
        ]
    }

    /// The bus of each motor.
    pub fn buses(&self) -> MotorBuses {
        MotorBuses {
            wheels: self.wheels.bus,
            joints: self.joints.each_ref().map(|slot| slot.bus),
        }
    }
}

#[cfg(test)]
mod tests;
