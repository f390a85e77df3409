//! What a robot must do that balances and drives when a fault begins.
//!
//! docs/safety.md#standing-up: it needs all its motors. What stops any of them, stops all, and what stops none leaves it
//! balancing.

use crate::row::{After, Arms, Flags, Group};

/// Outcome of a fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// It balances and follows its commands, as if nothing had happened.
    Drives,
    /// It balances, whatever the damaged commands ask for.
    Balances,
    /// It balances on the spot, until the PC that drives has started from rest.
    OnTheSpot,
    /// It lets go of all motors, and falls.
    LetsGo { wheels: Group, joints: Group },
    /// It may balance on or let go of all motors, because the fault is at the edge of a limit, or of what can be held.
    Either,
}

#[derive(Clone, Debug)]
pub struct Balancing {
    pub outcome: Outcome,
    pub flags: Flags,
    /// Whether the enable switch, off and on, arms a robot that has fallen, while the stand switch stays up.
    pub arms_after: Arms,
    /// The wheel that has no supply or another number. Its last command is no torque any more.
    pub deaf_wheel: Option<usize>,
}

/// A stop of a part is known this soon: a motor or its bus has been silent for 50 ms; and then zero on both buses.
pub const PART_LOST_MS: f64 = 60.0;

/// What a fall may raise.
const FALLS: [&str; 3] = ["tilt", "balance-lost", "estimate-invalid"];

impl Balancing {
    /// By the rule, from the reaction of a robot that cannot fall.
    pub fn of(wheels: Group, joints: Group, flags: &Flags, after: After) -> Self {
        let mut balancing = Self {
            outcome: Outcome::Drives,
            flags: flags.clone(),
            arms_after: Arms::Either,
            deaf_wheel: None,
        };
        match (wheels, joints) {
            (Group::Runs, Group::Runs) if after == After::Drives => {}
            (Group::Either, _) | (_, Group::Either) => balancing.may_fall(),
            (Group::Zero(_), Group::Zero(_)) => balancing.lets_go(wheels, joints),
            (Group::Runs, stopped @ Group::Zero(_)) => balancing.loses_part(stopped, stopped),
            (stopped @ Group::Zero(_), Group::Runs) => balancing.loses_part(stopped, stopped),
            (wheels, Group::Runs) => balancing.loses_part(wheels, Group::Zero(PART_LOST_MS)),
            (wheels, joints) => balancing.lets_go(wheels, joints),
        }
        balancing
    }

    /// A motor does not work any more.
    pub fn loses_part(&mut self, wheels: Group, joints: Group) {
        self.flags.must.push("balance-lost");
        self.lets_go(wheels, joints);
        self.arms_after = Arms::No;
    }

    pub fn lets_go(&mut self, wheels: Group, joints: Group) {
        self.outcome = Outcome::LetsGo { wheels, joints };
        self.may_raise(&FALLS);
    }

    pub fn may_fall(&mut self) {
        self.outcome = Outcome::Either;
        self.may_raise(&FALLS);
    }

    /// Adds flags that are not there.
    pub fn may_raise(&mut self, flags: &[&'static str]) {
        for flag in flags {
            if !self.flags.must.contains(flag) && !self.flags.may.contains(flag) {
                self.flags.may.push(flag);
            }
        }
    }
}
