//! The states of a run: passive, getting up, the policy, to the default pose, getting down, passive.

use crate::{
    Drive, PolicyDescription,
    action::Target,
    limits::{Stop, Way},
    observation::Reading,
};

/// How long each state lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Time in s for which nothing must be in the way before the robot gets up.
    pub settle_s: f64,
    /// Time in s from the measured pose to the default pose.
    pub get_up_s: f64,
    /// Time in s in the default pose before the policy takes over.
    pub hold_s: f64,
    /// Time in s in which the joints' targets go from the network's to the default pose before the robot gets down.
    pub to_default_s: f64,
    /// Time in s from the measured pose to that from which the robot got up.
    pub get_down_s: f64,
}

impl Default for Timing {
    fn default() -> Self {
        Self {
            settle_s: 0.5,
            get_up_s: 1.0,
            hold_s: 1.0,
            to_default_s: 2.0,
            get_down_s: 2.0,
        }
    }
}

/// A state of the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// No motor has torque. A run begins and ends with it.
    Passive,
    /// Joints go from where they are to the default pose and stay there; wheels hold speed 0.
    GetUp,
    /// The network drives.
    Policy,
    /// The network drives without a command. Joints go from its targets to the default pose, wheels go on as it says: so a robot
    /// that cannot stand by itself balances until it is low.
    ToDefault,
    /// Joints go back to where they were before getting up; wheels hold speed 0.
    GetDown,
}

impl Phase {
    /// Returns its name, as in the log.
    pub fn name(self) -> &'static str {
        match self {
            Self::Passive => "passive",
            Self::GetUp => "get-up",
            Self::Policy => "policy",
            Self::ToDefault => "to-default",
            Self::GetDown => "get-down",
        }
    }

    /// Returns whether the network drives.
    pub fn is_driven(&self) -> bool {
        matches!(self, Self::Policy | Self::ToDefault)
    }
}

/// The states of one run. Time is the caller's, in s.
#[derive(Clone, Debug)]
pub struct Machine {
    timing: Timing,
    joints: Vec<Pose>,
    phase: Phase,
    /// When the phase began.
    since_s: f64,
    /// Since when nothing is in the way.
    clear_since_s: Option<f64>,
    ended_by: Option<Stop>,
}

/// Angles of a joint in rad, and its gains between them.
#[derive(Clone, Debug)]
struct Pose {
    drive: Drive,
    default_rad: f32,
    kp: f32,
    kd: f32,
    /// Where it was before the robot got up.
    rest_rad: f32,
    /// Where it was when the phase began.
    from_rad: f32,
}

impl Machine {
    /// Returns the start of a run.
    pub fn new(policy: &PolicyDescription, timing: Timing) -> Self {
        let joints = policy.joints.iter().map(|joint| Pose {
            drive: joint.drive,
            default_rad: joint.default_rad,
            kp: joint.fixed_kp,
            kd: joint.fixed_kd,
            rest_rad: 0.0,
            from_rad: 0.0,
        });
        Self {
            timing,
            joints: joints.collect(),
            phase: Phase::Passive,
            since_s: 0.0,
            clear_since_s: None,
            ended_by: None,
        }
    }

    /// Returns the state.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Returns the time in s since the state began.
    pub fn elapsed_s(&self, now_s: f64) -> f64 {
        now_s - self.since_s
    }

    /// Returns why the run ends, if it does: the first reason is kept.
    pub fn ended_by(&self) -> Option<&Stop> {
        self.ended_by.as_ref()
    }

    /// Returns whether the run has ended, and the robot has got down.
    pub fn is_over(&self) -> bool {
        self.ended_by.is_some() && self.phase == Phase::Passive
    }

    /// Goes on. `is_clear` says that nothing keeps the robot from obeying.
    pub fn step(&mut self, now_s: f64, is_clear: bool, reading: &Reading) -> Phase {
        let elapsed_s = self.elapsed_s(now_s);
        match self.phase {
            Phase::Passive if self.ended_by.is_none() => self.wait(now_s, is_clear, reading),
            Phase::Passive | Phase::Policy => {}
            Phase::GetUp => {
                if elapsed_s >= self.timing.get_up_s + self.timing.hold_s {
                    self.enter(Phase::Policy, now_s, reading);
                }
            }
            Phase::ToDefault => {
                if elapsed_s >= self.timing.to_default_s {
                    self.enter(Phase::GetDown, now_s, reading);
                }
            }
            Phase::GetDown => {
                if elapsed_s >= self.timing.get_down_s {
                    self.enter(Phase::Passive, now_s, reading);
                }
            }
        }
        self.phase
    }

    fn wait(&mut self, now_s: f64, is_clear: bool, reading: &Reading) {
        if !is_clear {
            self.clear_since_s = None;
            return;
        }
        let since_s = *self.clear_since_s.get_or_insert(now_s);
        if now_s - since_s >= self.timing.settle_s {
            for (pose, rad) in self.joints.iter_mut().zip(&reading.joint_pos_rad) {
                pose.rest_rad = *rad;
            }
            self.enter(Phase::GetUp, now_s, reading);
        }
    }

    /// Ends the run. A robot that gets down goes on doing so, unless this stop or a second wish of the user lets it go limp. It
    /// does without its network if that is what fails.
    pub fn stop(&mut self, stop: Stop, now_s: f64, reading: &Reading) -> Phase {
        let is_second_wish = self.ended_by.is_some() && stop.is_wanted();
        let next = match (stop.way(), self.phase) {
            (Way::Limp, _) | (_, Phase::Passive) => Phase::Passive,
            (_, Phase::ToDefault | Phase::GetDown) if is_second_wish => Phase::Passive,
            (_, Phase::GetUp | Phase::GetDown) => Phase::GetDown,
            (_, Phase::Policy | Phase::ToDefault) if stop.is_of_network() => Phase::GetDown,
            (_, Phase::Policy | Phase::ToDefault) => Phase::ToDefault,
        };
        if next != self.phase {
            self.enter(next, now_s, reading);
        }
        self.ended_by.get_or_insert(stop);
        self.phase
    }

    fn enter(&mut self, phase: Phase, now_s: f64, reading: &Reading) {
        self.phase = phase;
        self.since_s = now_s;
        for (pose, rad) in self.joints.iter_mut().zip(&reading.joint_pos_rad) {
            pose.from_rad = *rad;
        }
    }

    /// Moves the network's targets of joints by `share · (default − target)`, with a share that grows from 0 to 1 in the time of the
    /// state, on the way to the default pose. Otherwise they stay.
    pub fn lead_to_default(&self, now_s: f64, targets: &mut [Target]) {
        if self.phase != Phase::ToDefault {
            return;
        }
        let share = self.share(now_s, self.timing.to_default_s);
        for (pose, target) in self.joints.iter().zip(targets) {
            if let Target::Position { rad, .. } = target {
                *rad += share * (pose.default_rad - *rad);
            }
        }
    }

    fn share(&self, now_s: f64, of_s: f64) -> f32 {
        (self.elapsed_s(now_s) / of_s.max(1e-3)).clamp(0.0, 1.0) as f32
    }

    /// Writes the targets of getting up or down: of a joint `from + share · (to − from)` with a share that grows from 0 to 1
    /// in the time of the state, of a wheel the speed 0.
    pub fn pose(&self, now_s: f64, targets: &mut Vec<Target>) {
        let (is_up, time_s) = match self.phase {
            Phase::GetDown => (false, self.timing.get_down_s),
            _ => (true, self.timing.get_up_s),
        };
        let share = self.share(now_s, time_s);
        targets.clear();
        targets.extend(self.joints.iter().map(|pose| match pose.drive {
            Drive::Speed => Target::Speed {
                rps: 0.0,
                kd: pose.kd,
            },
            Drive::Position => {
                let to_rad = if is_up {
                    pose.default_rad
                } else {
                    pose.rest_rad
                };
                Target::Position {
                    rad: pose.from_rad + share * (to_rad - pose.from_rad),
                    kp: pose.kp,
                    kd: pose.kd,
                }
            }
        }));
    }
}

#[cfg(test)]
mod tests;
