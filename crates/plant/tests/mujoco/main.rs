//! The free robot moves as MuJoCo says.
//!
//! MuJoCo reads what `cargo xtask robot mjcf` writes. Its equations of motion, Jacobians and energies share no code and no
//! formulas with the plant's.

mod accelerations;
mod falls;
mod flight;
mod floor;
mod ground;
mod oracle;
