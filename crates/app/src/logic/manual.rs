//! Manual driving: sticks → high-level command.

use super::jump_request::JumpRequest;
use crate::{
    domain::{HighLevelCommand, RemoteUpdate, StandSwitch},
    math::scalar,
};

/// Longest time between two rounds that counts.
const MAX_DT_US: u64 = 20_000;
/// Height and roll take this long from their middle to an end, in s.
const TRAVEL_S: f32 = 0.5;

/// Maps sticks and switches to the drive command. Height and roll begin in the middle and follow slowly.
#[derive(Clone, Debug, Default)]
pub(super) struct ManualDrive {
    height: f32,
    roll: f32,
    jump: JumpRequest,
    ts_us: u64,
}

impl ManualDrive {
    /// Returns the command of this round. `stick_centre` is the limit up to which `Arming` takes a stick for centred, so
    /// a stick that permits arming moves nothing.
    pub fn step(
        &mut self,
        remote: &RemoteUpdate,
        stick_centre: f32,
        now_us: u64,
    ) -> HighLevelCommand {
        let last_us = core::mem::replace(&mut self.ts_us, now_us);
        let dt_us = now_us.saturating_sub(last_us).min(MAX_DT_US);
        let step = dt_us as f32 * (1e-6 / TRAVEL_S);
        let (sticks, operator) = (&remote.state, &remote.operator);
        let stick = |stick| outside_dead_band(stick, stick_centre);
        self.height = approach(self.height, stick(sticks.height), step);
        self.roll = approach(self.roll, stick(sticks.roll), step);
        HighLevelCommand {
            vx: stick(sticks.vx),
            wz: stick(sticks.wz),
            height: self.height,
            roll: self.roll,
            jump: self.jump.step(operator.jump, now_us),
            stand: operator.stand == StandSwitch::Up,
        }
    }
}

/// Moves `value` towards `target` by no more than `step`.
fn approach(value: f32, target: f32, step: f32) -> f32 {
    value + scalar::clamp(target - value, -step, step)
}

/// Removes the dead band. The output starts from 0 at `dead_band` and rises twice as steeply as the stick until it
/// meets it, so full stick stays full. NaN gives 0.
fn outside_dead_band(stick: f32, dead_band: f32) -> f32 {
    let beyond = stick.abs() - dead_band;
    if beyond <= 0.0 || beyond.is_nan() {
        0.0
    } else {
        scalar::min(2.0 * beyond, stick.abs()).copysign(stick)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vx(stick: f32, stick_centre: f32) -> f32 {
        let mut remote = RemoteUpdate::default();
        (remote.state.vx, remote.state.wz) = (stick, -stick);
        let command = ManualDrive::default().step(&remote, stick_centre, 1_000_000);
        assert_eq!(command.wz, -command.vx);
        command.vx
    }

    /// 2 % of the travel in 10 ms.
    #[test]
    fn height_and_roll_follow_slowly() {
        let mut drive = ManualDrive::default();
        let mut remote = RemoteUpdate::default();
        (remote.state.height, remote.state.roll) = (1.0, -0.04);
        let mut last = drive.step(&remote, 0.05, 1_000_000);
        for round in 1..=100 {
            let command = drive.step(&remote, 0.05, 1_000_000 + round * 10_000);
            assert!((0.0..=0.020_001).contains(&(command.height - last.height)));
            assert_eq!(command.roll, 0.0);
            last = command;
        }
        assert_eq!(last.height, 1.0);
        // A pause counts as 20 ms.
        (remote.state.height, remote.state.roll) = (f32::NAN, 1.0);
        let command = drive.step(&remote, 0.05, 9_000_000);
        assert!((command.height - 0.96).abs() < 1e-6 && (command.roll - 0.04).abs() < 1e-6);
    }

    #[test]
    fn only_a_switch_that_is_up_asks_for_standing() {
        for (switch, stands) in [
            (StandSwitch::Unknown, false),
            (StandSwitch::Down, false),
            (StandSwitch::Up, true),
        ] {
            let mut remote = RemoteUpdate::default();
            remote.operator.stand = switch;
            let command = ManualDrive::default().step(&remote, 0.05, 1_000_000);
            assert_eq!(command.stand, stands);
        }
    }

    #[test]
    fn a_stick_that_is_centred_for_arming_moves_nothing() {
        for limit in [0.01, 0.05, 0.3] {
            assert_eq!(vx(limit, limit), 0.0);
            assert_eq!(vx(-limit, limit), 0.0);
        }
        assert_eq!(vx(f32::NAN, 0.05), 0.0);
    }

    #[test]
    fn beyond_the_dead_band_the_command_rises_from_zero_to_full() {
        for limit in [0.01, 0.05, 0.3] {
            assert!((vx(limit + 0.001, limit) - 0.002).abs() < 1e-6);
            assert!((vx(-limit - 0.001, limit) + 0.002).abs() < 1e-6);
            let mut last = 0.0;
            for step in 0..=1_000u16 {
                let now = vx(f32::from(step) * 1e-3, limit);
                assert!((0.0..=0.002_01).contains(&(now - last)), "{step}");
                last = now;
            }
            assert_eq!(last, 1.0);
        }
        assert_eq!(vx(0.4, 0.05), 0.4);
        assert_eq!(vx(-0.4, 0.05), -0.4);
    }
}
