//! What keeps the robot from following the PC.

use std::fmt;

use crate::link_recorder::Mode;

/// The first thing that the pilot has to change.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Obstacle {
    RadioLost,
    /// The mode chosen on the radio is another one.
    NotPc(Mode),
    /// With the reasons that keep it from being armed.
    Disarmed(Vec<String>),
    /// The PC is heard no more.
    PcLost,
    /// The robot waits for a command from rest, which comes by itself.
    PcAwaited,
    /// The robot is stopped for these reasons.
    Stopped(Vec<String>),
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RadioLost => write!(
                f,
                "the robot does not hear its radio: switch the transmitter on"
            ),
            Self::NotPc(mode) => {
                write!(
                    f,
                    "the radio's mode is {mode}, not PC: turn the mode switch to PC"
                )
            }
            Self::Disarmed(blockers) if blockers.is_empty() => {
                write!(f, "not armed: flip the enable switch off and on")
            }
            Self::Disarmed(blockers) if blockers.iter().eq(["enable-off"]) => {
                write!(f, "not armed: switch enable on")
            }
            Self::Disarmed(blockers) => write!(
                f,
                "not armed ({}): `robotctl status` says what to do; then enable off and on",
                blockers.join(", ")
            ),
            Self::PcLost => write!(
                f,
                "the robot hears no command (pc-lost): is the adapter's TX connected to the board's RX?"
            ),
            Self::PcAwaited => write!(f, "the robot waits for a command from rest (pc-awaited)"),
            Self::Stopped(flags) => write!(
                f,
                "the robot is stopped ({}): `robotctl status` says what to do",
                flags.join(", ")
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_switch_that_is_off_is_the_only_thing_to_do() {
        let said = |blockers: &[&str]| {
            let blockers = blockers.iter().map(|name| (*name).to_owned());
            Obstacle::Disarmed(blockers.collect()).to_string()
        };
        assert_eq!(said(&["enable-off"]), "not armed: switch enable on");
        assert!(said(&["enable-off", "battery-low"]).contains("battery-low"));
    }
}
