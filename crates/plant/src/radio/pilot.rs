//! Sticks and switches in the pilot's hands.

/// A change of sticks and switches. An unset field keeps its value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RemoteInput {
    /// Enable switch.
    pub enable: Option<bool>,
    /// Emergency stop.
    pub e_stop: Option<bool>,
    /// Drive stick, −1 … 1, forward positive.
    pub vx: Option<f64>,
    /// Steering stick, −1 … 1, left turn (counter-clockwise from above) positive.
    pub wz: Option<f64>,
    /// Three-position switch: 0, 1, 2.
    pub mode: Option<u8>,
    /// Left stick, −1 … 1, right positive.
    pub left_x: Option<f64>,
    /// Left stick, −1 … 1, up positive.
    pub left_y: Option<f64>,
    /// Stand switch: up asks the robot to stand up and balance.
    pub stand: Option<bool>,
    /// Body height, −1 … 1, tall positive.
    pub height: Option<f64>,
    /// Roll of the body, −1 … 1, right side down positive.
    pub roll: Option<f64>,
    /// Jump button.
    pub jump: Option<bool>,
}

/// Sticks in −1 … 1, switches as set. Starts disabled, centred, mode 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pilot {
    pub enable: bool,
    pub e_stop: bool,
    /// Forward positive.
    pub vx: f64,
    /// Left turn positive.
    pub wz: f64,
    /// Left stick, right positive.
    pub left_x: f64,
    /// Left stick, up positive.
    pub left_y: f64,
    /// 0, 1 or 2.
    pub mode: u8,
    pub stand: bool,
    /// Tall positive.
    pub height: f64,
    /// Right side down positive.
    pub roll: f64,
    pub jump: bool,
}

impl Pilot {
    pub(crate) fn apply(&mut self, input: RemoteInput) {
        self.enable = input.enable.unwrap_or(self.enable);
        self.e_stop = input.e_stop.unwrap_or(self.e_stop);
        self.vx = input.vx.unwrap_or(self.vx).clamp(-1.0, 1.0);
        self.wz = input.wz.unwrap_or(self.wz).clamp(-1.0, 1.0);
        self.left_x = input.left_x.unwrap_or(self.left_x).clamp(-1.0, 1.0);
        self.left_y = input.left_y.unwrap_or(self.left_y).clamp(-1.0, 1.0);
        self.mode = input.mode.unwrap_or(self.mode).min(2);
        self.stand = input.stand.unwrap_or(self.stand);
        self.height = input.height.unwrap_or(self.height).clamp(-1.0, 1.0);
        self.roll = input.roll.unwrap_or(self.roll).clamp(-1.0, 1.0);
        self.jump = input.jump.unwrap_or(self.jump);
    }
}
