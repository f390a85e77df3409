//! Writes the tick in brief.

use super::ControlLoop;
use crate::control::ChassisController;

impl<C: ChassisController> ControlLoop<C> {
    /// Writes field by field, as building the whole first would take half as many instructions again.
    #[inline(never)]
    pub(super) fn record_telemetry(&mut self, now_us: u64) {
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
        for ((rad, rps), joint) in telemetry
            .joint_rad
            .iter_mut()
            .zip(&mut telemetry.joint_rps)
            .zip(&motor.joints)
        {
            (*rad, *rps) = (joint.pos_rad, joint.vel_rps);
        }
        telemetry.flags = state.safety.flags;
        telemetry.arming = state.arming.state;
    }
}
