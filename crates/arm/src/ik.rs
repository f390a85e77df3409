//! Joint angles that bring an arm's tool to a pose.
//!
//! [`Solver::solve`] is Levenberg–Marquardt with Chan's damping (in proportion to what is left) inside the joint limits: a joint
//! that would leave its range is held there and the others go on. When a descent ends short of the target, another one begins
//! at random joint values, always the same ones for the same [`seed`](Solver::seed). [`Solver::follow`] is for control in real time:
//! one bounded descent without a restart, and no joint further from where it is than allowed.
//!
//! [`Robot::ikine_lm`](crate::kinematics::Robot::ikine_lm) has arguments and answer of roboticstoolbox's `ikine_LM`.
//!
//! ```
//! use robot_arm::{ik::{Mask, Solver}, kinematics::create_so101_5dof};
//!
//! let robot = create_so101_5dof();
//! let target = robot.fkine(&[0.4, -0.3, 0.5, 0.2, 0.0])?;
//! let solution = Solver::default().solve(&robot, &target, &[0.0; 5], Mask::POSITION)?;
//! assert!(solution.success(), "{}", solution.reason());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bench;
mod descent;
mod error;
mod mask;
mod pose_error;
mod problem;
mod solution;
mod solver;
mod target;
mod toolbox;

pub use bench::{BenchFigures, measure};
pub use error::IkError;
pub use mask::Mask;
pub use solution::{Outcome, Remaining, Solution};
pub use solver::Solver;
pub use target::pose_of;
