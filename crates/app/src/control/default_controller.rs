//! Proportional control of each wheel's speed. The joints hold their pose.

use super::{
    ChassisController, ChassisControllerInput, ChassisControllerOutput, pose_hold::PoseHold,
};
use crate::{
    domain::{
        BalanceStatus, ChassisCommand, HighLevelCommand, WheelCommand, WheelControllerConfig,
        WheelFeedback, WheelOdomConfig,
    },
    math::scalar,
};

/// The controller that the image ships with.
///
/// ```
/// use robot_app::control::{ChassisController, ChassisControllerInput, DefaultController};
/// use robot_app::domain::{HighLevelCommand, OperatorState, RobotConfig, SensorsSnapshot, StandPermit};
/// use robot_app::domain::{StateEstimate, robots};
///
/// let config = RobotConfig::default();
/// let output = DefaultController::default().step(&ChassisControllerInput {
///     sensors: &SensorsSnapshot::default(),
///     estimate: &StateEstimate::default(),
///     wheel_odom_cfg: &config.wheel_odom,
///     wheel_ctrl_cfg: &config.wheel_ctrl,
///     joint_ctrl_cfg: &config.joint_ctrl,
///     profile: &robots::FIVEBAR,
///     operator_state: &OperatorState::default(),
///     hl_cmd: HighLevelCommand { vx: 0.05, ..Default::default() },
///     stand: StandPermit::Ready,
///     wheels_stopped: false,
///     joints_stopped: false,
/// });
/// let [left, right] = output.cmd.wheels.map(|wheel| wheel.current_ma);
/// // The right motor sits mirrored.
/// assert!(output.cmd_valid && left > 0.0 && right < 0.0);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct DefaultController {
    pose: PoseHold,
}

impl ChassisController for DefaultController {
    fn step(&mut self, input: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        let (odom, ctrl) = (input.wheel_odom_cfg, input.wheel_ctrl_cfg);
        let [left_mps, right_mps] = wheel_targets_mps(input.hl_cmd, odom, ctrl);
        let motor = &input.sensors.motor;
        let [left, right] = &motor.wheels;
        let [left_sign, right_sign] = odom.rpm_signs();
        let rpm_to_mps = odom.mps_per_rpm();
        let wheels = [
            wheel_command(left_mps, left, left_sign, rpm_to_mps, ctrl),
            wheel_command(right_mps, right, right_sign, rpm_to_mps, ctrl),
        ];
        ChassisControllerOutput {
            cmd: ChassisCommand {
                wheels,
                joints: self.pose.step(&motor.joints, input.joint_ctrl_cfg),
            },
            cmd_valid: true,
            balance: BalanceStatus::SIT,
        }
    }

    fn reset(&mut self) {
        self.pose = PoseHold::default();
    }
}

/// Ground speeds in m/s of the left and right wheel for the commanded drive and turn.
fn wheel_targets_mps(
    hl_cmd: HighLevelCommand,
    odom: &WheelOdomConfig,
    ctrl: &WheelControllerConfig,
) -> [f32; 2] {
    let drive_mps = hl_cmd.vx.clamp(-1.0, 1.0) * ctrl.max_vx_mps;
    let turn_rps = hl_cmd.wz.clamp(-1.0, 1.0) * ctrl.max_wz_rps;
    let difference_mps = turn_rps * odom.wheel_track_m / 2.0;
    [drive_mps - difference_mps, drive_mps + difference_mps]
}

fn wheel_command(
    target_mps: f32,
    feedback: &WheelFeedback,
    sign: f32,
    rpm_to_mps: f32,
    ctrl: &WheelControllerConfig,
) -> WheelCommand {
    let forward_ma = if feedback.age_us <= ctrl.feedback_timeout_us {
        let measured_mps = f32::from(feedback.rpm) * sign * rpm_to_mps;
        ctrl.kp_ma_per_mps * (target_mps - measured_mps)
    } else {
        ctrl.open_loop_ma_per_mps * target_mps
    };
    let limit_ma = scalar::max(ctrl.current_limit_ma, 0.0);
    WheelCommand {
        current_ma: sign * scalar::clamp(forward_ma, -limit_ma, limit_ma),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{
        JointControllerConfig, JointState, OperatorState, SensorsSnapshot, StandPermit,
        StateEstimate, robots,
    };

    fn command(
        controller: &mut DefaultController,
        sensors: &SensorsSnapshot,
        hl_cmd: HighLevelCommand,
    ) -> ChassisCommand {
        let output = controller.step(&ChassisControllerInput {
            sensors,
            estimate: &StateEstimate::default(),
            wheel_odom_cfg: &WheelOdomConfig::default(),
            wheel_ctrl_cfg: &WheelControllerConfig::default(),
            joint_ctrl_cfg: &JointControllerConfig::default(),
            profile: &robots::FIVEBAR,
            operator_state: &OperatorState::default(),
            hl_cmd,
            stand: StandPermit::Ready,
            wheels_stopped: false,
            joints_stopped: false,
        });
        assert!(output.cmd_valid);
        output.cmd
    }

    fn drive(vx: f32, wz: f32) -> HighLevelCommand {
        HighLevelCommand {
            vx,
            wz,
            ..HighLevelCommand::default()
        }
    }

    fn step(hl_cmd: HighLevelCommand, rpm: [i16; 2], age_us: u32) -> [f32; 2] {
        let mut sensors = SensorsSnapshot::default();
        for (wheel, rpm) in sensors.motor.wheels.iter_mut().zip(rpm) {
            wheel.rpm = rpm;
            wheel.age_us = age_us;
        }
        let command = command(&mut DefaultController::default(), &sensors, hl_cmd);
        command.wheels.map(|wheel| wheel.current_ma)
    }

    #[test]
    fn each_drive_holds_the_pose_it_started_with() {
        let mut controller = DefaultController::default();
        let mut held_rad = |reset: bool, is_rad: f32| {
            let mut sensors = SensorsSnapshot::default();
            for joint in &mut sensors.motor.joints {
                joint.state = JointState::Enabled;
                joint.pos_rad = is_rad;
            }
            if reset {
                controller.reset();
            }
            let command = command(&mut controller, &sensors, HighLevelCommand::default());
            command.joints.map(|joint| joint.pos_rad)
        };
        assert_eq!(held_rad(false, 0.25), [0.25; 4]);
        assert_eq!(held_rad(false, -0.5), [0.25; 4]);
        assert_eq!(held_rad(true, -0.5), [-0.5; 4]);
    }

    /// 0.05 · 1.5 m/s = 0.075 m/s, times 60 A per m/s = 4.5 A. The right motor sits mirrored.
    #[test]
    fn driving_forward_pushes_both_wheels_forward() {
        let [left, right] = step(drive(0.05, 0.0), [0, 0], 0);
        assert!((left - 4_500.0).abs() < 0.5 && (right + 4_500.0).abs() < 0.5);
    }

    /// 0.05 · 4 rad/s · 0.21 m = 0.042 m/s, times 60 A per m/s = 2.52 A, backward on the left and forward on the
    /// right.
    #[test]
    fn a_left_turn_drives_the_right_wheel_forward() {
        let [left, right] = step(drive(0.0, 0.05), [0, 0], 0);
        assert!((left + 2_520.0).abs() < 0.5 && (right + 2_520.0).abs() < 0.5);
    }

    /// A wheel of 0.075 m radius at 0.6 m/s turns at 8 rad/s, which is 76.39 rpm, or 1467.0 rpm at the rotor.
    #[test]
    fn at_the_target_speed_the_current_is_close_to_zero() {
        let [left, right] = step(drive(0.4, 0.0), [1467, -1467], 0);
        assert!(left.abs() < 20.0 && right.abs() < 20.0, "{left} {right}");
    }

    #[test]
    fn the_current_at_full_stick_from_standstill_is_limited() {
        let [left, right] = step(drive(1.0, 0.0), [0, 0], 0);
        assert_eq!((left, right), (8_000.0, -8_000.0));
    }

    #[test]
    fn without_feedback_the_current_is_proportional_to_the_stick() {
        let [left, right] = step(drive(1.0, 0.0), [3000, 0], 50_001);
        assert_eq!((left, right), (1_500.0, -1_500.0));
    }
}
