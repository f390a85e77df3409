//! The way between the policy and the motors: state frames and command frames, with the accuracy that they have.

use robot_app::{
    domain::{JointTarget, PcCommand, PcDrive, PcKind, WheelTarget},
    link::{Downlink, Uplink},
};
use robot_description::JointMotor;
use robot_plant::robots;
use robot_policy::{
    ActionPlan, JointMapping, PolicyDescription,
    action::Target,
    attitude::{QuatWxyz, QuatXyzw},
    observation::{Commands, Reading},
};

use crate::GymError;

const MOTORS: usize = 6;
const WHEELS: usize = 2;

/// Turns frames into readings, and targets into frames.
#[derive(Clone)]
pub(crate) struct Wire {
    mapping: JointMapping,
    torque_limits_nm: Vec<f32>,
    actions: Vec<ActionPlan>,
    /// What a full stick of the robot's own controller means.
    max_speed_mps: f32,
    max_yaw_rps: f32,
    /// Counts commands, so that no two frames are equal.
    count: u8,
}

impl Wire {
    pub fn new(policy: &PolicyDescription) -> Self {
        let sticks = &robots::with_joints(JointMotor::Dm4310).control.limits;
        let limits = policy.joints.iter().map(|joint| joint.torque_limit_nm);
        Self {
            mapping: policy.mapping.clone(),
            torque_limits_nm: limits.collect(),
            actions: policy.joints.iter().map(|joint| joint.action).collect(),
            max_speed_mps: sticks.max_speed_mps as f32,
            max_yaw_rps: sticks.max_yaw_rps as f32,
            count: 0,
        }
    }

    /// Reads a state as the other end of the cable does.
    pub fn read(&self, state: &Uplink, reading: &mut Reading) -> Result<(), GymError> {
        let state = Uplink::decode(&state.encode()).expect("its own frame");
        reading.attitude = QuatWxyz::from(QuatXyzw::new(state.q_xyzw)?);
        reading.body_rates_rps = state.gyro_rps;
        let angles = state.motors.map(|motor| motor.pos_rad);
        let speeds = state.motors.map(|motor| motor.vel_rps);
        let mapping = &self.mapping;
        mapping.policy_from_motors(&angles, &mut reading.joint_pos_rad);
        mapping.policy_from_motors(&speeds, &mut reading.joint_vel_rps);
        Ok(())
    }

    /// The drive command of these wishes, for the robot's own controller.
    pub fn drive(&mut self, commands: &Commands) -> PcCommand {
        self.count = self.count.wrapping_add(1);
        PcCommand {
            kind: PcKind::Drive,
            drive: PcDrive {
                vx: commands.forward_mps / self.max_speed_mps,
                wz: commands.yaw_rps / self.max_yaw_rps,
                count: self.count,
                ..PcDrive::default()
            },
            ..PcCommand::default()
        }
    }

    /// The actions whose targets are these angles of the hips' motors, and wheels at rest.
    pub fn actions_at(&self, hips_rad: [f64; MOTORS - WHEELS]) -> Vec<f32> {
        let motors = self.mapping.motors().iter().zip(self.mapping.directions());
        let pairs = motors.zip(&self.actions);
        let actions = pairs.map(|((motor, direction), plan)| {
            let hip = motor.checked_sub(WHEELS);
            hip.map_or(0.0, |hip| {
                (direction * hips_rad[hip] as f32 - plan.offset) / plan.scale
            })
        });
        actions.collect()
    }

    /// The command of these targets, as the robot reads it from its frame.
    pub fn command(&mut self, targets: &[Target], reading: &Reading) -> PcCommand {
        let mut frame = Downlink::default();
        for (joint, target) in targets.iter().enumerate() {
            let limit_nm = self.torque_limits_nm[joint];
            let [pos_rad, vel_rps] = [reading.joint_pos_rad[joint], reading.joint_vel_rps[joint]];
            let motor = self.mapping.motors()[joint];
            let direction = self.mapping.directions()[joint];
            match target.within_torque(limit_nm, pos_rad, vel_rps) {
                Target::Speed { rps, kd } => {
                    frame.wheels[motor] = WheelTarget {
                        speed_rps: direction * rps,
                        kp: f32::from(self.count),
                        kd,
                    };
                }
                Target::Position { rad, kp, kd } => {
                    let pos_rad = direction * rad;
                    frame.joints[motor - WHEELS] = JointTarget { pos_rad, kp, kd };
                }
            }
        }
        self.count = self.count.wrapping_add(1);
        command_of(&frame)
    }
}

/// A command that asks for no motion.
pub(crate) fn at_rest() -> PcCommand {
    command_of(&Downlink::default())
}

fn command_of(frame: &Downlink) -> PcCommand {
    let Downlink { wheels, joints } = Downlink::decode(&frame.encode()).expect("its own frame");
    PcCommand {
        kind: PcKind::Motors,
        wheels,
        joints,
        ..PcCommand::default()
    }
}

/// Checks that the policy drives this robot's motors: wheels are motors 0 and 1.
pub(crate) fn check(policy: &PolicyDescription) -> Result<(), GymError> {
    let found = policy.joints.len();
    let wheels = policy.wheels();
    let motors = policy.mapping.motors();
    if found == MOTORS && wheels.len() == WHEELS && wheels.iter().all(|it| motors[*it] < WHEELS) {
        Ok(())
    } else {
        Err(GymError::OtherRobot { found })
    }
}
