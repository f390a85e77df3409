//! A record: the robot at one instant in 18 words.
//!
//! | word | holds, lowest bits first |
//! |---|---|
//! | 0 | time in 0.1 ms |
//! | 1, 2 | attitude, body → world, w x y z, in 1/32767 |
//! | 3, 4 | gyro x y z in 1/16 °/s, acceleration x in 1/128 m/s² |
//! | 5 | acceleration y z |
//! | 6 | wheel speeds in 1/100 rad/s, at the wheel, forward positive |
//! | 7, 8 | wheel currents sent, measured, in mA, forward positive |
//! | 9, 10 | joint angles in 1/2500 rad |
//! | 11 | joint torques in 1/6 N·m, 8 bits each |
//! | 12 | safety flags |
//! | 13 | battery in 1/8 V; state; age of the command in ms; age of the radio in ms |
//! | 14 | late tasks; CAN; commanded speed and turn in 1/127 |
//! | 15, 16 | [balance](super::balance_sample) |
//! | 17 | CRC-32 of the words before and the recording's number |
//!
//! A record of layout 1 has no words 15 and 16.
//!
//! State: bit 0 armed, 1 enable switch, 2 estimate valid, 3 and 4 mode, 5 to 7 source of the command. CAN: bits 0 and 1
//! state of CAN1, 2 and 3 of CAN2, 4 to 7 the ticks missed since boot, modulo 16.

use super::{
    balance_sample::BalanceSample,
    fixed_point::{fixed, fixed_byte, positive_byte},
};
use crate::{
    bring_up::BringUpStep,
    diagnostics::DiagnosticsSnapshot,
    domain::{BusErrorState, DriveMode, LateTasks, WheelOdomConfig, age_us},
    math::checksum::checksum_of_words,
    safety::{ArmingState, SafetyFlags},
};

/// Words of a record.
pub(super) const RECORD_WORDS: usize = 18;
/// Words of a record of layout 1.
pub(super) const FIRST_RECORD_WORDS: usize = 16;
/// Words that the records of all layouts begin with.
const COMMON_WORDS: usize = 15;

pub(super) type Record = [u32; RECORD_WORDS];

const UNIT_STEPS: f32 = 32_767.0;
const DPS_STEPS: f32 = 16.0;
const MPS2_STEPS: f32 = 128.0;
const WHEEL_STEPS: f32 = 100.0;
const MA_STEPS: f32 = 1.0;
const RAD_STEPS: f32 = 2_500.0;
const NM_STEPS: f32 = 6.0;
const VOLT_STEPS: f32 = 8.0;
const COMMAND_STEPS: f32 = 127.0;
/// Units of the times of records and events in a second.
pub(super) const UNITS_A_SECOND: f64 = 10_000.0;
const UNIT_US: u64 = 100;
const RPM_TO_RPS: f32 = core::f32::consts::TAU / 60.0;

/// Where the command comes from. The numbers are in the record and never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum CommandSource {
    /// There is none.
    #[default]
    Nobody = 0,
    /// Speed and turn for the controller.
    Drive = 1,
    /// Commands for the motors, past the controller.
    Direct = 2,
    /// The PC link.
    Pc = 3,
    /// Bring-up.
    BringUp = 4,
}

/// The robot at one instant. Values beyond a record's range are recorded as its limit, NaN as 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlackBoxSample {
    /// Time since boot in 0.1 ms.
    pub time: u32,
    /// Rotation from the body frame to the world frame, w first.
    pub q_wxyz: [f32; 4],
    /// Angular rate in body axes in °/s, ±2048.
    pub gyro_dps: [f32; 3],
    /// Specific force in body axes in m/s², ±256.
    pub accel_mps2: [f32; 3],
    /// Speed of each wheel in rad/s, forward positive, ±327.
    pub wheel_rps: [f32; 2],
    /// Current sent to each wheel in mA, forward positive, ±32767.
    pub sent_ma: [f32; 2],
    /// Measured current of each wheel in mA, forward positive, ±32767.
    pub measured_ma: [f32; 2],
    /// Angle of each joint in rad, ±13.1.
    pub joint_rad: [f32; 4],
    /// Torque that each joint reports in N·m, ±21.
    pub joint_nm: [f32; 4],
    /// Safety flags.
    pub flags: SafetyFlags,
    /// Battery voltage, at most 31.9 V; 0 while not measured.
    pub battery_v: f32,
    /// Whether the robot is armed.
    pub armed: bool,
    /// The enable switch is on.
    pub enabled: bool,
    /// The attitude can be trusted.
    pub estimate_valid: bool,
    /// Position of the mode switch.
    pub mode: DriveMode,
    /// Where the command comes from.
    pub source: CommandSource,
    /// Age of the last decision on the logic bus, or of the PC's last command, in ms; 255 stands for more.
    pub command_age_ms: u8,
    /// Age of the last radio frame in ms; 255 stands for more.
    pub radio_age_ms: u8,
    /// Tasks that missed their deadline.
    pub late_tasks: LateTasks,
    /// State of both CAN buses.
    pub can: [BusErrorState; 2],
    /// Ticks missed since boot, modulo 16.
    pub missed_ticks: u8,
    /// Commanded speed as a share of the highest, forward positive. It is 0 while the PC commands.
    pub drive: f32,
    /// Commanded turn as a share of the highest, counter-clockwise positive. It is 0 while the PC commands.
    pub turn: f32,
    /// What the balance controller did; `None` in a record of layout 1.
    pub balance: Option<BalanceSample>,
}

impl BlackBoxSample {
    /// The sample of the report about one tick.
    #[inline(never)]
    pub fn of(report: &DiagnosticsSnapshot, wheels: &WheelOdomConfig) -> Self {
        let sensors = &report.sensors;
        let motor = &sensors.motor;
        let signs = wheels.rpm_signs();
        let forward = |values: [f32; 2]| [values[0] * signs[0], values[1] * signs[1]];
        let speed = |rpm: i16| f32::from(rpm) * RPM_TO_RPS / wheels.gear_ratio;
        let source = CommandSource::of(report);
        let command_us = match source {
            CommandSource::Pc => report.pc_age_us,
            _ => age_us(report.logic.ts_us, report.ts_us),
        };
        Self {
            // It wraps after five days.
            time: (report.ts_us / UNIT_US) as u32,
            q_wxyz: report.estimate.q_wxyz,
            gyro_dps: sensors.imu.gyro_dps,
            accel_mps2: sensors.imu.accel_mps2,
            wheel_rps: forward(motor.wheels.map(|wheel| speed(wheel.rpm))),
            sent_ma: forward(report.command.wheels.map(|wheel| wheel.current_ma)),
            measured_ma: forward(motor.wheels.map(|wheel| wheel.current_ma)),
            joint_rad: motor.joints.map(|joint| joint.pos_rad),
            joint_nm: motor.joints.map(|joint| joint.torque_nm),
            flags: report.safety.flags,
            battery_v: report.battery_v,
            armed: report.arming.state == ArmingState::Armed,
            enabled: report.operator.enabled,
            estimate_valid: report.estimate.valid,
            mode: report.operator.mode,
            source,
            command_age_ms: milliseconds(command_us),
            radio_age_ms: milliseconds(report.remote_diag.age_us),
            late_tasks: report.late_tasks,
            can: report.can.map(|bus| bus.state),
            missed_ticks: (report.tick.missed % 16) as u8,
            drive: report.logic.hl_cmd.vx,
            turn: report.logic.hl_cmd.wz,
            balance: Some(BalanceSample::of(report)),
        }
    }

    /// Time since boot in seconds.
    pub fn seconds(&self) -> f64 {
        f64::from(self.time) / UNITS_A_SECOND
    }

    #[inline(never)]
    pub(super) fn record(&self, number: u16) -> Record {
        let [w, x, y, z] = self.q_wxyz.map(|part| fixed(part, UNIT_STEPS));
        let [gx, gy, gz] = self.gyro_dps.map(|part| fixed(part, DPS_STEPS));
        let [ax, ay, az] = self.accel_mps2.map(|part| fixed(part, MPS2_STEPS));
        let [left_front, left_rear, right_front, right_rear] =
            self.joint_rad.map(|angle| fixed(angle, RAD_STEPS));
        let torques = self.joint_nm.map(|torque| fixed_byte(torque, NM_STEPS));
        let battery = positive_byte(self.battery_v, VOLT_STEPS);
        let [stance, forces] = self.balance.unwrap_or_default().words();
        sealed(
            [
                self.time,
                pair([w, x]),
                pair([y, z]),
                pair([gx, gy]),
                pair([gz, ax]),
                pair([ay, az]),
                pair(self.wheel_rps.map(|speed| fixed(speed, WHEEL_STEPS))),
                pair(self.sent_ma.map(|current| fixed(current, MA_STEPS))),
                pair(self.measured_ma.map(|current| fixed(current, MA_STEPS))),
                pair([left_front, left_rear]),
                pair([right_front, right_rear]),
                u32::from_le_bytes(torques),
                self.flags.bits(),
                u32::from_le_bytes([
                    battery,
                    self.state(),
                    self.command_age_ms,
                    self.radio_age_ms,
                ]),
                u32::from_le_bytes([
                    late_bits(self.late_tasks),
                    self.bus_bits(),
                    fixed_byte(self.drive, COMMAND_STEPS),
                    fixed_byte(self.turn, COMMAND_STEPS),
                ]),
                stance,
                forces,
                0,
            ],
            number,
        )
    }

    /// Decodes a record. Returns `None` if it does not belong to the recording with this number, or is damaged.
    #[inline(never)]
    pub(super) fn from_record(record: &Record, number: u16) -> Option<Self> {
        let [common @ .., stance, forces, _] = record;
        (*record == sealed(*record, number)).then(|| Self {
            balance: Some(BalanceSample::of_words([*stance, *forces])),
            ..Self::of_words(common)
        })
    }

    /// Does the same with a record of layout 1.
    pub(super) fn from_first_record(
        record: &[u32; FIRST_RECORD_WORDS],
        number: u16,
    ) -> Option<Self> {
        let [common @ .., _] = record;
        (*record == sealed(*record, number)).then(|| Self::of_words(common))
    }

    fn of_words(common: &[u32; COMMON_WORDS]) -> Self {
        let [
            time,
            q0,
            q1,
            imu0,
            imu1,
            imu2,
            speeds,
            sent,
            measured,
            left,
            right,
            torques,
            flags,
            state,
            rest,
        ] = *common;
        let [w, x, y, z] = quad([q0, q1], UNIT_STEPS);
        let [gx, gy, gz, _] = quad([imu0, imu1], DPS_STEPS);
        let [_, ax, ay, az] = quad([imu1, imu2], MPS2_STEPS);
        let [battery, state, command_age_ms, radio_age_ms] = state.to_le_bytes();
        let [late, buses, drive, turn] = rest.to_le_bytes();
        Self {
            time,
            q_wxyz: [w, x, y, z],
            gyro_dps: [gx, gy, gz],
            accel_mps2: [ax, ay, az],
            wheel_rps: split(speeds, WHEEL_STEPS),
            sent_ma: split(sent, MA_STEPS),
            measured_ma: split(measured, MA_STEPS),
            joint_rad: quad([left, right], RAD_STEPS),
            joint_nm: torques
                .to_le_bytes()
                .map(|torque| f32::from(torque.cast_signed()) / NM_STEPS),
            flags: SafetyFlags::from_bits_retain(flags),
            battery_v: f32::from(battery) / VOLT_STEPS,
            armed: state & 1 != 0,
            enabled: state & 2 != 0,
            estimate_valid: state & 4 != 0,
            mode: mode_of(state >> 3 & 3),
            source: CommandSource::of_code(state >> 5),
            command_age_ms,
            radio_age_ms,
            late_tasks: late_of(late),
            can: [bus_of(buses & 3), bus_of(buses >> 2 & 3)],
            missed_ticks: buses >> 4,
            drive: f32::from(drive.cast_signed()) / COMMAND_STEPS,
            turn: f32::from(turn.cast_signed()) / COMMAND_STEPS,
            balance: None,
        }
    }

    fn state(&self) -> u8 {
        u8::from(self.armed)
            | u8::from(self.enabled) << 1
            | u8::from(self.estimate_valid) << 2
            | (self.mode as u8) << 3
            | (self.source as u8) << 5
    }

    fn bus_bits(&self) -> u8 {
        let [can1, can2] = self.can.map(|state| state as u8);
        can1 | can2 << 2 | self.missed_ticks << 4
    }
}

impl CommandSource {
    const ALL: [Self; 5] = [
        Self::Nobody,
        Self::Drive,
        Self::Direct,
        Self::Pc,
        Self::BringUp,
    ];

    fn of(report: &DiagnosticsSnapshot) -> Self {
        if report.bring_up.step != BringUpStep::Off {
            Self::BringUp
        } else if report.logic.cmd_valid {
            Self::Direct
        } else if report.logic.pc_selected {
            Self::Pc
        } else if report.logic.hl_valid {
            Self::Drive
        } else {
            Self::Nobody
        }
    }

    fn of_code(code: u8) -> Self {
        let mut all = Self::ALL.into_iter();
        let found = all.find(|source| *source as u8 == code);
        found.unwrap_or_default()
    }
}

/// Returns the record with its last word replaced by the checksum. It takes in the recording's number, so that a record of
/// an older recording in the same bank does not count.
fn sealed<const WORDS: usize>(mut record: [u32; WORDS], number: u16) -> [u32; WORDS] {
    if let Some(last) = record.last_mut() {
        *last = number.into();
    }
    let crc = checksum_of_words(&record);
    if let Some(last) = record.last_mut() {
        *last = crc;
    }
    record
}

fn pair([low, high]: [i16; 2]) -> u32 {
    u32::from(low.cast_unsigned()) | u32::from(high.cast_unsigned()) << 16
}

fn split(word: u32, steps: f32) -> [f32; 2] {
    [word as u16, (word >> 16) as u16].map(|half| f32::from(half.cast_signed()) / steps)
}

fn quad([first, second]: [u32; 2], steps: f32) -> [f32; 4] {
    let [a, b] = split(first, steps);
    let [c, d] = split(second, steps);
    [a, b, c, d]
}

fn milliseconds(us: u32) -> u8 {
    u8::try_from(us / 1_000).unwrap_or(u8::MAX)
}

fn late_bits(late: LateTasks) -> u8 {
    u8::from(late.imu)
        | u8::from(late.mag) << 1
        | u8::from(late.sbus) << 2
        | u8::from(late.logic) << 3
        | u8::from(late.status) << 4
        | u8::from(late.params) << 5
        | u8::from(late.link_receive) << 6
        | u8::from(late.link_send) << 7
}

fn late_of(bits: u8) -> LateTasks {
    LateTasks {
        imu: bits & 1 != 0,
        mag: bits & 2 != 0,
        sbus: bits & 4 != 0,
        logic: bits & 8 != 0,
        status: bits & 16 != 0,
        params: bits & 32 != 0,
        link_receive: bits & 64 != 0,
        link_send: bits & 128 != 0,
    }
}

fn mode_of(code: u8) -> DriveMode {
    match code {
        1 => DriveMode::Pc,
        2 => DriveMode::Custom,
        _ => DriveMode::Manual,
    }
}

fn bus_of(code: u8) -> BusErrorState {
    match code {
        0 => BusErrorState::Active,
        1 => BusErrorState::Passive,
        _ => BusErrorState::BusOff,
    }
}

#[cfg(test)]
mod tests;
