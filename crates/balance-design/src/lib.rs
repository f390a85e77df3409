//! Gains of the balance controller, computed from a robot's file.
//!
//! The robot about standing still is a linear system ([`LinearModel`]); the discrete Riccati equation gives the gains for
//! torques that come late ([`Regulator`]); over both leg lengths they become quadratic functions ([`Schedule`]).
//! docs/balance.md derives all of it.

#![deny(missing_docs)]

mod discrete;
mod dynamics;
mod leg;
mod margins;
mod model;
mod regulator;
mod response;
mod riccati;
mod schedule;
mod stability;

pub use discrete::DiscreteModel;
pub use margins::{Margins, extra_delay_ticks, margins};
pub use model::{Equilibrium, GainMatrix, INPUTS, InputMatrix, LinearModel, STATES, StateMatrix};
pub use regulator::{Regulator, delay_ticks};
pub use response::{Event, Sample, response};
pub use schedule::{COEFFICIENTS, Schedule, lengths_m};
pub use stability::poles;

/// Why there are no gains for a robot.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DesignError {
    /// The links are too short or too long for a length of the leg's range.
    #[error("the links do not reach a leg length of {left_m:.3} m left and {right_m:.3} m right")]
    Reach {
        /// Length of the left leg, m.
        left_m: f64,
        /// Length of the right leg, m.
        right_m: f64,
    },
    /// Masses and inertias leave a motion without inertia.
    #[error("masses and inertias do not describe a robot: a motion has no inertia")]
    Mass,
    /// The centre of mass is so far off that no lean puts it above the axles.
    #[error("no lean of the legs puts the centre of mass above the axles: see body.com_m")]
    Equilibrium,
    /// Some state that the inputs cannot reach, or that costs nothing, keeps the cost from settling.
    #[error(
        "control.weights give no gains at {left_m:.3} m left and {right_m:.3} m right: each weight in r must be positive, and s and yaw need one in q"
    )]
    Cost {
        /// Length of the left leg, m.
        left_m: f64,
        /// Length of the right leg, m.
        right_m: f64,
    },
    /// The loop with the fitted gains does not hold.
    #[error(
        "the loop is unstable at {left_m:.3} m left and {right_m:.3} m right with a delay of {delay_ms} ms: lower control.weights.q or raise control.weights.r"
    )]
    Unstable {
        /// Length of the left leg, m.
        left_m: f64,
        /// Length of the right leg, m.
        right_m: f64,
        /// Delay in ms, the file's or a longer one.
        delay_ms: usize,
    },
}
