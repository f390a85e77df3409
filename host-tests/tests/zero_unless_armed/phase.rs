//! Inputs of the tick, phase by phase.

use proptest::prelude::*;
use robot_app::{
    domain::{
        BusErrorState, DriveMode, JointCommand, JointMode, JointTarget, StandSwitch, WheelTarget,
    },
    link::{Downlink, crc8},
    tuning::{READ_ID, WRITE_ID, opcode},
};

use crate::motors::Behaviour;

/// Behaviour of the clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    Runs,
    Stands,
    /// Length of a tick in µs.
    RunsBack(u16),
    Rushes(u32),
}

/// A phase of ticks with constant faults.
#[derive(Clone, Debug)]
pub struct Phase {
    pub ticks: u16,
    pub enabled: bool,
    pub e_stop: bool,
    pub mode: DriveMode,
    pub stand: StandSwitch,
    pub failsafe: bool,
    pub radio_sends: bool,
    pub quality: f32,
    pub sticks: (f32, f32),
    pub channels: [f32; 16],
    pub imu_sends: bool,
    pub accel: [f32; 3],
    pub gyro: [f32; 3],
    pub gyro_bias: [f32; 3],
    pub mag: [f32; 3],
    pub calibrated: bool,
    pub buses: [BusErrorState; 2],
    /// Number of frames that could not be sent since the last that was.
    pub tx_failures: [u32; 2],
    pub late_task: bool,
    pub logic_sends: bool,
    /// Command that bypasses the controller: current of both wheels in mA, and every joint's command.
    pub direct: Option<(f32, JointCommand)>,
    pub imu_errors: u32,
    pub battery_v: f32,
    pub wheels: [Behaviour; 2],
    pub joints: [Behaviour; 4],
    pub time_jump_us: u64,
    pub clock: Clock,
    /// Frame that is sent in every tick on both buses.
    pub frame: (u16, Vec<u8>),
    pub pc: Pc,
}

/// What the computer on the PC link sends.
#[derive(Clone, Debug, PartialEq)]
pub enum Pc {
    Silent,
    /// This command in every tenth tick.
    Repeats(Downlink),
    /// These bytes, 46 in each tick, over and over: about as many as the line carries.
    Bytes(Vec<u8>),
}

impl Pc {
    /// All wheels at this speed, and all joints at this angle.
    pub fn asks(speed_rps: f32, pos_rad: f32) -> Self {
        Self::Repeats(Downlink {
            wheels: [WheelTarget {
                speed_rps,
                kp: 0.0,
                kd: 0.15,
            }; 2],
            joints: [JointTarget {
                pos_rad,
                kp: 20.0,
                kd: 1.0,
            }; 4],
        })
    }
}

/// Draws inputs that are mostly good, but may have any value.
fn mostly<T: Clone + std::fmt::Debug + 'static>(
    usual: T,
    odd: impl Strategy<Value = T> + 'static,
) -> impl Strategy<Value = T> {
    prop_oneof![9 => Just(usual), 1 => odd]
}

fn behaviour() -> impl Strategy<Value = Behaviour> {
    prop_oneof![
        Just(Behaviour::Gone),
        Just(Behaviour::Frozen),
        any::<u8>().prop_map(Behaviour::Hot),
        (8u8..16).prop_map(Behaviour::Fault),
        any::<bool>().prop_map(Behaviour::Claims),
        (-12.0f32..12.0).prop_map(Behaviour::At),
        any::<[u8; 8]>().prop_map(Behaviour::Garbage),
    ]
}

/// Draws arbitrary commands, and some that a controller might send.
pub fn joint_command() -> impl Strategy<Value = JointCommand> {
    let mode = prop_oneof![
        1 => Just(JointMode::Off),
        4 => Just(JointMode::Mit),
        1 => Just(JointMode::PositionSpeed),
        1 => Just(JointMode::Speed),
    ];
    let number = || prop_oneof![1 => any::<f32>(), 4 => -200.0f32..200.0, 4 => -1.0f32..1.0];
    let fields = (number(), number(), number(), number(), number());
    (mode, fields).prop_map(|(mode, (pos_rad, vel_rps, kp, kd, tau_nm))| JointCommand {
        mode,
        pos_rad,
        vel_rps,
        kp,
        kd,
        tau_nm,
    })
}

/// Draws any frame, but prefers those with a receiver: motors, tuning and bring-up.
fn frame() -> impl Strategy<Value = (u16, Vec<u8>)> {
    let bytes = || prop::collection::vec(any::<u8>(), 0..=8);
    let heard = prop_oneof![0x201u16..=0x204, 0x011u16..=0x014, Just(0x0FD), Just(0x7FF)];
    let requests = (
        prop_oneof![Just(WRITE_ID.raw()), Just(READ_ID.raw())],
        prop_oneof![
            Just(opcode::WRITE_GEOMETRY),
            Just(opcode::READ_GEOMETRY),
            Just(opcode::WRITE_PARAMETER),
            Just(opcode::READ_PARAMETER),
        ],
        prop::collection::vec(any::<u8>(), 0..=7),
    );
    let bring_up = (0u8..5, 0u8..7, 0u8..3, any::<i16>());
    prop_oneof![
        (any::<u16>(), bytes()),
        (heard, bytes()),
        requests.prop_map(|(id, command, rest)| (id, [vec![command], rest].concat())),
        bring_up.prop_map(|(step, motor, action, value)| {
            let [low, high] = value.to_le_bytes();
            (
                WRITE_ID.raw(),
                vec![opcode::BRING_UP, step, motor, action, low, high, 0, 0],
            )
        }),
    ]
}

/// Draws a PC: at rest, in motion, with any command, or on a line full of noise, in which there may be frames.
pub fn pc() -> impl Strategy<Value = Pc> {
    let frame = || {
        prop::array::uniform6(any::<[u16; 3]>()).prop_map(|motors| {
            let mut frame = vec![0xFE];
            frame.extend(
                motors
                    .iter()
                    .flatten()
                    .flat_map(|field| field.to_le_bytes()),
            );
            frame.push(crc8(&frame));
            frame
        })
    };
    let tunnel = || {
        any::<[u8; 9]>().prop_map(|[id, data @ ..]| {
            let mut frame = vec![0xFD, 0xA0 | id & 1, 0x87];
            frame.extend(data);
            frame.push(crc8(&frame));
            frame
        })
    };
    let noise = || prop::collection::vec(any::<u8>(), 0..60);
    let piece = prop_oneof![4 => frame(), 1 => tunnel(), 1 => noise()];
    prop_oneof![
        2 => Just(Pc::Silent),
        3 => Just(Pc::asks(0.0, 0.0)),
        3 => (-20.0f32..20.0, -1.0f32..1.0).prop_map(|(speed, angle)| Pc::asks(speed, angle)),
        2 => prop::collection::vec(piece, 1..20).prop_map(|pieces| Pc::Bytes(pieces.concat())),
    ]
}

fn clock() -> impl Strategy<Value = Clock> {
    prop_oneof![
        Just(Clock::Stands),
        any::<u16>().prop_map(Clock::RunsBack),
        any::<u32>().prop_map(Clock::Rushes),
    ]
}

pub fn phase() -> impl Strategy<Value = Phase> {
    let modes = prop_oneof![4 => Just(DriveMode::Pc), 1 => Just(DriveMode::Custom)];
    let switches = (
        any::<bool>(),
        mostly(false, Just(true)),
        prop_oneof![2 => Just(DriveMode::Manual), 1 => modes],
        mostly(false, Just(true)),
        prop_oneof![
            Just(StandSwitch::Unknown),
            Just(StandSwitch::Down),
            Just(StandSwitch::Up)
        ],
    );
    let radio = (
        mostly(true, Just(false)),
        mostly(1.0, any::<f32>()),
        mostly((0.0, 0.0), any::<(f32, f32)>()),
        mostly([0.0; 16], prop::array::uniform16(-1.0f32..1.0)),
    );
    let imu = (
        mostly(true, Just(false)),
        mostly([0.0, 0.0, 9.81], any::<[f32; 3]>()),
        mostly([0.0; 3], any::<[f32; 3]>()),
        mostly([0.0; 3], any::<[f32; 3]>()),
        mostly([0.0, 20.0, -45.0], any::<[f32; 3]>()),
        mostly(true, Just(false)),
    );
    let bus = || {
        (
            mostly(BusErrorState::Active, Just(BusErrorState::BusOff)),
            mostly(0, any::<u32>()),
        )
    };
    let bad = || mostly(Behaviour::Good, behaviour());
    let motors = (
        [bus(), bus()],
        [bad(), bad()],
        prop_oneof![Just([Behaviour::Good; 4]), [bad(), bad(), bad(), bad()]],
        mostly(24.0, prop_oneof![any::<f32>(), 15.0f32..25.0]),
    );
    let direct = (prop_oneof![Just(3_000.0), any::<f32>()], joint_command());
    let rest = (
        mostly(true, Just(false)),
        mostly(None, direct.prop_map(Some)),
        mostly(0, any::<u32>()),
        mostly(false, Just(true)),
        mostly(0, any::<u64>()),
        mostly(Clock::Runs, clock()),
        frame(),
        pc(),
    );
    (1u16..300, switches, radio, imu, motors, rest).prop_map(
        |(ticks, switches, radio, imu, motors, rest)| Phase {
            ticks,
            enabled: switches.0,
            e_stop: switches.1,
            mode: switches.2,
            failsafe: switches.3,
            stand: switches.4,
            radio_sends: radio.0,
            quality: radio.1,
            sticks: radio.2,
            channels: radio.3,
            imu_sends: imu.0,
            accel: imu.1,
            gyro: imu.2,
            gyro_bias: imu.3,
            mag: imu.4,
            calibrated: imu.5,
            buses: motors.0.map(|(state, _)| state),
            tx_failures: motors.0.map(|(_, failures)| failures),
            wheels: motors.1,
            joints: motors.2,
            battery_v: motors.3,
            logic_sends: rest.0,
            direct: rest.1,
            imu_errors: rest.2,
            late_task: rest.3,
            time_jump_us: rest.4,
            clock: rest.5,
            frame: rest.6,
            pc: rest.7,
        },
    )
}

pub fn phases() -> impl Strategy<Value = Vec<Phase>> {
    prop::collection::vec(phase(), 1..12)
}

/// Inputs without any fault.
pub fn good(ticks: u16, enabled: bool) -> Phase {
    Phase {
        ticks,
        enabled,
        e_stop: false,
        mode: DriveMode::Manual,
        stand: StandSwitch::Unknown,
        failsafe: false,
        radio_sends: true,
        quality: 1.0,
        sticks: (0.0, 0.0),
        channels: [0.0; 16],
        imu_sends: true,
        accel: [0.0, 0.0, 9.81],
        gyro: [0.0; 3],
        gyro_bias: [0.0; 3],
        mag: [0.0, 20.0, -45.0],
        calibrated: true,
        buses: [BusErrorState::Active; 2],
        tx_failures: [0; 2],
        late_task: false,
        logic_sends: true,
        direct: None,
        imu_errors: 0,
        battery_v: 24.0,
        wheels: [Behaviour::Good; 2],
        joints: [Behaviour::Good; 4],
        time_jump_us: 0,
        clock: Clock::Runs,
        frame: (0x300, vec![0; 8]),
        pc: Pc::Silent,
    }
}

/// The same in mode PC, with a PC that sends this.
pub fn good_pc(ticks: u16, enabled: bool, pc: Pc) -> Phase {
    Phase {
        mode: DriveMode::Pc,
        pc,
        ..good(ticks, enabled)
    }
}
