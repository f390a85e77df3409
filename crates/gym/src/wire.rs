//! The way between the policy and the motors: state frames and command frames, with the accuracy that they have.

use robot_app::{
    domain::PcDrive,
    link::{Downlink, DriveFrame, Uplink},
};
use robot_description::JointMotor;
use robot_plant::robots;
use robot_policy::{
    PolicyDescription,
    action::Target,
    observation::{Commands, Reading},
    robot::LinkRobot,
};

use crate::{GymError, simulated_robot::Frame};

const MOTORS: usize = 6;
const WHEELS: usize = 2;

/// Turns frames into readings, and targets into frames, by the code that drives a robot on the PC link.
#[derive(Clone)]
pub(crate) struct Wire {
    policy: PolicyDescription,
    robot: LinkRobot,
    wanted: Vec<Target>,
    limited: Vec<Target>,
    /// What a full stick of the robot's own controller means.
    max_speed_mps: f32,
    max_yaw_rps: f32,
    /// Counts drive commands, so that no two frames are equal.
    count: u8,
}

impl Wire {
    pub fn new(policy: &PolicyDescription) -> Result<Self, GymError> {
        let sticks = &robots::with_joints(JointMotor::Dm4310).control.limits;
        Ok(Self {
            policy: policy.clone(),
            robot: LinkRobot::new(policy)?,
            wanted: Vec::with_capacity(policy.joints.len()),
            limited: Vec::with_capacity(policy.joints.len()),
            max_speed_mps: sticks.max_speed_mps as f32,
            max_yaw_rps: sticks.max_yaw_rps as f32,
            count: 0,
        })
    }

    /// The policy for which it translates.
    pub fn policy(&self) -> &PolicyDescription {
        &self.policy
    }

    /// Reads a state as the other end of the cable does.
    pub fn read(&mut self, state: &Uplink) -> Result<(), GymError> {
        let state = Uplink::decode(&state.encode()).expect("its own frame");
        Ok(self.robot.read(&state)?)
    }

    /// The last state read, at first that of a level robot at its default pose.
    pub fn reading(&self) -> &Reading {
        self.robot.reading()
    }

    /// The drive command of these wishes, for the robot's own controller.
    pub fn drive(&mut self, commands: &Commands) -> Frame {
        self.count = self.count.wrapping_add(1);
        Frame::Drive(DriveFrame(PcDrive {
            vx: commands.forward_mps / self.max_speed_mps,
            wz: commands.yaw_rps / self.max_yaw_rps,
            count: self.count,
            ..PcDrive::default()
        }))
    }

    /// The actions whose targets are these angles of the hips' motors, and wheels at rest.
    pub fn actions_at(&self, hips_rad: [f64; MOTORS - WHEELS]) -> Vec<f32> {
        let mut motors_rad = [0.0; MOTORS];
        for (motor_rad, hip_rad) in motors_rad[WHEELS..].iter_mut().zip(hips_rad) {
            *motor_rad = hip_rad as f32;
        }
        let mut joints_rad = [0.0; MOTORS];
        let mapping = &self.policy.mapping;
        mapping.policy_from_motors(&motors_rad, &mut joints_rad);
        let pairs = self.policy.joints.iter().zip(joints_rad);
        pairs
            .map(|(joint, rad)| (rad - joint.action.offset) / joint.action.scale)
            .collect()
    }

    /// The last targets, before their torques were limited.
    pub fn wanted(&self) -> &[Target] {
        &self.wanted
    }

    /// Limits the torques of these targets, and makes them what [`command`](Self::command) sends.
    pub fn aim(&mut self, targets: &[Target]) {
        let reading = self.robot.reading();
        let motions = reading.joint_pos_rad.iter().zip(&reading.joint_vel_rps);
        let joints = self.policy.joints.iter().zip(motions);
        self.wanted.clear();
        self.wanted.extend_from_slice(targets);
        self.limited.clear();
        let limited = targets.iter().zip(joints).map(|(target, (joint, motion))| {
            let (pos_rad, vel_rps) = motion;
            target.within_torque(joint.torque_limit_nm, *pos_rad, *vel_rps)
        });
        self.limited.extend(limited);
    }

    /// The command of the last targets. No two frames are equal.
    pub fn command(&mut self) -> Frame {
        Frame::Motors(self.robot.command(&self.limited))
    }
}

/// A command that asks for no motion.
pub(crate) fn at_rest() -> Frame {
    Frame::Motors(Downlink::default())
}
