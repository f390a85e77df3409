//! Moves joints.

use std::{collections::BTreeMap, sync::atomic::Ordering, time::Duration};

use super::{ControllerError, ServoController, torque::Torque};
use crate::bus::register::{GOAL_POSITION, GOAL_SPEED, GOAL_TIME, Register};

impl ServoController {
    /// Sends joints to targets in steps, all at the same moment (one sync write). Targets are
    /// [limited](Self::limit_position). Joints that have lost their torque are left out. `speed` is in steps/s, and 0 is as fast as the servo can.
    pub fn fast_move_to_pose(
        &mut self,
        targets: &BTreeMap<String, i32>,
        speed: i32,
    ) -> Result<(), ControllerError> {
        let speeds = 0..=*GOAL_SPEED.range().end();
        if !speeds.contains(&speed) {
            return Err(ControllerError::Speed { speed });
        }
        let mut goals = Vec::new();
        for (name, steps) in targets {
            let steps = self.limit_position(name, *steps)?;
            let joint = self.joint(name)?;
            // No goal waits in a servo for its torque.
            if joint.torque != Torque::Lost {
                goals.push((joint.calibration.id, steps));
            }
        }
        self.begin_motion()?;
        self.send_goals(&goals, speed)
    }

    /// Sends all joints home as fast as they can. This can strike: [`soft_move_to_home`](Self::soft_move_to_home) does not.
    pub fn move_all_home(&mut self) -> Result<(), ControllerError> {
        self.fast_move_to_pose(&self.home_pose(), 0)
    }

    /// Moves all joints home over `step_count` goals, `interval` apart. Ends with [`ControllerError::Stopped`] once the
    /// [stop flag](Self::stop_flag) is set.
    pub fn soft_move_to_home(
        &mut self,
        step_count: u32,
        interval: Duration,
    ) -> Result<(), ControllerError> {
        self.soft_move_to_pose(&self.home_pose(), step_count, interval)
    }

    /// Moves joints to targets as [`soft_move_to_home`](Self::soft_move_to_home) does.
    pub fn soft_move_to_pose(
        &mut self,
        targets: &BTreeMap<String, i32>,
        step_count: u32,
        interval: Duration,
    ) -> Result<(), ControllerError> {
        if step_count == 0 {
            return Err(ControllerError::NoSteps);
        }
        let start = self.read_servo_positions()?;
        let mut next = self.bus.now();
        for number in 1..=step_count {
            if self.stop.load(Ordering::Relaxed) {
                self.hold()?;
                return Err(ControllerError::Stopped);
            }
            let part = f64::from(number) / f64::from(step_count);
            let goal = |(name, target): (&String, &i32)| {
                let from = f64::from(start.get(name).copied().unwrap_or(*target));
                let steps = from + (f64::from(*target) - from) * part;
                (name.clone(), steps.round() as i32)
            };
            let goals: BTreeMap<String, i32> = targets.iter().map(goal).collect();
            self.fast_move_to_pose(&goals, 0)?;
            next += interval;
            self.bus.wait_until(next)?;
        }
        Ok(())
    }

    pub(super) fn send_goals(
        &mut self,
        goals: &[(u8, i32)],
        speed: i32,
    ) -> Result<(), ControllerError> {
        if goals.is_empty() {
            return Ok(());
        }
        let values: Vec<(u8, [(Register, i32); 3])> = goals
            .iter()
            .map(|(id, steps)| {
                let values = [(GOAL_POSITION, *steps), (GOAL_TIME, 0), (GOAL_SPEED, speed)];
                (*id, values)
            })
            .collect();
        let values: Vec<(u8, &[(Register, i32)])> = values
            .iter()
            .map(|(id, values)| (*id, &values[..]))
            .collect();
        Ok(self.bus.sync_write(&values)?)
    }
}
