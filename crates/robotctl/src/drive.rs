//! Steers the robot over the PC link: what the user's hands do becomes commands for wheels and joints.

mod driver;
mod joystick;
mod keyboard;
mod obstacle;
mod view;

pub use driver::{Driver, Gains, Limits, Wheels};
pub use joystick::{
    AxisMap, Joystick, JoystickError, JoystickEvent, JoystickMap, JoystickMapError, JoystickState,
};
pub use keyboard::{Direction, Keyboard};
pub use obstacle::Obstacle;
pub use view::RobotView;

/// What the user wants at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wish {
    /// Dead-man: without it, the wheels' targets are 0.
    pub is_held: bool,
    /// Share of the highest speed, −1…1, forward positive.
    pub forward: f64,
    /// Share of the highest rate of turn, −1…1, left positive.
    pub turn: f64,
}
