//! All faults that a scenario can start and end: those of the world and those of the machine.

use robot_plant::world::{FaultInfo, World, WorldError};

use crate::machine::{
    Machine,
    faults::{self, FaultError},
};

/// An event that cannot be applied.
#[derive(Debug, thiserror::Error)]
pub enum EventError {
    #[error(transparent)]
    World(#[from] WorldError),
    #[error(transparent)]
    Machine(#[from] FaultError),
    #[error("the PC's CAN adapter has too many frames waiting; send fewer at a time")]
    AdapterFull,
}

pub fn all() -> impl Iterator<Item = &'static FaultInfo> {
    World::faults().iter().chain(faults::all())
}

/// Starts or ends a fault by its name.
pub fn set(machine: &mut Machine, name: &str, active: bool) -> Result<(), EventError> {
    if faults::all().any(|fault| fault.name == name) {
        machine.set_fault(name, active)?;
    } else {
        machine.with_world(|world| world.set_fault(name, active))?;
    }
    Ok(())
}
