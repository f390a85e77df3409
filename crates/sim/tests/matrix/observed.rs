//! Observations of a run, on the wires and in the firmware's diagnostics.

use std::collections::BTreeSet;

use robot_plant::time::{MS, Ps};

/// State of the robot when the fault starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Phase {
    /// Armed, wheels turning, legs held.
    Driving,
    /// Armed, sticks centred.
    Idle,
    Disarmed,
    /// Armed, standing on two wheels and driving.
    Balancing,
}

impl Phase {
    pub const ALL: [Self; 4] = [Self::Driving, Self::Idle, Self::Disarmed, Self::Balancing];
}

impl std::fmt::Display for Phase {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Driving => "armed, driving",
            Self::Idle => "armed, idle",
            Self::Disarmed => "disarmed",
            Self::Balancing => "balancing",
        })
    }
}

/// Changes on the wire of one motor since the fault started: the commanded current of a wheel (mA), or the state of a joint
/// (1 = enabled), for which its torque in N·m stands while a PC drives.
#[derive(Clone, Debug, Default)]
pub struct Wire {
    /// Value at the instant of the fault.
    pub before: f64,
    pub changes: Vec<(Ps, f64)>,
}

impl Wire {
    pub fn last(&self) -> f64 {
        self.changes.last().map_or(self.before, |(_, value)| *value)
    }

    /// The value at the end of `from ..= to`.
    pub fn at(&self, time: Ps) -> f64 {
        let earlier = self.changes.iter().rev().find(|(at, _)| *at <= time);
        earlier.map_or(self.before, |(_, value)| *value)
    }

    /// Time from which the value stays zero until `end`, if it does.
    pub fn zero_from(&self, end: Ps) -> Option<Ps> {
        if self.at(end) != 0.0 {
            return None;
        }
        let mut zero = if self.before == 0.0 { Some(0) } else { None };
        for (at, value) in self.changes.iter().filter(|(at, _)| *at <= end) {
            if *value != 0.0 {
                zero = None;
            } else if zero.is_none() {
                zero = Some(*at);
            }
        }
        zero
    }

    /// Whether a new command demands torque. An old one that is still in force does not count.
    pub fn told_torque_in(&self, from: Ps, to: Ps) -> bool {
        let inside = self
            .changes
            .iter()
            .filter(|(at, _)| (from..=to).contains(at));
        inside.into_iter().any(|(_, value)| *value != 0.0)
    }

    pub fn had_torque_in(&self, from: Ps, to: Ps) -> bool {
        self.at(from) != 0.0 || self.told_torque_in(from, to)
    }

    /// Whether there was any message.
    pub fn spoke_in(&self, from: Ps, to: Ps) -> bool {
        self.changes.iter().any(|(at, _)| (from..=to).contains(at))
    }
}

/// What a robot that balances looks like, once a millisecond from the start of the fault on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pose {
    pub at: Ps,
    /// The larger one of pitch and roll.
    pub tilt_rad: f64,
    /// Of the middle of the hips.
    pub height_m: f64,
    pub speed_mps: f64,
}

/// The observations of one run.
#[derive(Clone, Debug, Default)]
pub struct Observed {
    /// Left, right.
    pub wheels: [Wire; 2],
    pub joints: [Wire; 4],
    /// Time at which the fault took effect. A failure of the image waits for a call of its function.
    pub struck: Ps,
    /// Ends of the fault and of the run, since the start of the fault.
    pub fault_ended: Ps,
    pub ended: Ps,
    /// Time at which the pilot released the stick, which was pushed until then.
    pub centred: Option<Ps>,
    /// Safety flags that rose during the fault.
    pub flags: BTreeSet<String>,
    /// Number of resets of the chip during the fault.
    pub resets: usize,
    pub armed_at_fault_end: bool,
    pub armed_at_end: bool,
    /// In the disarmed phase: whether the robot armed when the switch went off and on during the fault, and after it.
    pub armed_during_fault: bool,
    pub armed_after_fault: bool,
    /// Instants with torque on a wire although the firmware was not armed.
    pub torque_unarmed: Vec<Ps>,
    /// Torques during the fault that are neither zero nor what the PC asks for.
    pub wrong_torques: Vec<String>,
    pub board_errors: Vec<String>,
    /// Of a robot that balances, and the time at which everything works again.
    pub poses: Vec<Pose>,
    pub back: Ps,
}

/// Standing, the middle of the hips is at 0.25 m; lying or sitting, at 0.16 m at most.
pub const UPRIGHT_M: f64 = 0.2;

impl Observed {
    /// Whether a robot that balanced stands at the end of the run.
    pub fn stands_at_end(&self) -> bool {
        let last = self.poses.last();
        last.is_some_and(|pose| pose.height_m > UPRIGHT_M)
    }
}

/// The firmware's diagnostics are up to two samples old, and a command takes up to a millisecond to the motor.
pub const ARMED_SLACK: Ps = 5 * MS;

#[cfg(test)]
mod tests {
    use super::*;

    fn wire(before: f64, changes: &[(Ps, f64)]) -> Wire {
        Wire {
            before,
            changes: changes.to_vec(),
        }
    }

    #[test]
    fn zero_counts_from_the_first_zero_after_the_last_torque() {
        let stopped = wire(5.0, &[(1, 5.0), (2, 0.0), (3, 4.0), (6, 0.0), (7, 0.0)]);
        assert_eq!(stopped.zero_from(9), Some(6));
        assert_eq!(stopped.zero_from(4), None, "it still had torque then");
        assert_eq!(wire(0.0, &[(3, 0.0)]).zero_from(9), Some(0));
        assert_eq!(wire(2.0, &[]).zero_from(9), None);
    }

    #[test]
    fn an_old_command_is_torque_but_no_new_one() {
        let held = wire(5.0, &[(1, 5.0)]);
        assert!(held.had_torque_in(3, 9) && !held.told_torque_in(3, 9));
        assert!(held.spoke_in(0, 2) && !held.spoke_in(2, 9));
    }
}
