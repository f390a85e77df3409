use super::*;
use crate::domain::{
    ChassisCommand, HighLevelCommand, OperatorState, RemoteDiagnostics, RemoteState, RemoteUpdate,
    SafetyConfig, SensorsSnapshot, StateEstimate,
};

const NOW_US: u64 = 1_010_000;

fn remote(mode: DriveMode) -> RemoteUpdate {
    RemoteUpdate {
        state: RemoteState {
            vx: 0.5,
            wz: -0.25,
            ..RemoteState::default()
        },
        operator: OperatorState {
            enabled: true,
            e_stop: false,
            mode,
            ..OperatorState::default()
        },
        diagnostics: RemoteDiagnostics {
            good_ts_us: 1_000_000,
            ..RemoteDiagnostics::default()
        },
        ..RemoteUpdate::default()
    }
}

/// Requests its number of steps since the last reset as a current, and from the third step on a drive command.
#[derive(Default)]
struct Counting(u8);

impl CustomLogic for Counting {
    fn step(&mut self, inputs: &LogicInputs<'_>, _: u64) -> LogicDecision {
        self.0 += 1;
        if self.0 > 2 {
            let vx = inputs.battery_v;
            return LogicDecision::Drive(HighLevelCommand {
                vx,
                ..HighLevelCommand::default()
            });
        }
        let mut command = ChassisCommand::default();
        command.wheels[0].current_ma = f32::from(self.0);
        LogicDecision::Direct(command)
    }

    fn reset(&mut self) {
        self.0 = 0;
    }
}

fn step<L: CustomLogic>(stage: &mut LogicStage<L>, remote: &RemoteUpdate, now_us: u64) -> LogicBus {
    let inputs = LogicInputs {
        config: &SafetyConfig::default(),
        remote,
        sensors: &SensorsSnapshot::default(),
        estimate: &StateEstimate::default(),
        armed: true,
        battery_v: 0.75,
    };
    stage.step(&inputs, now_us)
}

#[test]
fn sticks_reach_the_high_level_command_in_manual_mode() {
    let mut stage = LogicStage::new(UserLogic);
    let bus = step(&mut stage, &remote(DriveMode::Manual), NOW_US);
    assert!(bus.hl_valid && !bus.cmd_valid);
    assert_eq!((bus.hl_cmd.vx, bus.hl_cmd.wz), (0.5, -0.25));
    assert_eq!(bus.ts_us, NOW_US);
}

#[test]
fn only_pc_mode_selects_the_pc() {
    let mut stage = LogicStage::new(UserLogic);
    for (mode, selected) in [
        (DriveMode::Manual, false),
        (DriveMode::Pc, true),
        (DriveMode::Custom, false),
    ] {
        let bus = step(&mut stage, &remote(mode), NOW_US);
        assert_eq!(bus.pc_selected, selected, "{mode:?}");
        assert!(!(bus.pc_selected && (bus.hl_valid || bus.cmd_valid)));
    }
}

#[test]
fn custom_logic_decides_in_custom_mode_and_restarts_each_time() {
    let mut stage = LogicStage::new(Counting::default());
    let mut current_ma = |mode| {
        let bus = step(&mut stage, &remote(mode), NOW_US);
        let wins = if bus.cmd_valid {
            bus.cmd.wheels[0].current_ma
        } else {
            bus.hl_cmd.vx
        };
        (bus.cmd_valid, bus.hl_valid, wins)
    };
    assert_eq!(current_ma(DriveMode::Custom), (true, false, 1.0));
    assert_eq!(current_ma(DriveMode::Custom), (true, false, 2.0));
    assert_eq!(current_ma(DriveMode::Custom), (false, true, 0.75));
    assert_eq!(current_ma(DriveMode::Manual), (false, true, 0.5));
    assert_eq!(current_ma(DriveMode::Custom), (true, false, 1.0));
}

#[test]
fn custom_logic_restarts_when_the_pilot_enables_again() {
    let mut stage = LogicStage::new(Counting::default());
    let mut current_ma = |enabled| {
        let mut remote = remote(DriveMode::Custom);
        remote.operator.enabled = enabled;
        let bus = step(&mut stage, &remote, NOW_US);
        bus.cmd_valid.then_some(bus.cmd.wheels[0].current_ma)
    };
    let currents = [true, true, false, true].map(&mut current_ma);
    assert_eq!(currents, [Some(1.0), Some(2.0), None, Some(1.0)]);
}

#[test]
fn the_shipped_user_logic_gives_no_command() {
    let bus = step(
        &mut LogicStage::new(UserLogic),
        &remote(DriveMode::Custom),
        NOW_US,
    );
    assert!(!bus.cmd_valid && !bus.hl_valid);
}

#[test]
fn every_reason_to_stop_invalidates_all_commands() {
    type Fault = fn(&mut RemoteUpdate);
    let faults: [Fault; 5] = [
        |remote| remote.diagnostics.good_ts_us = NOW_US - 100_001,
        |remote| remote.diagnostics.good_ts_us = 0,
        |remote| remote.diagnostics.failsafe = true,
        |remote| remote.operator.enabled = false,
        |remote| remote.operator.e_stop = true,
    ];
    for mode in [DriveMode::Manual, DriveMode::Pc, DriveMode::Custom] {
        for inject in faults {
            let mut remote = remote(mode);
            let mut stage = LogicStage::new(Counting::default());
            let before = step(&mut stage, &remote, NOW_US);
            assert!(before.cmd_valid || before.hl_valid || before.pc_selected);
            inject(&mut remote);
            let bus = step(&mut stage, &remote, NOW_US);
            let zero = LogicBus {
                ts_us: NOW_US,
                ..LogicBus::default()
            };
            assert_eq!(bus, zero, "{mode:?}");
        }
    }
}
