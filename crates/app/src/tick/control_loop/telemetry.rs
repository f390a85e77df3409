//! Writes the tick in brief.

use super::{ControlInputs, ControlLoop};
use crate::{control::ChassisController, domain::age_us};

impl<C: ChassisController> ControlLoop<C> {
    /// Writes field by field, as building the whole first would take half as many instructions again.
    #[inline(never)]
    pub(super) fn record_telemetry(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let Self {
            telemetry,
            state,
            motors,
            ..
        } = self;
        let motor = &state.sensors.motor;
        telemetry.ts_us = now_us;
        telemetry.accel_mps2 = state.sensors.imu.accel_mps2;
        telemetry.gyro_dps = state.sensors.imu.gyro_dps;
        telemetry.q_wxyz = state.estimate.q_wxyz;
        telemetry.wheel_counts = motors.turned_counts();
        let [left, right] = &motor.wheels;
        telemetry.wheel_rpm = [left.rpm, right.rpm];
        telemetry.wheel_ma = [left.current_ma, right.current_ma];
        telemetry.sent_wheel_ma = motors.sent_wheels_ma();
        let sent_joints = motors.sent_joints();
        for (joint, (feedback, sent)) in motor.joints.iter().zip(sent_joints).enumerate() {
            for (values, value) in [
                (&mut telemetry.joint_rad, feedback.pos_rad),
                (&mut telemetry.joint_rps, feedback.vel_rps),
                (&mut telemetry.joint_nm, feedback.torque_nm),
                (&mut telemetry.sent_joint_rad, sent.pos_rad),
                (&mut telemetry.sent_joint_kp, sent.kp),
                (&mut telemetry.sent_joint_kd, sent.kd),
            ] {
                if let Some(place) = values.get_mut(joint) {
                    *place = value;
                }
            }
            if let Some(place) = telemetry.joint_states.get_mut(joint) {
                *place = feedback.state;
            }
        }
        telemetry.flags = state.safety.flags;
        telemetry.pc_age_us = age_us(inputs.pc.ts_us, now_us);
        telemetry.arming = state.arming.state;
        telemetry.mode = state.operator.mode;
        telemetry.estimate_valid = state.estimate.valid;
        telemetry.pc_steers = inputs.logic.pc_selected && !state.safety.pc_stop;
    }
}
