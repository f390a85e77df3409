//! What ends a run, and how: each limit of the robot's joints and body, and each failure around it.

use robot_description::Robot;
use robotctl::drive::Obstacle;

use crate::{
    Drive, PolicyDescription,
    action::{ActionError, Target},
    observation::{ObserveError, Reading},
    robot::{Implausible, MOTOR_NAMES},
};

/// Largest angle in rad between the body's z and the vertical: 60°.
pub const TILT_RAD: f32 = std::f32::consts::FRAC_PI_3;
/// For so long in s a motor may be asked for more than its largest torque.
pub const OVERLOAD_S: f64 = 0.5;
/// A state frame is stale after this time in s. They come each 2.4 ms.
pub const STALE_S: f64 = 0.1;
/// The robot says whether it is safe three times a second. Silence for this time in s is too long.
pub const SILENT_S: f64 = 1.0;
/// The link says 33 rad/s of any faster wheel.
const WHEEL_RPS: f32 = 32.5;
/// A range ends at rubber stops, which a joint may touch and press by so much in rad. One beyond has a wrong zero.
const GIVES_RAD: f32 = 0.1;

/// Why a run ends.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Stop {
    /// The user ends it.
    #[error("ended as asked")]
    Asked,
    /// The time that the user gave is over.
    #[error("the {seconds} s of --seconds are over")]
    TimeOver {
        /// The time in s.
        seconds: f64,
    },
    /// The robot does not obey the PC, or not any more.
    #[error("the robot does not obey: {0}")]
    NotPermitted(Obstacle),
    /// A joint is outside of its range.
    #[error(
        "{joint} is at {rad:+.3} rad, outside of {low:+.3} to {high:+.3}: is its zero right (`policy check`), and was the policy \
         trained with this range?"
    )]
    Position {
        /// The joint.
        joint: String,
        /// Its angle.
        rad: f32,
        /// Its range, lower end.
        low: f32,
        /// Its range, upper end.
        high: f32,
    },
    /// A joint or wheel is too fast.
    #[error(
        "{joint} turns at {rps:+.1} rad/s, more than {most:.1}: lower action_scale or the command, or raise its Kd"
    )]
    Speed {
        /// The joint.
        joint: String,
        /// Its speed.
        rps: f32,
        /// The limit.
        most: f32,
    },
    /// A motor was asked for too much torque for too long.
    #[error(
        "{joint} was asked for {nm:+.1} N·m, more than {most:.1}, for {OVERLOAD_S} s: is it blocked, or does it count the other \
         way round than the policy (`policy check`)?"
    )]
    Torque {
        /// The joint.
        joint: String,
        /// Torque by Kp, Kd, angle and speed.
        nm: f32,
        /// The limit.
        most: f32,
    },
    /// The body leans too far.
    #[error(
        "the body leans by {degrees:.0}°, more than {most:.0}°: it falls or lies; put it up, then start again"
    )]
    Attitude {
        /// Angle between the body's z and the vertical.
        degrees: f32,
        /// The limit.
        most: f32,
    },
    /// No new state came from the robot.
    #[error(
        "no new state of the robot for {age_s:.2} s: is the cable in, and does another program read from it?"
    )]
    Stale {
        /// Time since the last one.
        age_s: f64,
    },
    /// The robot does not answer questions.
    #[error(
        "the robot sends its state, but has not said for {SILENT_S} s whether it is safe: is the adapter's TX connected to the \
         board's RX, and does `robotctl status` get an answer?"
    )]
    NoAnswer,
    /// A state frame has a value that cannot be.
    #[error("an implausible state: {0}. Look at it with `robotctl status`")]
    Implausible(#[from] Implausible),
    /// No observation can be made.
    #[error("no observation: {0}")]
    Observation(#[from] ObserveError),
    /// The network's output cannot be obeyed.
    #[error("{0}: its input may be far from what it was trained with; look at the log")]
    Action(#[from] ActionError),
    /// The network fails.
    #[error("the network fails: {0}")]
    Network(String),
    /// The computer is too slow.
    #[error(
        "the network ran {late_ms:.0} ms late, {misses} times in a row: let less run beside it, or give it real time \
         (docs/policy.md)"
    )]
    Deadline {
        /// How late the last run was.
        late_ms: f64,
        /// Runs in a row that were late.
        misses: u32,
    },
    /// Nobody says where to go any more.
    #[error("no commands: {0}")]
    NoCommands(String),
    /// The port fails.
    #[error("the link fails: {0}")]
    LinkFailed(String),
}

/// How the robot ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// It gets down.
    Down,
    /// Its motors get no torque at once: getting down needs a robot that is heard, obeys and has its feet below it.
    Limp,
}

impl Stop {
    /// Returns its name, as in the documentation and the log.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Asked => "asked",
            Self::TimeOver { .. } => "time-over",
            Self::NotPermitted(_) => "not-permitted",
            Self::Position { .. } => "joint-position",
            Self::Speed { .. } => "joint-speed",
            Self::Torque { .. } => "joint-torque",
            Self::Attitude { .. } => "attitude",
            Self::Stale { .. } => "stale",
            Self::NoAnswer => "no-answer",
            Self::Implausible(_) => "implausible",
            Self::Observation(_) => "observation",
            Self::Action(_) => "action",
            Self::Network(_) => "network",
            Self::Deadline { .. } => "deadline",
            Self::NoCommands(_) => "no-commands",
            Self::LinkFailed(_) => "link-failed",
        }
    }

    /// Returns how the robot ends.
    pub fn way(&self) -> Way {
        match self {
            Self::Asked
            | Self::TimeOver { .. }
            | Self::Action(_)
            | Self::Network(_)
            | Self::Deadline { .. }
            | Self::NoCommands(_) => Way::Down,
            Self::NotPermitted(_)
            | Self::Position { .. }
            | Self::Speed { .. }
            | Self::Torque { .. }
            | Self::Attitude { .. }
            | Self::Stale { .. }
            | Self::NoAnswer
            | Self::Implausible(_)
            | Self::Observation(_)
            | Self::LinkFailed(_) => Way::Limp,
        }
    }

    /// Returns whether the network gives no targets.
    pub fn is_of_network(&self) -> bool {
        matches!(self, Self::Action(_) | Self::Network(_))
    }

    /// Returns whether the user wanted it.
    pub fn is_wanted(&self) -> bool {
        matches!(self, Self::Asked | Self::TimeOver { .. })
    }
}

/// Limits of a joint, in the policy's sense.
#[derive(Clone, Debug, PartialEq)]
struct JointLimits {
    name: String,
    /// Angles in rad. A wheel has no range.
    range_rad: Option<[f32; 2]>,
    speed_rps: f32,
    torque_nm: f32,
    /// For so long in s it has been asked for more torque.
    overloaded_s: f64,
}

/// Limits of a robot under a policy.
#[derive(Clone, Debug)]
pub struct Limits {
    joints: Vec<JointLimits>,
    tilt_rad: f32,
}

impl Limits {
    /// Takes ranges and speeds from the robot's description, and torques from the policy.
    pub fn new(policy: &PolicyDescription, robot: &Robot) -> Self {
        let placed = policy
            .mapping
            .motors()
            .iter()
            .zip(policy.mapping.directions());
        let joints = policy.joints.iter().zip(placed);
        let joints = joints.map(|(joint, (motor, direction))| {
            let is_wheel = joint.drive == Drive::Speed;
            JointLimits {
                name: joint.name.clone(),
                range_rad: (!is_wheel).then(|| range_rad(robot, *motor, *direction)),
                speed_rps: if is_wheel {
                    WHEEL_RPS.min(robot.wheels.no_load_rps as f32)
                } else {
                    robot.joints.speed_limit_rps as f32
                },
                torque_nm: joint.torque_limit_nm,
                overloaded_s: 0.0,
            }
        });
        Self {
            joints: joints.collect(),
            tilt_rad: TILT_RAD,
        }
    }

    /// Returns the range in rad of joint `index` of the policy, in its sense. A wheel has none.
    pub fn range_rad(&self, index: usize) -> Option<[f32; 2]> {
        self.joints.get(index).and_then(|joint| joint.range_rad)
    }

    /// Checks each joint's angle.
    ///
    /// # Errors
    /// One is beyond the stops of its range.
    pub fn check_positions(&self, reading: &Reading) -> Result<(), Stop> {
        for (joint, rad) in self.joints.iter().zip(&reading.joint_pos_rad) {
            if let Some([low, high]) = joint.range_rad
                && !(low - GIVES_RAD..=high + GIVES_RAD).contains(rad)
            {
                let (joint, rad) = (joint.name.clone(), *rad);
                return Err(Stop::Position {
                    joint,
                    rad,
                    low,
                    high,
                });
            }
        }
        Ok(())
    }

    /// Checks each joint's speed.
    ///
    /// # Errors
    /// One is too fast.
    pub fn check_speeds(&self, reading: &Reading) -> Result<(), Stop> {
        for (joint, rps) in self.joints.iter().zip(&reading.joint_vel_rps) {
            if rps.abs() > joint.speed_rps {
                return Err(Stop::Speed {
                    joint: joint.name.clone(),
                    rps: *rps,
                    most: joint.speed_rps,
                });
            }
        }
        Ok(())
    }

    /// Checks how far the body leans: the angle between its z and the vertical.
    ///
    /// # Errors
    /// It leans too far.
    pub fn check_attitude(&self, reading: &Reading) -> Result<(), Stop> {
        let [_, _, down] = reading.attitude.gravity();
        let tilt_rad = (-down).clamp(-1.0, 1.0).acos();
        if tilt_rad > self.tilt_rad {
            return Err(Stop::Attitude {
                degrees: tilt_rad.to_degrees(),
                most: self.tilt_rad.to_degrees(),
            });
        }
        Ok(())
    }

    /// Checks the torque that each motor would have by its target, `dt_s` after the last time, before it is held within
    /// its limit ([`Target::torque_nm`]).
    ///
    /// # Errors
    /// One was above its limit for [`OVERLOAD_S`], without a break.
    pub fn check_torques(
        &mut self,
        dt_s: f64,
        reading: &Reading,
        targets: &[Target],
    ) -> Result<(), Stop> {
        let measured = reading.joint_pos_rad.iter().zip(&reading.joint_vel_rps);
        for ((joint, target), (rad, rps)) in self.joints.iter_mut().zip(targets).zip(measured) {
            let nm = target.torque_nm(*rad, *rps);
            if nm.abs() <= joint.torque_nm {
                joint.overloaded_s = 0.0;
                continue;
            }
            joint.overloaded_s += dt_s;
            if joint.overloaded_s > OVERLOAD_S {
                return Err(Stop::Torque {
                    joint: joint.name.clone(),
                    nm,
                    most: joint.torque_nm,
                });
            }
        }
        Ok(())
    }

    /// Moves targets so that each motor's torque stays within its limit ([`Target::within_torque`]).
    pub fn hold_torques(&self, reading: &Reading, targets: &mut [Target]) {
        let measured = reading.joint_pos_rad.iter().zip(&reading.joint_vel_rps);
        for ((joint, target), (rad, rps)) in self.joints.iter().zip(targets).zip(measured) {
            *target = target.within_torque(joint.torque_nm, *rad, *rps);
        }
    }

    /// Forgets for how long torques were above their limits.
    pub fn reset(&mut self) {
        for joint in &mut self.joints {
            joint.overloaded_s = 0.0;
        }
    }
}

/// The range of a motor that is a joint, in the policy's sense.
fn range_rad(robot: &Robot, motor: usize, direction: f32) -> [f32; 2] {
    let ranges = &robot.joints.range_rad;
    let is_front = MOTOR_NAMES[motor].contains("front");
    let range = if is_front { ranges.front } else { ranges.rear };
    let [low, high] = range.map(|rad| direction * rad as f32);
    [low.min(high), low.max(high)]
}

#[cfg(test)]
mod tests;
