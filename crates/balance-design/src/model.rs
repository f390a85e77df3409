//! The robot about standing still, as a linear system.

use nalgebra::SMatrix;
use robot_description::Robot;

use crate::{
    DesignError,
    dynamics::{Dynamics, Pose, ROLLING, Square, Vector},
};

/// Number of states: s, ṡ, ψ, ψ̇, θ left and its rate, θ right and its rate, φ, φ̇; m and rad.
pub const STATES: usize = 10;
/// Number of inputs: torque on the left and the right wheel, of the body on the left and the right leg; N·m.
pub const INPUTS: usize = 4;

/// A matrix over the states.
pub type StateMatrix = SMatrix<f64, STATES, STATES>;
/// What inputs do to states.
pub type InputMatrix = SMatrix<f64, STATES, INPUTS>;
/// Gains: inputs over states.
pub type GainMatrix = SMatrix<f64, INPUTS, STATES>;

/// How the robot stands still with a level body: what its centre of mass asks for.
#[derive(Clone, Copy, Debug)]
pub struct Equilibrium {
    /// Lean of both legs, rad.
    pub lean_rad: f64,
    /// Torque of the body on the left and the right leg, N·m; positive leans the leg forward.
    pub leg_torque_nm: [f64; 2],
}

/// `ẋ = a x + b u` about standing still.
#[derive(Clone, Debug)]
pub struct LinearModel {
    /// Rates of the states over the states, 1/s.
    pub a: StateMatrix,
    /// Rates of the states over the inputs.
    pub b: InputMatrix,
    /// What the states and inputs are counted from.
    pub equilibrium: Equilibrium,
}

impl LinearModel {
    /// Linearises the robot at these lengths of the left and the right leg, in m.
    ///
    /// # Errors
    /// [`DesignError::Reach`] where the links do not reach so far.
    pub fn new(robot: &Robot, length_m: [f64; 2]) -> Result<Self, DesignError> {
        let equilibrium = Equilibrium::new(robot, length_m)?;
        let dynamics = at_rest(robot, length_m, equilibrium.lean_rad)?;
        let rolling = dynamics.rolling();
        let project = |m: &Square| rolling.transpose() * m * rolling;
        let mass = project(&dynamics.mass);
        let inverse = mass.try_inverse().ok_or(DesignError::Mass)?;
        let by_place = -(inverse * project(&dynamics.stiffness));
        let by_input = inverse * rolling.transpose() * dynamics.inputs;

        let mut a = StateMatrix::zeros();
        let mut b = InputMatrix::zeros();
        for i in 0..ROLLING {
            a[(2 * i, 2 * i + 1)] = 1.0;
            for j in 0..ROLLING {
                a[(2 * i + 1, 2 * j)] = by_place[(i, j)];
            }
            for j in 0..INPUTS {
                b[(2 * i + 1, j)] = by_input[(i, j)];
            }
        }
        Ok(Self { a, b, equilibrium })
    }
}

impl Equilibrium {
    /// Finds the lean at which the centre of mass is above the axles.
    fn new(robot: &Robot, length_m: [f64; 2]) -> Result<Self, DesignError> {
        let mut lean_rad = 0.0;
        for _ in 0..20 {
            let dynamics = at_rest(robot, length_m, lean_rad)?;
            // Moving both legs and the body as one changes no angle at the hips.
            let moment_nm = dynamics.slope.rows(2, 3).sum();
            let stiffness = &dynamics.stiffness;
            let change = stiffness.view((2, 2), (3, 2)).sum();
            let step = moment_nm / change;
            lean_rad -= step;
            if step.abs() < 1e-13 {
                let slope = &dynamics.slope;
                return Ok(Self {
                    lean_rad,
                    leg_torque_nm: [slope[2], slope[3]],
                });
            }
        }
        Err(DesignError::Equilibrium)
    }
}

fn at_rest(robot: &Robot, length_m: [f64; 2], lean_rad: f64) -> Result<Dynamics, DesignError> {
    let pose = Pose {
        length_m,
        lean_rad: [lean_rad; 2],
        pitch_rad: 0.0,
    };
    Dynamics::new(robot, &pose, &Vector::zeros()).ok_or(DesignError::Reach {
        left_m: length_m[0],
        right_m: length_m[1],
    })
}
