//! Steers the robot over the PC link: what the user's hands do becomes commands for wheels and joints, or takes the place of
//! the sticks.

mod driver;
mod joystick;
mod keyboard;
mod keys;
mod obstacle;
mod sticks;
mod view;

pub use driver::{Driver, Gains, Limits, Wheels};
pub use joystick::{
    AxisMap, Joystick, JoystickError, JoystickEvent, JoystickMap, JoystickMapError, JoystickState,
};
pub use keyboard::{Direction, Keyboard};
pub use keys::Keys;
pub use obstacle::Obstacle;
pub use sticks::SticksDriver;
pub use view::RobotView;

/// What the user wants at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Dead-man: without it, the wheels' targets are 0.
    pub is_held: bool,
    /// Share of the highest speed, −1…1, forward positive.
    pub forward: f64,
    /// Share of the highest rate of turn, −1…1, left positive.
    pub turn: f64,
    /// Lengthens the legs of a standing robot, −1…1.
    pub raise: f64,
    /// Tilts a standing robot, −1…1, right side down positive.
    pub tilt: f64,
    /// A standing robot jumps once when this becomes true.
    pub jump: bool,
}

impl Wish {
    /// The user's hands are off.
    pub const NONE: Self = Self {
        is_held: false,
        forward: 0.0,
        turn: 0.0,
        raise: 0.0,
        tilt: 0.0,
        jump: false,
    };
}
