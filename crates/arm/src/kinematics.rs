//! Where an arm's tool is for given joint angles, and how it moves with them.
//!
//! A [`Robot`] is a serial chain of joints. It comes from [`create_so101_5dof`], from [elementary transforms]
//! (`ElementaryTransform`), from [Denavit–Hartenberg rows](DhRow), or [from a URDF](Robot::from_urdf). Frames are right-handed,
//! lengths in m, angles in rad. A pose is that of the tool in the world: `world ← base ← joints ← tool`.
//!
//! ```
//! let robot = robot_arm::kinematics::create_so101_5dof();
//! let pose = robot.fkine(&[0.0; 5])?;
//! assert!((pose.translation.z - 0.2265).abs() < 1e-4);
//! # Ok::<(), robot_arm::kinematics::KinematicsError>(())
//! ```

mod chain;
mod denavit_hartenberg;
mod elementary;
mod error;
mod joint;
mod robot;
mod servo_steps;
mod so101;
mod urdf;

pub(crate) use chain::{Chain, Frame};
pub use denavit_hartenberg::{DhConvention, DhRow};
pub use elementary::ElementaryTransform;
pub use error::KinematicsError;
pub use joint::{Gear, Joint, JointKind};
pub(crate) use robot::finite;
pub use robot::{MAX_JOINTS, Robot};
pub use servo_steps::STEPS_PER_TURN;
pub use so101::create_so101_5dof;
