//! Conversion between a group of settings and a record of the store (docs/parameters.md).

use core::cmp::Ordering;

use super::{Record, RecordId, save_scheduler::GroupIndex};
use crate::{
    domain::RobotConfig,
    motor::layout::MotorLayout,
    tuning::{ParameterGroup, Refusal, Scope, consistency},
};

/// The result of loading a record at boot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadOutcome {
    /// The values are in use. Settings that the record is too old to contain have their defaults.
    Loaded(GroupIndex),
    /// The record has a later version, or values that are not allowed.
    Refused(GroupIndex),
    /// The record belongs to a group that this firmware does not have, or to motors that the robot does not have.
    Foreign,
}

/// Encodes a group of settings as a record.
pub fn encode(group: &ParameterGroup, config: &RobotConfig, layout: &MotorLayout) -> Record {
    let mut values = heapless::Vec::new();
    for parameter in group.parameters {
        // The compiler checks that no group is larger than a record.
        let _ = values.push(parameter.read(config).to_bits());
    }
    Record {
        id: id(group, layout),
        version: group.version,
        values,
    }
}

/// Loads a record into `config`, either all values or none. `groups` is `tuning::PARAMETERS`.
pub fn load(
    record: &Record,
    groups: &[ParameterGroup],
    layout: &MotorLayout,
    config: &mut RobotConfig,
) -> LoadOutcome {
    let mut groups = groups.iter().enumerate();
    let Some((position, group)) = groups.find(|(_, group)| id(group, layout) == record.id) else {
        return LoadOutcome::Foreign;
    };
    match migrate(record, group, *config) {
        Ok(loaded) => {
            *config = loaded;
            LoadOutcome::Loaded(position)
        }
        Err(_) => LoadOutcome::Refused(position),
    }
}

/// Later versions only append settings, so the values of an earlier version come first.
fn migrate(
    record: &Record,
    group: &ParameterGroup,
    mut config: RobotConfig,
) -> Result<RobotConfig, Refusal> {
    let (held, known) = (record.values.len(), group.parameters.len());
    let fits = match record.version.cmp(&group.version) {
        Ordering::Less => held < known,
        Ordering::Equal => held == known,
        Ordering::Greater => false,
    };
    if !fits {
        return Err(Refusal::WrongLength);
    }
    for (parameter, bits) in group.parameters.iter().zip(&record.values) {
        parameter.write(&mut config, f32::from_bits(*bits))?;
    }
    consistency::check(&config)?;
    Ok(config)
}

/// Settings of a joint belong to one make of motor.
fn id(group: &ParameterGroup, layout: &MotorLayout) -> RecordId {
    let variant = match group.scope {
        Scope::Robot => 0,
        Scope::Joint(joint) => layout
            .joints()
            .get(joint)
            .map_or(0, |slot| slot.motor.make()),
    };
    RecordId {
        key: group.number,
        variant,
    }
}

#[cfg(test)]
mod tests;
