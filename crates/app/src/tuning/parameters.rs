//! Everything that can be tuned. Numbers of groups and settings are on the wire: add, never renumber.

use super::{Parameter, ParameterGroup, Refusal};

mod joints;
mod safety;
mod sensors;
mod wheels;

/// By group.
pub static PARAMETERS: [ParameterGroup; 11] = [
    ParameterGroup {
        number: WHEEL_GEOMETRY,
        name: "wheel-geometry",
        parameters: &wheels::GEOMETRY,
    },
    ParameterGroup {
        number: 2,
        name: "wheel-controller",
        parameters: &wheels::CONTROLLER,
    },
    ParameterGroup {
        number: 3,
        name: "joint-controller",
        parameters: &joints::CONTROLLER,
    },
    ParameterGroup {
        number: 4,
        name: "safety",
        parameters: &safety::SAFETY,
    },
    ParameterGroup {
        number: 5,
        name: "imu-calibration",
        parameters: &sensors::IMU,
    },
    ParameterGroup {
        number: 6,
        name: "mag-calibration",
        parameters: &sensors::MAG,
    },
    ParameterGroup {
        number: 7,
        name: "heater",
        parameters: &sensors::HEATER,
    },
    ParameterGroup {
        number: 16,
        name: "joint-left-front",
        parameters: &joints::LEFT_FRONT,
    },
    ParameterGroup {
        number: 17,
        name: "joint-left-rear",
        parameters: &joints::LEFT_REAR,
    },
    ParameterGroup {
        number: 18,
        name: "joint-right-front",
        parameters: &joints::RIGHT_FRONT,
    },
    ParameterGroup {
        number: 19,
        name: "joint-right-rear",
        parameters: &joints::RIGHT_REAR,
    },
];

pub(super) const WHEEL_GEOMETRY: u8 = 1;

/// The setting with these numbers.
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
