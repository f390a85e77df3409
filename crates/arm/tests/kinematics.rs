//! Poses and Jacobians, compared with roboticstoolbox and yourdfpy; what a description may not be.

#[path = "kinematics/arms.rs"]
mod arms;
#[path = "kinematics/refusals.rs"]
mod refusals;
#[path = "kinematics/roboticstoolbox.rs"]
mod roboticstoolbox;
#[path = "kinematics/servo_steps.rs"]
mod servo_steps;
#[path = "kinematics/so101.rs"]
mod so101;
