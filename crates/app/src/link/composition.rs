//! What a state frame says, from what the robot knows, in the frame's units and directions (docs/pc-link.md).

use core::f32::consts::TAU;

use super::{Keys, MotorState, Sticks, Uplink};
use crate::{
    diagnostics::Telemetry,
    domain::{DriveMode, RemoteUpdate, WheelOdomConfig},
    safety::{ArmingState, SafetyFlags},
};

/// Rotor counts of a turn, times the 1024 that make the length of a wheel's turn an integer.
const COUNTS_PER_ROTOR_TURN: f32 = 8_192.0;
const COUNT_PARTS: i64 = 1_024;
/// A key counts as pressed beyond half way.
const PRESSED: f32 = 0.5;
/// A channel below this count is absent: receivers send 0 for a channel that the transmitter does not have.
const ABSENT_BELOW: u16 = 8;

/// What a state frame is made of.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// The newest tick in brief.
    pub telemetry: &'a Telemetry,
    /// The newest frame of the radio.
    pub remote: &'a RemoteUpdate,
    /// Gear and directions of the wheels.
    pub wheel_odom: &'a WheelOdomConfig,
    /// Battery voltage, 0 while not measured.
    pub battery_v: f32,
    /// Temperature of the microcontroller in °C.
    pub mcu_c: f32,
}

impl Observation<'_> {
    /// The content of a state frame.
    pub fn uplink(&self) -> Uplink {
        let telemetry = self.telemetry;
        let [w, x, y, z] = telemetry.q_wxyz;
        Uplink {
            time_s: telemetry.ts_us as f32 * 1e-6,
            battery_v: self.battery_v,
            mcu_c: rounded(self.mcu_c),
            accel_mps2: telemetry.accel_mps2,
            gyro_rps: telemetry.gyro_dps.map(f32::to_radians),
            q_xyzw: [x, y, z, w],
            keys: self.keys(),
            sticks: self.sticks(),
            motors: self.motors(),
        }
    }

    fn radio_is_lost(&self) -> bool {
        let lost = SafetyFlags::REMOTE_LOST.union(SafetyFlags::REMOTE_FAILSAFE);
        self.telemetry.flags.intersects(lost)
    }

    fn keys(&self) -> Keys {
        let mut keys = Keys::empty();
        keys.set(Keys::F1, self.telemetry.arming == ArmingState::Armed);
        if self.radio_is_lost() {
            return keys.union(Keys::F2);
        }
        let operator = &self.remote.operator;
        keys.set(Keys::START, operator.enabled);
        keys.set(Keys::SELECT, operator.e_stop);
        keys.set(Keys::Y, operator.dead_man);
        keys.insert(match operator.mode {
            DriveMode::Manual => Keys::A,
            DriveMode::Pc => Keys::B,
            DriveMode::Custom => Keys::X,
        });
        for (key, index) in [
            (Keys::L1, 9),
            (Keys::R1, 10),
            (Keys::L2, 11),
            (Keys::R2, 12),
            (Keys::UP, 13),
            (Keys::RIGHT, 14),
        ] {
            keys.set(key, self.channel(index) > PRESSED);
        }
        for (key, index) in [(Keys::DOWN, 13), (Keys::LEFT, 14)] {
            keys.set(key, self.channel(index) < -PRESSED);
        }
        keys
    }

    fn sticks(&self) -> Sticks {
        if self.radio_is_lost() {
            return Sticks::default();
        }
        let state = &self.remote.state;
        Sticks {
            lx: state.hold,
            rx: -state.wz,
            ly: state.select,
            l2: self.channel(11),
            ry: state.vx,
        }
    }

    /// Position of a channel, counted from 0; 0 for one that is absent.
    fn channel(&self, index: usize) -> f32 {
        let raw = self.remote.raw.get(index).copied().unwrap_or(0);
        if raw < ABSENT_BELOW {
            return 0.0;
        }
        let channels = &self.remote.state.channels;
        channels.get(index).copied().unwrap_or(0.0)
    }

    fn motors(&self) -> [MotorState; 6] {
        let telemetry = self.telemetry;
        let [left_sign, right_sign] = self.wheel_odom.rpm_signs();
        let [left_counts, right_counts] = telemetry.wheel_counts;
        let [left_rpm, right_rpm] = telemetry.wheel_rpm;
        let [left_front, left_rear, right_front, right_rear] = telemetry.joint_rad;
        let [
            left_front_rps,
            left_rear_rps,
            right_front_rps,
            right_rear_rps,
        ] = telemetry.joint_rps;
        let joint = |pos_rad, vel_rps| MotorState { pos_rad, vel_rps };
        [
            self.wheel(left_counts, left_rpm, left_sign),
            self.wheel(right_counts, right_rpm, right_sign),
            joint(left_front, left_front_rps),
            joint(left_rear, left_rear_rps),
            joint(right_front, right_front_rps),
            joint(right_rear, right_rear_rps),
        ]
    }

    /// `sign` is the rotor's direction that drives the robot forward.
    fn wheel(&self, counts: i64, rpm: i16, sign: f32) -> MotorState {
        let gear_ratio = self.wheel_odom.gear_ratio;
        MotorState {
            pos_rad: sign * wheel_angle(counts, gear_ratio),
            vel_rps: sign * f32::from(rpm) * (TAU / 60.0) / gear_ratio,
        }
    }
}

/// Angle of a wheel within ±π. Its turns are taken off in integers, so it stays exact to the rounding of the
/// gear ratio: some hundredths of a radian after 100,000 turns.
fn wheel_angle(counts: i64, gear_ratio: f32) -> f32 {
    // Exact: a ratio from 1 on is a multiple of 2⁻²³, and the factor is 2²³.
    let turn = (gear_ratio * COUNTS_PER_ROTOR_TURN * COUNT_PARTS as f32) as i64;
    let parts = counts.wrapping_mul(COUNT_PARTS);
    let Some(within) = parts.checked_rem(turn) else {
        return 0.0;
    };
    let angle = within as f32 / turn as f32;
    // From the turn before or after.
    if angle > 0.5 {
        (angle - 1.0) * TAU
    } else if angle < -0.5 {
        (angle + 1.0) * TAU
    } else {
        angle * TAU
    }
}

/// The nearest whole degree. NaN gives 0.
fn rounded(celsius: f32) -> i8 {
    (celsius + if celsius < 0.0 { -0.5 } else { 0.5 }) as i8
}

#[cfg(test)]
mod tests;
