//! Which robot the image is for, under a stable symbol: a simulation must not put it into another one.

use robot_app::domain::{RobotIdentity, robots};

/// `g_robotapp_robot`. No program on the chip reads it, so the linker is told to keep it (`build.rs`).
#[used]
// SAFETY: no other symbol of the image has this name.
#[unsafe(no_mangle)]
static g_robotapp_robot: RobotIdentity = RobotIdentity::of(&robots::CHOSEN);
