//! All motors of the robot: distributes feedback and composes command frames.

use heapless::Vec;

use super::{
    interface::Motor,
    joint::{Joint, NotStationary},
    layout::MotorLayout,
    m3508,
    wheel::Wheel,
};
use crate::{
    domain::{
        BusId, CanFrame, ChassisCommand, JointConfig, MotorCurrent, MotorFeedback, RobotConfig,
        WheelCommand, WheelControllerConfig,
    },
    safety::TorquePermit,
};

/// Frames of one tick: on each bus at most two for motors (see [`MotorLayout`]) and one for a reply.
pub type TickFrames = Vec<(BusId, CanFrame), 6>;

/// The motors of one layout.
#[derive(Clone, Debug)]
pub struct MotorManager {
    layout: &'static MotorLayout,
    wheels: [Wheel; 2],
    joints: [Joint; 4],
    sent_wheels: [WheelCommand; 2],
}

impl MotorManager {
    pub fn new(layout: &'static MotorLayout) -> Self {
        let group = layout.wheels();
        Self {
            layout,
            wheels: group.escs.map(|esc| Wheel::new(esc, group.max_current_ma)),
            joints: layout.joints().each_ref().map(Joint::new),
            sent_wheels: [WheelCommand::default(); 2],
        }
    }

    pub fn layout(&self) -> &'static MotorLayout {
        self.layout
    }

    /// Passes a frame to the motor it is from. Returns false, without any effect, if it is from none.
    pub fn route_frame(&mut self, bus: BusId, frame: &CanFrame, ts_us: u64) -> bool {
        if self.layout.wheels().bus == bus {
            for wheel in &mut self.wheels {
                if wheel.receive(frame, ts_us) {
                    return true;
                }
            }
        }
        for (joint, slot) in self.joints.iter_mut().zip(self.layout.joints()) {
            if slot.bus == bus && joint.receive(frame, ts_us) {
                return true;
            }
        }
        false
    }

    /// The angle of a stationary joint motor in motor coordinates. `None` if there is no such joint.
    pub fn stationary_angle_rad(&self, joint: usize) -> Option<Result<f32, NotStationary>> {
        self.joints.get(joint).map(Joint::stationary_angle_rad)
    }

    /// Updates the feedback and its ages; called once a tick before [`compose`](Self::compose).
    pub fn feedback(&mut self, config: &RobotConfig, now_us: u64, feedback: &mut MotorFeedback) {
        for (wheel, out) in self.wheels.iter_mut().zip(&mut feedback.wheels) {
            wheel.update_age(config.wheel_ctrl.feedback_timeout_us, now_us);
            wheel.feedback(&config.wheel_ctrl, out);
        }
        let joints = self.joints.iter_mut().zip(&mut feedback.joints);
        for ((joint, out), joint_config) in joints.zip(&config.joints) {
            joint.update_age(config.safety.joint_timeout_us, now_us);
            joint.feedback(joint_config, out);
        }
        feedback.ts_us = now_us;
    }

    /// Excludes a stall of the whole chip from all ages: no motor was silent meanwhile.
    pub fn after_stall(&mut self, stall_us: u32, now_us: u64) {
        for wheel in &mut self.wheels {
            wheel.after_stall(stall_us);
        }
        for joint in &mut self.joints {
            joint.after_stall(stall_us, now_us);
        }
    }

    /// Makes each joint motor in fault clear it in its next slot and be set up again.
    pub fn clear_faults(&mut self) {
        for joint in &mut self.joints {
            joint.clear_fault();
        }
    }

    /// Whether the permit allows current on the wheels.
    pub fn wheels_may_move(&self, permit: Option<&TorquePermit>) -> bool {
        permit.is_some_and(|permit| permit.allows_wheels(self.layout.wheels().bus))
    }

    /// Whether the permit allows any joint to be enabled.
    pub fn joints_may_move(&self, permit: Option<&TorquePermit>) -> bool {
        let mut joints = self.layout.joints().iter();
        permit.is_some_and(|permit| joints.any(|slot| permit.allows_joints(slot.bus)))
    }

    /// Adds the frames of this tick. A motor without a permit gets
    /// exactly zero: zero current for a wheel, a disable frame for a joint. These frames are sent as well, as a speed
    /// controller may hold its last command, and a joint motor reports only when addressed.
    ///
    /// While the robot balances, only the layout limits the wheels, as it would fall without their torque.
    pub fn compose(
        &mut self,
        command: &ChassisCommand,
        permit: Option<&TorquePermit>,
        config: &RobotConfig,
        balancing: bool,
        now_us: u64,
        frames: &mut TickFrames,
    ) {
        let stricter;
        let unlimited;
        let (wheels, joints) = if permit.is_some_and(TorquePermit::is_for_standing_up) {
            stricter = limits_standing_up(config);
            (&stricter.0, &stricter.1)
        } else if balancing {
            unlimited = WheelControllerConfig {
                current_limit_ma: MotorCurrent::FULL_SCALE_MA,
                ..config.wheel_ctrl
            };
            (&unlimited, &config.joints)
        } else {
            (&config.wheel_ctrl, &config.joints)
        };
        self.drive_wheels(command, permit, wheels, now_us, frames);
        self.drive_joints(command, permit, joints, now_us, frames);
    }

    /// Counts that each rotor has turned since its first report; see `Telemetry`.
    pub fn turned_counts(&self) -> [i64; 2] {
        self.wheels.each_ref().map(Wheel::turned_counts)
    }

    /// Writes the commands that the frames of this tick carry, after limits and permit.
    pub fn record_sent(&self, sent: &mut ChassisCommand) {
        sent.wheels = self.sent_wheels;
        for (joint, sent) in self.joints.iter().zip(&mut sent.joints) {
            *sent = *joint.sent();
        }
    }

    fn drive_wheels(
        &mut self,
        command: &ChassisCommand,
        permit: Option<&TorquePermit>,
        config: &WheelControllerConfig,
        now_us: u64,
        frames: &mut TickFrames,
    ) {
        let bus = self.layout.wheels().bus;
        let permitted = permit.is_some_and(|permit| permit.allows_wheels(bus));
        let mut currents = [MotorCurrent::ZERO; 4];
        let wheels = self.layout.wheels().escs.iter().zip(&mut self.wheels);
        let commands = command.wheels.iter().zip(&mut self.sent_wheels);
        for ((esc, wheel), (command, sent)) in wheels.zip(commands) {
            let current = wheel.drive(command, config, permitted, now_us);
            sent.current_ma = current.ma();
            if let Some(place) = currents.get_mut(esc.index()) {
                *place = current;
            }
        }
        // The layout guarantees room.
        let _ = frames.push((bus, m3508::encode_currents(currents)));
    }

    fn drive_joints(
        &mut self,
        command: &ChassisCommand,
        permit: Option<&TorquePermit>,
        configs: &[JointConfig; 4],
        now_us: u64,
        frames: &mut TickFrames,
    ) {
        let slots = self.layout.joints().iter().zip(&mut self.joints);
        let orders = command.joints.iter().zip(configs);
        for ((slot, joint), (command, config)) in slots.zip(orders) {
            let permitted = permit.is_some_and(|permit| permit.allows_joints(slot.bus));
            let frame = joint.drive(command, config, permitted, now_us);
            if let Some(frame) = frame {
                // The layout guarantees room.
                let _ = frames.push((slot.bus, frame));
            }
        }
    }
}

/// Kept out of line, as standing up is rare.
#[cold]
#[inline(never)]
fn limits_standing_up(config: &RobotConfig) -> (WheelControllerConfig, [JointConfig; 4]) {
    let limits = &config.stand_up;
    let mut joints = config.joints;
    for joint in &mut joints {
        limits.limit_joint(joint);
    }
    (limits.limit_wheels(&config.wheel_ctrl), joints)
}

#[cfg(test)]
mod tests;
