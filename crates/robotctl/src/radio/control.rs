//! The controls of a transmitter, and the words that ask the pilot to move them.

use robot_app::input::{SBUS_SWITCH_HIGH, SBUS_SWITCH_LOW};

/// A stick's axis or a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    Steering,
    Drive,
    Select,
    DeadMan,
    Enable,
    Mode,
    EStop,
    Stand,
    Jump,
    Height,
    Roll,
}

impl Control {
    pub const STICKS: [Self; 4] = [Self::Drive, Self::Steering, Self::Select, Self::DeadMan];
    /// What only a standing robot needs, in the order of the requests. The robot knows no travel of their channels.
    pub const BALANCE: [Self; 4] = [Self::Stand, Self::Jump, Self::Height, Self::Roll];
    /// The switches in the order of the requests. The e-stop is last and stays thrown while the others are moved.
    pub const SWITCHES: [Self; 3] = [Self::Mode, Self::Enable, Self::EStop];

    /// Returns the name that settings use for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Steering => "steering",
            Self::Drive => "drive",
            Self::Select => "select",
            Self::DeadMan => "dead-man",
            Self::Enable => "enable",
            Self::Mode => "mode",
            Self::EStop => "e-stop",
            Self::Stand => "stand",
            Self::Jump => "jump",
            Self::Height => "height",
            Self::Roll => "roll",
        }
    }

    /// Says what the pilot must do.
    pub fn request(self) -> &'static str {
        match self {
            Self::Drive => "Push the stick that shall drive fully forward and hold it there.",
            Self::Steering => {
                "Let go, then push the stick that shall steer fully to the right and hold it there."
            }
            Self::Select => {
                "Let go, then push the other stick, which selects a motor in bring-up, fully forward and hold it there."
            }
            Self::DeadMan => {
                "That one back to its middle, then push it, the dead man of bring-up, fully to the right and hold it there."
            }
            Self::Stand => "All as at the start. Put the stand switch to stand.",
            Self::Jump => {
                "All as at the start. Hold the jump button down, or put its switch to jump."
            }
            Self::Height => {
                "All as at the start. Turn the knob for the height to its end for long legs."
            }
            Self::Roll => {
                "All as at the start. Turn the knob for the roll to its end for the right side down."
            }
            Self::Mode => "All as at the start. Put the mode switch to its far end, custom.",
            Self::Enable => {
                "Mode back to manual. With the e-stop thrown, put the enable switch to on."
            }
            Self::EStop => {
                "Enable back to off. Put the e-stop to run; the robot still cannot be armed."
            }
        }
    }

    /// Describes the end that the settings call high.
    pub fn high_end(self) -> &'static str {
        match self {
            Self::Steering | Self::DeadMan => "right",
            Self::Drive | Self::Select => "forward",
            Self::Enable => "on",
            Self::Mode => "custom",
            Self::EStop => "stop",
            Self::Stand => "stand",
            Self::Jump => "jump",
            Self::Height => "long legs",
            Self::Roll => "right side down",
        }
    }

    /// True if the robot can be armed without it.
    pub fn may_be_missing(self) -> bool {
        matches!(self, Self::Select | Self::DeadMan | Self::Mode) || !self.has_travel()
    }

    /// True if the robot has settings for its ends and its centre.
    pub(super) fn has_travel(self) -> bool {
        !Self::BALANCE.contains(&self)
    }

    /// True if the requested movement goes towards the high end. It does not for the e-stop, which was thrown before.
    pub(super) fn goes_up(self) -> bool {
        self != Self::EStop
    }

    /// Returns the fewest counts of an intended movement. A switch goes from end to end, and the robot needs 200 counts
    /// on each side of its middle. A knob goes from its middle to an end, as a stick does.
    pub(super) fn least_move(self) -> u16 {
        if Self::STICKS.contains(&self) || matches!(self, Self::Height | Self::Roll) {
            300
        } else {
            400
        }
    }

    /// True if the robot takes a movement between these counts for what it is. That of a switch without settings for
    /// its ends must cross the robot's own limits.
    pub(super) fn is_reached(self, from: u16, to: u16) -> bool {
        const LOW: u16 = SBUS_SWITCH_LOW;
        const HIGH: u16 = SBUS_SWITCH_HIGH;
        let (low, high) = (from.min(to), from.max(to));
        match self {
            Self::Stand => low <= LOW && high >= HIGH,
            Self::Jump if to > from => from < HIGH && to >= HIGH,
            Self::Jump => from > LOW && to <= LOW,
            _ => true,
        }
    }
}
