//! All settings. Numbers of groups and settings are on the wire: add new ones, never renumber old ones.

use super::{Parameter, ParameterGroup, Refusal, Scope};

mod joints;
mod mounting;
mod radio;
mod safety;
mod sensors;
mod wheels;

/// All groups, by number.
pub static PARAMETERS: [ParameterGroup; 15] = [
    ParameterGroup {
        number: WHEEL_GEOMETRY,
        name: "wheel-geometry",
        version: 1,
        scope: Scope::Robot,
        parameters: &wheels::GEOMETRY,
    },
    ParameterGroup {
        number: 2,
        name: "wheel-controller",
        version: 1,
        scope: Scope::Robot,
        parameters: &wheels::CONTROLLER,
    },
    ParameterGroup {
        number: 3,
        name: "joint-controller",
        version: 2,
        scope: Scope::Robot,
        parameters: &joints::CONTROLLER,
    },
    ParameterGroup {
        number: 4,
        name: "safety",
        version: 4,
        scope: Scope::Robot,
        parameters: &safety::SAFETY,
    },
    ParameterGroup {
        number: 5,
        name: "imu-calibration",
        version: 1,
        scope: Scope::Robot,
        parameters: &sensors::IMU,
    },
    ParameterGroup {
        number: 6,
        name: "mag-calibration",
        version: 1,
        scope: Scope::Robot,
        parameters: &sensors::MAG,
    },
    ParameterGroup {
        number: 7,
        name: "heater",
        version: 1,
        scope: Scope::Robot,
        parameters: &sensors::HEATER,
    },
    ParameterGroup {
        number: 8,
        name: "mounting",
        version: 1,
        scope: Scope::Robot,
        parameters: &mounting::MOUNTING,
    },
    ParameterGroup {
        number: 9,
        name: "radio",
        version: 2,
        scope: Scope::Robot,
        parameters: &radio::CHANNELS,
    },
    ParameterGroup {
        number: 10,
        name: "radio-travel",
        version: 1,
        scope: Scope::Robot,
        parameters: &radio::TRAVEL,
    },
    ParameterGroup {
        number: 11,
        name: "stand-up",
        version: 1,
        scope: Scope::Robot,
        parameters: &safety::STAND_UP,
    },
    ParameterGroup {
        number: 16,
        name: "joint-left-front",
        version: 1,
        scope: Scope::Joint(0),
        parameters: &joints::LEFT_FRONT,
    },
    ParameterGroup {
        number: 17,
        name: "joint-left-rear",
        version: 1,
        scope: Scope::Joint(1),
        parameters: &joints::LEFT_REAR,
    },
    ParameterGroup {
        number: 18,
        name: "joint-right-front",
        version: 1,
        scope: Scope::Joint(2),
        parameters: &joints::RIGHT_FRONT,
    },
    ParameterGroup {
        number: 19,
        name: "joint-right-rear",
        version: 1,
        scope: Scope::Joint(3),
        parameters: &joints::RIGHT_REAR,
    },
];

pub(super) const WHEEL_GEOMETRY: u8 = 1;

/// The other joints' groups follow in the order of the motor layout.
const FIRST_JOINT: u8 = 16;
const JOINT_ZERO: u8 = 1;

/// The setting for the zero of a joint in motor coordinates.
pub(super) fn joint_zero(joint: u8) -> Result<&'static Parameter, Refusal> {
    find(FIRST_JOINT.saturating_add(joint), JOINT_ZERO)
}

/// The bit of the group at this index of [`PARAMETERS`] in a mask of groups.
pub(crate) const fn bit(position: usize) -> u32 {
    1u32.wrapping_shl(position as u32)
}

/// Finds the setting with these numbers.
pub(super) fn find(group: u8, index: u8) -> Result<&'static Parameter, Refusal> {
    PARAMETERS
        .iter()
        .find(|candidate| candidate.number == group)
        .and_then(|group| {
            let mut parameters = group.parameters.iter();
            parameters.find(|parameter| parameter.index == index)
        })
        .ok_or(Refusal::UnknownParameter)
}

#[cfg(test)]
mod tests;
