//! Balancing on two wheels.

mod braking;
mod catch;
mod contact;
mod controller;
mod edge;
mod friction;
mod gains;
mod jump;
mod knees;
mod law;
mod measured;
mod one_wheel;
mod ramp;
mod reference;
mod sit_down;
mod slip;
mod stand_up;
mod stop;
mod support;
mod tilt;
mod tip;
mod torques;
mod trim;
mod upright;
mod virtual_leg;

pub use controller::BalanceController;
pub use gains::Gains;
pub use virtual_leg::{LegForce, force_of, hip_torques_nm, reaction_nm};
