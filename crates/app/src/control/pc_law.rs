//! The control law of a PC's command. Latency matters, so it runs in the tick on this tick's feedback.

use crate::{
    domain::{
        ChassisCommand, JointCommand, JointMode, JointTarget, MotorFeedback, PcCommand,
        WheelCommand, WheelControllerConfig, WheelFeedback, WheelOdomConfig, WheelTarget,
    },
    math::scalar,
};

/// Actuator commands for a PC's command: the torque of a wheel follows its speed error, and the joints' motors follow
/// the MIT law. The usual limits apply to the result.
///
/// ```
/// use robot_app::control::pc_law;
/// use robot_app::domain::{MotorFeedback, PcCommand, RobotConfig, WheelTarget};
///
/// let config = RobotConfig::default();
/// let mut motor = MotorFeedback::default();
/// motor.wheels[0].age_us = 1_000;
/// let mut pc = PcCommand::default();
/// pc.wheels = [WheelTarget { speed_rps: 2.0, kp: 0.0, kd: 0.15 }; 2];
/// let command = pc_law(&pc, &motor, &config.wheel_odom, &config.wheel_ctrl);
/// // 0.15 N·m·s/rad at an error of 2 rad/s are 0.3 N·m: 1 A. The right wheel does not report.
/// let [left, right] = command.wheels.map(|wheel| wheel.current_ma);
/// assert!((left - 1_000.0).abs() < 0.1 && right == 0.0);
/// ```
pub fn pc_law(
    pc: &PcCommand,
    motor: &MotorFeedback,
    odom: &WheelOdomConfig,
    ctrl: &WheelControllerConfig,
) -> ChassisCommand {
    let [left_target, right_target] = &pc.wheels;
    let [left, right] = &motor.wheels;
    let [left_sign, right_sign] = odom.rpm_signs();
    ChassisCommand {
        wheels: [
            wheel_command(left_target, left, left_sign, odom, ctrl),
            wheel_command(right_target, right, right_sign, odom, ctrl),
        ],
        joints: pc.joints.each_ref().map(joint_command),
    }
}

/// Zero without fresh feedback, as the error is unknown. A negative or NaN damping counts as 0.
fn wheel_command(
    target: &WheelTarget,
    feedback: &WheelFeedback,
    sign: f32,
    odom: &WheelOdomConfig,
    ctrl: &WheelControllerConfig,
) -> WheelCommand {
    if feedback.age_us > ctrl.feedback_timeout_us {
        return WheelCommand::default();
    }
    let speed_rps = f32::from(feedback.rpm) * sign * odom.rps_per_rpm();
    let torque_nm = scalar::max(target.kd, 0.0) * (target.speed_rps - speed_rps);
    let limit_ma = scalar::max(ctrl.current_limit_ma, 0.0);
    let forward_ma = torque_nm * odom.ma_per_nm();
    WheelCommand {
        current_ma: sign * scalar::clamp(forward_ma, -limit_ma, limit_ma),
    }
}

const fn joint_command(target: &JointTarget) -> JointCommand {
    JointCommand {
        mode: JointMode::Mit,
        pos_rad: target.pos_rad,
        vel_rps: 0.0,
        kp: target.kp,
        kd: target.kd,
        tau_nm: 0.0,
    }
}

#[cfg(test)]
mod tests;
