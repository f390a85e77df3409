//! Which motor sits where. A table in which motors conflict, or which overloads a bus, does not compile.

mod checks;
mod default_config;
mod robot;

pub use robot::{CHOSEN_LAYOUT, ROBOT_LAYOUT, RS00_LAYOUT};

use super::{
    dm4310::Dm4310,
    m3508::{self, EscId},
    rs00::Rs00,
};
use crate::domain::{BusId, CanFrame, JointConfig, MotorBuses, RobotProfile, StandardId};

/// Ticks from one reply of the tuning channel on a bus to the next: 250 a second at most, which is what the load of the
/// motors leaves room for.
pub const REPLY_PERIOD_TICKS: u32 = 4;

/// The ticks of 1 ms in which a motor gets a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    every: u8,
    phase: u8,
}

impl Schedule {
    /// A command every `every` ticks, beginning `phase` ticks after the first one. Returns `None` unless `every` is
    /// 1, 2, 4 or 8 and `phase` is smaller.
    pub const fn new(every: u8, phase: u8) -> Option<Self> {
        if matches!(every, 1 | 2 | 4 | 8) && phase < every {
            Some(Self { every, phase })
        } else {
            None
        }
    }

    /// Time in s from one command to the next.
    pub fn period_s(self) -> f32 {
        f32::from(self.every) * 1e-3
    }

    /// Whether the motor gets a command in this tick. `every` is a power of two, so the remainder is a mask.
    pub const fn is_due(self, tick: u8) -> bool {
        tick & self.every.wrapping_sub(1) == self.phase
    }
}

/// The wheels' M3508 motors with C620 speed controllers. One frame commands both in every tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelGroup {
    /// The bus that they share.
    pub bus: BusId,
    /// Numbers of the left and the right speed controller.
    pub escs: [EscId; 2],
    /// Upper limit of each motor's current in mA, whatever the settings say.
    pub max_current_ma: f32,
}

/// A joint motor of either make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointMotor {
    /// Damiao DM4310.
    Dm4310(Dm4310),
    /// RobStride RS00.
    Rs00(Rs00),
}

impl JointMotor {
    const fn identifiers(&self) -> [StandardId; 4] {
        match self {
            Self::Dm4310(motor) => motor.identifiers(),
            Self::Rs00(motor) => motor.identifiers(),
        }
    }

    /// The make's number in stored settings (docs/parameters.md). It never changes.
    pub const fn make(&self) -> u8 {
        match self {
            Self::Dm4310(_) => 1,
            Self::Rs00(_) => 2,
        }
    }
}

/// One joint motor and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointSlot {
    /// The bus it is connected to.
    pub bus: BusId,
    /// The motor.
    pub motor: JointMotor,
    /// When it gets its commands.
    pub schedule: Schedule,
    /// Default settings of the joint.
    pub config: JointConfig,
    /// Upper limit of the motor's torque in N·m, whatever the settings say.
    pub max_torque_nm: f32,
}

/// All motors of a robot, in the order of `ChassisCommand`.
///
/// The load of a bus is limited to 80 %. In one tick at most two motor frames start on a bus, which leaves the third
/// mailbox for a tuning reply. Four DM4310 in every tick are too many:
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
/// const LAYOUT: MotorLayout = MotorLayout::new(ROBOT_LAYOUT.profile(), *ROBOT_LAYOUT.wheels(), JOINTS);
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
/// const LAYOUT: MotorLayout = MotorLayout::new(ROBOT_LAYOUT.profile(), *ROBOT_LAYOUT.wheels(), JOINTS);
/// ```
///
/// A DM4310 compares only the low byte of an identifier with its number, so no other frame on its bus may have that
/// low byte. Here joint 2 would answer each report of joint 1:
///
/// ```compile_fail,E0080
/// # use robot_app::motor::{dm4310::Dm4310, layout::*};
/// const JOINTS: [JointSlot; 4] = {
///     let mut joints = *ROBOT_LAYOUT.joints();
///     let JointMotor::Dm4310(motor) = joints[0].motor else { panic!() };
///     joints[0].motor = JointMotor::Dm4310(Dm4310::new(1, 0x302, *motor.ranges()).unwrap());
///     joints
/// };
/// const LAYOUT: MotorLayout = MotorLayout::new(ROBOT_LAYOUT.profile(), *ROBOT_LAYOUT.wheels(), JOINTS);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MotorLayout {
    profile: &'static RobotProfile,
    wheels: WheelGroup,
    joints: [JointSlot; 4],
}

impl MotorLayout {
    /// Checks the table. Use it for constants, where an error in the table is a compile error.
    ///
    /// # Panics Panics if a bus is overloaded, two motors use the same identifier, or a DM4310 would react to a frame
    /// for another device.
    pub const fn new(
        profile: &'static RobotProfile,
        wheels: WheelGroup,
        joints: [JointSlot; 4],
    ) -> Self {
        checks::no_identifier_clashes(&wheels, &joints);
        checks::load_fits_bus(&wheels, &joints);
        checks::frames_fit_mailboxes(&wheels, &joints);
        checks::limits_are_sound(&wheels, &joints);
        Self {
            profile,
            wheels,
            joints,
        }
    }

    /// The robot that these motors are in.
    pub const fn profile(&self) -> &'static RobotProfile {
        self.profile
    }

    /// The wheel motors.
    pub const fn wheels(&self) -> &WheelGroup {
        &self.wheels
    }

    /// The joint motors: left front, left rear, right front, right rear.
    pub const fn joints(&self) -> &[JointSlot; 4] {
        &self.joints
    }

    /// Whether a joint motor has a time-out that can only be set by hand (RS00).
    pub fn needs_manual_timeout(&self) -> bool {
        let is_rs00 = |joint: &JointSlot| matches!(joint.motor, JointMotor::Rs00(_));
        self.joints.iter().any(is_rs00)
    }

    /// The frames that stop every motor: zero current for speed controllers 1 to 4, and a disable frame for each
    /// joint.
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
