use super::*;
use crate::{
    domain::{
        ChassisCommand, HighLevelCommand, OperatorState, RemoteDiagnostics, RemoteState,
        RemoteUpdate, SafetyConfig, SensorsSnapshot, StateEstimate,
    },
    logic::PcCommand,
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
            return LogicDecision::Drive(HighLevelCommand { vx, wz: 0.0 });
        }
        let mut command = ChassisCommand::default();
        command.wheels[0].current_ma = f32::from(self.0);
        LogicDecision::Direct(command)
    }

    fn reset(&mut self) {
        self.0 = 0;
    }
}

fn step<L: CustomLogic>(
    stage: &mut LogicStage<L>,
    remote: &RemoteUpdate,
    pc: Option<&PcCommand>,
    now_us: u64,
) -> LogicBus {
    let inputs = LogicInputs {
        config: &SafetyConfig::default(),
        remote,
        pc,
        sensors: &SensorsSnapshot::default(),
        estimate: &StateEstimate::default(),
        armed: true,
        battery_v: 0.75,
    };
    stage.step(&inputs, now_us)
}

fn pc_command(ts_us: u64) -> PcCommand {
    PcCommand {
        command: HighLevelCommand { vx: 0.1, wz: 0.2 },
        ts_us,
    }
}

#[test]
fn sticks_reach_the_high_level_command_in_manual_mode() {
    let mut stage = LogicStage::new(UserLogic);
    let bus = step(&mut stage, &remote(DriveMode::Manual), None, NOW_US);
    assert!(bus.hl_valid && !bus.cmd_valid);
    assert_eq!((bus.hl_cmd.vx, bus.hl_cmd.wz), (0.5, -0.25));
    assert_eq!(bus.ts_us, NOW_US);
}

#[test]
fn in_pc_mode_the_pc_steers_while_its_command_is_fresh() {
    let mut stage = LogicStage::new(UserLogic);
    let mut in_mode = |mode, pc: Option<PcCommand>| {
        let bus = step(&mut stage, &remote(mode), pc.as_ref(), NOW_US);
        assert!(!bus.cmd_valid);
        (bus.hl_valid, bus.hl_cmd.vx)
    };
    let fresh = Some(pc_command(NOW_US - 50_000));
    assert_eq!(in_mode(DriveMode::Pc, fresh), (true, 0.1));
    assert_eq!(in_mode(DriveMode::Manual, fresh), (true, 0.5));
    assert_eq!(in_mode(DriveMode::Custom, fresh), (false, 0.0));
    for silent in [None, Some(pc_command(0)), Some(pc_command(NOW_US - 50_001))] {
        assert_eq!(in_mode(DriveMode::Pc, silent), (false, 0.0));
    }
}

#[test]
fn custom_logic_decides_in_custom_mode_and_restarts_each_time() {
    let mut stage = LogicStage::new(Counting::default());
    let mut current_ma = |mode| {
        let bus = step(&mut stage, &remote(mode), None, NOW_US);
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
        let bus = step(&mut stage, &remote, None, NOW_US);
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
        None,
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
            let pc = pc_command(NOW_US);
            let before = step(&mut stage, &remote, Some(&pc), NOW_US);
            assert!(before.cmd_valid || before.hl_valid, "{mode:?}");
            inject(&mut remote);
            let bus = step(&mut stage, &remote, Some(&pc), NOW_US);
            let zero = LogicBus {
                ts_us: NOW_US,
                ..LogicBus::default()
            };
            assert_eq!(bus, zero, "{mode:?}");
        }
    }
}
