//! The whole way of a setting: from a CAN frame through the control tick into flash.

use robot_app::{
    control::UserController,
    diagnostics::DiagnosticsSnapshot,
    domain::{
        BusId, CanFrame, ImuState, LogicBus, MagState, PcCommand, RemoteUpdate, RobotConfig,
        SystemHealth,
    },
    safety::WatchdogPeriod,
    tick::{ControlInputs, ControlLoop},
    tuning::{WRITE_ID, opcode},
};

use crate::robot::{Chip, Robot};

/// One millisecond of both tasks: what the one publishes is what the other gets.
fn step(robot: &mut Robot, control: &mut ControlLoop, diagnostics: &mut DiagnosticsSnapshot) {
    let outputs = control.tick(
        &ControlInputs {
            remote: &RemoteUpdate::default(),
            imu: &ImuState::default(),
            mag: &MagState::default(),
            logic: &LogicBus::default(),
            pc: &PcCommand::default(),
            health: &SystemHealth::default(),
            params: &robot.status(),
            flash_request: robot.asked(),
            watchdog: WatchdogPeriod::Short,
        },
        robot.now_us(),
        diagnostics,
    );
    let granted = outputs.flash.granted;
    robot.take(outputs.config, &outputs.diagnostics.tuning);
    robot.step_with(granted);
}

/// The heater's target, group 7 index 0, to 30 °C = 0x41F00000; then all groups back to their defaults.
#[test]
fn a_setting_written_over_can_survives_a_reboot() {
    let chip = Chip::blank();
    let mut robot = Robot::ready(&chip);
    let mut control = ControlLoop::new(robot.config, UserController::default());
    let mut diagnostics = DiagnosticsSnapshot::default();
    for (payload, target_c) in [
        ([opcode::WRITE_PARAMETER, 7, 0, 0, 0, 0, 0xF0, 0x41], 30.0),
        (
            [opcode::RESTORE_DEFAULTS, 0, 0, 0, 0, 0, 0, 0],
            RobotConfig::default().heater.target_c,
        ),
    ] {
        let frame = CanFrame::new(WRITE_ID, payload);
        control.on_can_frame(BusId::Can1, &frame, robot.now_us(), &diagnostics);
        let saved = robot.status().save_ok;
        for _ in 0..600 {
            step(&mut robot, &mut control, &mut diagnostics);
        }
        assert_eq!(robot.status().save_ok, saved + 1);
        assert_eq!(robot.status().unsaved, 0);
        assert_eq!(Robot::boot(&chip).config.heater.target_c, target_c);
    }
}
