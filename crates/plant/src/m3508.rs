//! One wheel drive: M3508 geared motor with its C620 controller on CAN (docs/hardware.md#c620-and-m3508).

mod c620;
mod motor;

pub(crate) use c620::{C620, EscFaults};
pub(crate) use motor::Friction;
#[cfg(test)]
pub(crate) use motor::M3508;
