//! A group of settings as a record of the store, and back (docs/parameters.md).

use core::cmp::Ordering;

use super::{Record, RecordId, saver::Position};
use crate::{
    domain::RobotConfig,
    motor::layout::MotorLayout,
    tuning::{ParameterGroup, Refusal, Scope, consistency},
};

/// What became of a record at boot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// In use. What the record is too old to know has its default.
    Loaded(Position),
    /// A later version, or values that are not allowed.
    Refused(Position),
    /// A group this firmware does not have, or of motors the robot does not have.
    Foreign,
}

pub fn encode(group: &ParameterGroup, config: &RobotConfig, layout: &MotorLayout) -> Record {
    let mut values = heapless::Vec::new();
    for parameter in group.parameters {
        // No group is larger than a record.
        let _ = values.push(parameter.read(config).to_bits());
    }
    Record {
        id: id(group, layout),
        version: group.version,
        values,
    }
}

/// Takes the values of the record, all of them or none. `groups` is `tuning::PARAMETERS`.
pub fn load(
    record: &Record,
    groups: &[ParameterGroup],
    layout: &MotorLayout,
    config: &mut RobotConfig,
) -> Verdict {
    let mut groups = groups.iter().enumerate();
    let Some((position, group)) = groups.find(|(_, group)| id(group, layout) == record.id) else {
        return Verdict::Foreign;
    };
    match migrate(record, group, *config) {
        Ok(loaded) => {
            *config = loaded;
            Verdict::Loaded(position)
        }
        Err(_) => Verdict::Refused(position),
    }
}

/// A later version only appends settings, so the values of an earlier one are the first of this one.
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
