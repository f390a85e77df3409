//! What a row of the matrix says: reactions, flags, and what happens after the fault. Times count from the start of the
//! fault.

use robot_plant::time::{MS, Ps};

use crate::{
    balancing_expected::{Balancing, PART_LOST_MS},
    driver::Driver,
};

/// Reaction of the actuators of one kind during the fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Group {
    /// No torque from this many ms on.
    Zero(f64),
    /// The actuator follows its commands as before.
    Runs,
    /// The actuator may run on or stop, because the fault is at the edge of a limit.
    Either,
    /// No frame reaches the actuator; the device itself decides.
    Unreachable,
}

/// Actuators that move after the fault, while the pilot only keeps pushing the stick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum After {
    /// Nothing.
    Off,
    /// All.
    Drives,
    /// Wheels only.
    WheelsOnly,
    /// Joints only.
    JointsOnly,
    /// Actuators that the fault stopped stay off, the others drive on.
    WhatRan,
    /// Nothing moves until the PC has sent a command from rest; then all drives.
    PcWaits,
    /// The wheels stay off until the stick has been centred, then all drives; the joints continue at once.
    WheelsWait,
    /// The joints stay off until the stick has been centred, then all drives; the wheels continue at once.
    JointsWait,
}

/// An armed phase.
#[derive(Clone, Debug)]
pub struct Armed {
    pub wheels: Group,
    pub joints: Group,
    pub flags: Flags,
    pub after: After,
}

/// The disarmed phase, in which nothing moves: whether the enable switch arms the robot during the fault, and after it.
#[derive(Clone, Debug)]
pub struct Disarmed {
    pub flags: Flags,
    pub arms_during: Arms,
    pub arms_after: Arms,
    pub moves: Moves,
}

/// What a robot does that was armed during the fault or after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moves {
    AsArmed,
    /// It has no torque, because the PC that drives has not started from rest.
    Never,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arms {
    Yes,
    No,
    Either,
}

/// Safety flags that the fault raises.
#[derive(Clone, Debug, Default)]
pub struct Flags {
    /// All of these must rise.
    pub must: Vec<&'static str>,
    /// Any of these may rise as well; no other may.
    pub may: Vec<&'static str>,
}

#[derive(Clone, Debug)]
pub struct Row {
    pub fault: &'static str,
    pub driver: Driver,
    pub lasts: Ps,
    /// During the fault every torque is zero or what the PC asks for.
    pub keeps_law: bool,
    /// Largest torque of a joint while a PC drives.
    pub most_torque_nm: f64,
    pub driving: Armed,
    pub idle: Armed,
    pub disarmed: Disarmed,
    pub balancing: Balancing,
    /// Longest time from the end of the fault until everything works again.
    pub back_within_ms: f64,
    /// The chip is reset.
    pub resets: bool,
    /// Parts of the board errors that the fault causes.
    pub board_errors: &'static [&'static str],
}

/// The setting of 5 N·m, and what a leg may have moved since its report.
const MOST_TORQUE_NM: f64 = 5.3;

pub fn flags(must: &[&'static str], may: &[&'static str]) -> Flags {
    Flags {
        must: must.to_vec(),
        may: may.to_vec(),
    }
}

/// A fault with the same outcome in both armed phases, during which a disarmed robot cannot be armed.
pub fn row(fault: &'static str, wheels: Group, joints: Group, flags: Flags, after: After) -> Row {
    let balancing = Balancing::of(wheels, joints, &flags, after);
    let armed = Armed {
        wheels,
        joints,
        flags: flags.clone(),
        after,
    };
    Row {
        fault,
        driver: Driver::Pilot,
        lasts: 2_000 * MS,
        keeps_law: false,
        most_torque_nm: MOST_TORQUE_NM,
        driving: armed.clone(),
        idle: armed,
        disarmed: Disarmed {
            flags,
            arms_during: Arms::No,
            arms_after: Arms::Yes,
            moves: Moves::AsArmed,
        },
        balancing,
        back_within_ms: 1_000.0,
        resets: false,
        board_errors: &[],
    }
}

/// Everything stops within these milliseconds and stays off until the pilot arms again.
pub fn global(fault: &'static str, within_ms: f64, flags: Flags) -> Row {
    let zero = Group::Zero(within_ms);
    row(fault, zero, zero, flags, After::Off)
}

/// A fault of a part that is not needed.
pub fn harmless(fault: &'static str, flags: Flags) -> Row {
    row(fault, Group::Runs, Group::Runs, flags, After::Drives).arms_during(Arms::Yes)
}

impl Row {
    pub fn arms_during(mut self, arms: Arms) -> Self {
        self.disarmed.arms_during = arms;
        self
    }

    /// A human must look first: the enable switch alone does not arm again.
    pub fn latched(mut self) -> Self {
        self.disarmed.arms_after = Arms::No;
        self.balancing.arms_after = Arms::No;
        self
    }

    /// Actuators that regain their supply or bus do not start while the stick is pushed.
    pub fn waiting(mut self, after: After) -> Self {
        self.driving.after = after;
        self.driving.flags.may.push("sticks-awaited");
        self
    }

    /// A robot that balances needs both wheels, of which this one no longer reports, or hears nothing either.
    pub fn losing_wheel(mut self, wheel: usize, deaf: bool) -> Self {
        let zero = Group::Zero(PART_LOST_MS);
        self.balancing.loses_part(zero, zero);
        self.balancing.deaf_wheel = deaf.then_some(wheel);
        self
    }

    /// A robot that balances may fall, which may raise `flags`.
    pub fn may_fall(mut self, flags: &[&'static str]) -> Self {
        self.balancing.may_fall();
        self.balancing.may_raise(flags);
        self
    }

    /// A robot that balances is thrown over, and knows it this soon.
    pub fn thrown_over(mut self, within_ms: f64) -> Self {
        let zero = Group::Zero(within_ms);
        self.balancing.flags = Flags::default();
        self.balancing.lets_go(zero, zero);
        self
    }

    pub fn driven_by(mut self, driver: Driver) -> Self {
        self.driver = driver;
        self
    }

    /// The fault cannot be detected while nothing turns.
    pub fn unseen_at_rest(mut self) -> Self {
        self.idle = Armed {
            wheels: Group::Runs,
            joints: Group::Runs,
            flags: Flags::default(),
            after: After::Drives,
        };
        self.disarmed = Disarmed {
            flags: Flags::default(),
            arms_during: Arms::Yes,
            arms_after: Arms::Yes,
            moves: self.disarmed.moves,
        };
        self
    }

    pub fn causing_board_errors(mut self, of: &'static [&'static str]) -> Self {
        self.board_errors = of;
        self
    }

    pub fn back_within_ms(mut self, ms: f64) -> Self {
        self.back_within_ms = ms;
        self
    }

    pub fn resetting(mut self) -> Self {
        self.resets = true;
        self
    }
}
