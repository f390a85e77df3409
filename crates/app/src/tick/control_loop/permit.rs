//! Decides whether anything may move in this tick, and whether flash may be written.

use super::{ControlInputs, ControlLoop};
use crate::{
    control::ChassisController,
    domain::{DriveMode, FlashRequest},
    safety::{
        ArmingInputs, ArmingState, FlashPermitInputs, MotorReadiness, PcInputs, SafetyInputs,
        TorquePermit,
    },
};

impl<C: ChassisController> ControlLoop<C> {
    pub(super) fn update_flash_permit(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        if inputs.flash_request != FlashRequest::None {
            return self.step_flash_permit(inputs, now_us);
        }
        self.flash
            .idle(self.state.arming.state, inputs.watchdog, now_us);
    }

    /// Kept out of line, as requests are rare.
    #[cold]
    #[inline(never)]
    fn step_flash_permit(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        self.flash.step(
            &FlashPermitInputs {
                request: inputs.flash_request,
                watchdog: inputs.watchdog,
                arming: self.state.arming.state,
                enabled: inputs.remote.operator.enabled,
                tests_motors: self.bring_up.tests_motors(),
                motor: &self.state.sensors.motor,
                buses: &self.motors.layout().buses(),
                can: &inputs.health.can,
            },
            now_us,
        );
    }

    /// Updates conditions for arming that may be some milliseconds old.
    #[inline(never)]
    pub(super) fn update_arming_conditions(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let (state, config) = (&mut self.state, &self.config);
        let fresh = state.link.age_us <= config.safety.remote_timeout_us;
        state.sticks_centred =
            self.centred_sticks
                .step(&inputs.remote.state, fresh, &config.safety, now_us);
        let rejects = &inputs.health.imu_status.rejects;
        state.attitude_settled = self.attitude_settling.step(rejects, now_us);
        if state.arming.state == ArmingState::Disarmed {
            state.motors = MotorReadiness::assess(&state.sensors.motor, &config.joints);
        }
    }

    pub(super) fn decide_permit(
        &mut self,
        inputs: &ControlInputs<'_>,
        bring_up_commands: bool,
        now_us: u64,
    ) -> Option<TorquePermit> {
        let stands = self.stands();
        let state = &mut self.state;
        state.safety = self.policy.evaluate(
            &SafetyInputs {
                config: &self.config.safety,
                stand_up: &self.config.stand_up,
                armed: state.arming.state == ArmingState::Armed,
                balance: state.balance.state,
                remote: &state.link,
                operator: &inputs.remote.operator,
                may_resume: state.sticks_centred || state.arming.state == ArmingState::Disarmed,
                imu_ts_us: inputs.imu.ts_us,
                estimate: &state.estimate,
                motor: &state.sensors.motor,
                motor_timeout_us: self.config.wheel_ctrl.feedback_timeout_us,
                command_ts_us: inputs.logic.ts_us,
                pc: PcInputs {
                    command: inputs.pc,
                    mode: inputs.remote.operator.mode == DriveMode::Pc && !bring_up_commands,
                    steering: inputs.logic.pc_selected && state.arming.state == ArmingState::Armed,
                    stands,
                },
                health: inputs.health,
            },
            now_us,
        );
        let (status, token) = self.arming.step(
            &ArmingInputs {
                config: &self.config.safety,
                sticks_centred: state.sticks_centred,
                attitude_settled: state.attitude_settled,
                remote_age_us: state.link.age_us,
                operator: &inputs.remote.operator,
                estimate_valid: state.estimate.valid,
                calibrated: inputs.health.imu_calibrated,
                motor: &state.motors,
                read_only: self.bring_up.blocks_arming(),
                tests_motors: self.bring_up.tests_motors(),
                flash_busy: self.flash.grant().blocks_arming,
                params: inputs.params,
                debugger_catches: inputs.health.debug_probe.catches,
                joint_timeout_unset: self.timeout_by_hand
                    && self.config.joint_ctrl.rs00_timeout_set == 0,
                safety: &state.safety,
            },
            now_us,
        );
        state.arming = status;
        token.map(|token| TorquePermit::new(token, &state.safety))
    }
}
