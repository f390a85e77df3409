//! Moving the tool: a pair of keys for each axis.

use std::time::Duration;

use nalgebra::{IsometryMatrix3, Rotation3, Translation3, Vector3};

use super::key::{Action, StopKey};

/// Step sizes in m, and the angle in rad that goes with them.
const SIZES: [(f64, f64); 4] = [(0.001, 0.01), (0.002, 0.02), (0.005, 0.05), (0.01, 0.1)];
/// Steps of the gripper's servo for a key press.
const GRIPPER_STEP: i32 = 20;

/// The state of the screen.
pub struct CartesianPanel {
    target: IsometryMatrix3<f64>,
    /// Steps that the gripper is to move by.
    gripper: i32,
    size: usize,
    stop: StopKey,
    is_engaged: bool,
    /// On the way home, which any key ends.
    is_homing: bool,
    pub note: String,
}

impl CartesianPanel {
    /// Begins with the tool where it is.
    pub fn new(tool: IsometryMatrix3<f64>) -> Self {
        Self {
            target: tool,
            gripper: 0,
            size: 1,
            stop: StopKey::default(),
            is_engaged: true,
            is_homing: false,
            note: String::new(),
        }
    }

    pub fn target(&self) -> &IsometryMatrix3<f64> {
        &self.target
    }

    /// Makes the present pose the target.
    pub fn set_target(&mut self, tool: IsometryMatrix3<f64>) {
        self.target = tool;
    }

    pub fn is_engaged(&self) -> bool {
        self.is_engaged
    }

    pub fn is_homing(&self) -> bool {
        self.is_homing
    }

    /// The arm is at home.
    pub fn end_homing(&mut self) {
        self.is_homing = false;
    }

    /// Step of a key press, m and rad.
    pub fn step(&self) -> (f64, f64) {
        SIZES.get(self.size).copied().unwrap_or((0.001, 0.01))
    }

    /// Returns by how many steps the gripper is to move, once.
    pub fn take_gripper(&mut self) -> i32 {
        std::mem::take(&mut self.gripper)
    }

    pub fn press(&mut self, key: char, now: Duration) -> Action {
        self.note.clear();
        self.is_homing = false;
        match key {
            ' ' => {
                let action = self.stop.press(now);
                self.is_engaged &= action != Action::Release;
                return action;
            }
            // Also while torque is on: a joint may have lost its own.
            '\n' => {
                self.is_engaged = true;
                return Action::Engage;
            }
            '[' => self.size = self.size.saturating_sub(1),
            ']' => self.size = (self.size + 1).min(SIZES.len() - 1),
            'x' => {
                self.is_engaged = false;
                return Action::Release;
            }
            '0' if self.is_engaged => self.is_homing = true,
            '\x1b' => return Action::End,
            _ if !self.is_engaged => self.note = "no torque: Enter switches it on".to_owned(),
            _ => return self.moved(key),
        }
        Action::Nothing
    }

    fn moved(&mut self, key: char) -> Action {
        let (m, rad) = self.step();
        let shift = |axis: Vector3<f64>, by: f64| Translation3::from(axis * by);
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        match key {
            'w' => self.target = shift(x, m) * self.target,
            's' => self.target = shift(x, -m) * self.target,
            'a' => self.target = shift(y, m) * self.target,
            'd' => self.target = shift(y, -m) * self.target,
            'r' => self.target = shift(z, m) * self.target,
            'f' => self.target = shift(z, -m) * self.target,
            'i' => self.turn(y, -rad),
            'k' => self.turn(y, rad),
            'j' => self.turn(x, -rad),
            'l' => self.turn(x, rad),
            'o' => self.gripper += GRIPPER_STEP,
            'p' => self.gripper -= GRIPPER_STEP,
            _ => return Action::Nothing,
        }
        Action::Send
    }

    /// Turns the tool around an axis of the world, where it is.
    fn turn(&mut self, axis: Vector3<f64>, by_rad: f64) {
        let turn = Rotation3::new(axis * by_rad);
        self.target.rotation = turn * self.target.rotation;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_move_the_target_along_the_worlds_axes() {
        let tool = IsometryMatrix3::translation(0.2, 0.0, 0.1);
        let mut panel = CartesianPanel::new(tool);
        for key in ['w', 'a', 'r', 'i'] {
            assert_eq!(panel.press(key, Duration::ZERO), Action::Send);
        }
        let moved = panel.target().translation.vector;
        assert!(
            (moved - Vector3::new(0.202, 0.002, 0.102)).norm() < 1e-12,
            "{moved}"
        );
        assert!((panel.target().rotation.angle() - 0.02).abs() < 1e-12);
        panel.press('o', Duration::ZERO);
        assert_eq!((panel.take_gripper(), panel.take_gripper()), (20, 0));
    }

    #[test]
    fn without_torque_the_target_stays() {
        let mut panel = CartesianPanel::new(IsometryMatrix3::identity());
        panel.press('x', Duration::ZERO);
        panel.press('w', Duration::ZERO);
        panel.press('0', Duration::ZERO);
        assert_eq!(panel.target(), &IsometryMatrix3::identity());
        assert!(!panel.is_homing());
    }

    #[test]
    fn any_key_ends_the_way_home() {
        let mut panel = CartesianPanel::new(IsometryMatrix3::identity());
        panel.press('0', Duration::ZERO);
        assert!(panel.is_homing());
        assert_eq!(panel.press(' ', Duration::ZERO), Action::Hold);
        assert!(!panel.is_homing());
    }
}
