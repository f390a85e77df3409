//! The controls of a transmitter, and the words that ask the pilot to move them.

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
}

impl Control {
    pub const STICKS: [Self; 4] = [Self::Drive, Self::Steering, Self::Select, Self::DeadMan];
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
            Self::Mode => "Sticks at rest. Put the mode switch to its far end, custom.",
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
        }
    }

    /// True if the robot can be armed without it.
    pub fn may_be_missing(self) -> bool {
        matches!(self, Self::Select | Self::DeadMan | Self::Mode)
    }

    /// True if the requested movement goes towards the high end. It does not for the e-stop, which was thrown before.
    pub(super) fn goes_up(self) -> bool {
        self != Self::EStop
    }

    /// Returns the fewest counts of an intended movement. A switch goes from end to end, and the robot needs 200 counts
    /// on each side of its middle.
    pub(super) fn least_move(self) -> u16 {
        if Self::STICKS.contains(&self) {
            300
        } else {
            400
        }
    }
}
