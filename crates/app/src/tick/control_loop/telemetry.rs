//! Writes the tick in brief.

use super::{ControlInputs, ControlLoop};
use crate::{control::ChassisController, diagnostics::Telemetry, domain::age_us};

impl<C: ChassisController> ControlLoop<C> {
    #[inline(never)]
    pub(super) fn record_telemetry(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let state = &self.state;
        let motor = &state.sensors.motor;
        let (wheels, joints) = (&motor.wheels, &motor.joints);
        let sent_joints = self.motors.sent_joints();
        self.telemetry = Telemetry {
            ts_us: now_us,
            accel_mps2: state.sensors.imu.accel_mps2,
            gyro_dps: state.sensors.imu.gyro_dps,
            q_wxyz: state.estimate.q_wxyz,
            wheel_counts: self.motors.turned_counts(),
            wheel_rpm: wheels.each_ref().map(|wheel| wheel.rpm),
            wheel_ma: wheels.each_ref().map(|wheel| wheel.current_ma),
            sent_wheel_ma: self.motors.sent_wheels_ma(),
            joint_rad: joints.each_ref().map(|joint| joint.pos_rad),
            joint_rps: joints.each_ref().map(|joint| joint.vel_rps),
            joint_nm: joints.each_ref().map(|joint| joint.torque_nm),
            sent_joint_rad: sent_joints.map(|sent| sent.pos_rad),
            sent_joint_kp: sent_joints.map(|sent| sent.kp),
            sent_joint_kd: sent_joints.map(|sent| sent.kd),
            flags: state.safety.flags,
            pc_age_us: age_us(inputs.pc.ts_us, now_us),
            arming: state.arming.state,
            mode: state.operator.mode,
            estimate_valid: state.estimate.valid,
            pc_steers: inputs.logic.pc_selected && !state.safety.pc_stop,
            joint_states: joints.each_ref().map(|joint| joint.state),
        };
    }
}
