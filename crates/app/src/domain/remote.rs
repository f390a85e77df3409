//! State of the pilot's radio.

use super::age_us;
use crate::math::scalar;

/// Sticks and switches, normalised.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RemoteState {
    /// All channels, −1…1 by the counts of a FrSky transmitter, independent of the settings.
    pub channels: [f32; 16],
    /// Forward stick, −1…1, forward positive.
    pub vx: f32,
    /// Turn stick, −1…1, left positive.
    pub wz: f32,
    /// Left stick, vertical, −1…1, up positive. It selects the motor in bring-up.
    pub select: f32,
    /// Left stick, horizontal, −1…1, right positive. Held to the right it is the dead-man of bring-up.
    pub hold: f32,
    /// Wanted leg length, −1…1, long positive.
    pub height: f32,
    /// Wanted roll, −1…1, right side down positive.
    pub roll: f32,
    /// Time of the last frame received over the air; 0 = none yet.
    pub ts_us: u64,
}

/// Source of the drive command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum DriveMode {
    /// The sticks.
    #[default]
    Manual = 0,
    /// The computer on the PC link.
    Pc = 1,
    /// The user's logic in `logic/user_logic.rs`.
    Custom = 2,
}

/// Position of the stand switch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum StandSwitch {
    /// Between its ends, not yet seen, or without a channel.
    #[default]
    Unknown = 0,
    /// Sit.
    Down = 1,
    /// Stand.
    Up = 2,
}

/// The pilot's switches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct OperatorState {
    /// The enable switch is on.
    pub enabled: bool,
    /// The enable switch is confirmed off. It is never set together with `enabled`; if neither is set, the position
    /// is uncertain.
    pub disabled: bool,
    /// The e-stop is thrown.
    pub e_stop: bool,
    /// The left stick is held to the right, which bring-up needs for torque.
    pub dead_man: bool,
    /// Position of the mode switch.
    pub mode: DriveMode,
    /// Position of the stand switch.
    pub stand: StandSwitch,
    /// The jump button is pressed.
    pub jump: bool,
    /// Time of the frame; 0 = none yet.
    pub ts_us: u64,
}

impl Default for OperatorState {
    /// Without any frame the robot is stopped.
    fn default() -> Self {
        Self {
            enabled: false,
            disabled: false,
            e_stop: true,
            dead_man: false,
            mode: DriveMode::Manual,
            stand: StandSwitch::Unknown,
            jump: false,
            ts_us: 0,
        }
    }
}

/// Quality of the radio link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RemoteDiagnostics {
    /// Smoothed number of frames per second on the wire.
    pub frame_rate_hz: f32,
    /// Fraction of the last 64 frames that were complete and without the frame-lost flag, as of the last accepted
    /// one. Frames before the first count as good.
    pub quality: f32,
    /// Accepted frames, with or without the frame-lost flag.
    pub frames: u32,
    /// Frames with the frame-lost flag, in which the receiver repeats old values.
    pub lost_frames: u32,
    /// Bytes that belonged to no accepted frame.
    pub discarded_bytes: u32,
    /// Bursts of bytes dropped because the UART flagged an error in them (parity, framing, noise, overrun).
    pub damaged_bursts: u32,
    /// The receiver reports that the radio is lost.
    pub failsafe: bool,
    /// Age of the last frame received over the air; `u32::MAX` before the first.
    pub age_us: u32,
    /// Time of the last frame on the wire, 0 = none yet.
    pub frame_ts_us: u64,
    /// Time of the last frame received over the air, 0 = none yet.
    pub good_ts_us: u64,
}

impl RemoteDiagnostics {
    /// The link's state at `now_us`: without frames, ages grow and the rate falls.
    #[must_use]
    pub fn at(mut self, now_us: u64) -> Self {
        self.age_us = age_us(self.good_ts_us, now_us);
        let silence_us = age_us(self.frame_ts_us, now_us);
        if silence_us > 0 {
            self.frame_rate_hz = scalar::min(self.frame_rate_hz, 2_000_000.0 / silence_us as f32);
        }
        self
    }
}

/// The result of one decoded frame. It is published as a whole, so it is always consistent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RemoteUpdate {
    /// Sticks and channels.
    pub state: RemoteState,
    /// Switches.
    pub operator: OperatorState,
    /// Quality of the link.
    pub diagnostics: RemoteDiagnostics,
    /// Raw channels of the last frame, even a lost one. SBUS: 0…2047. DBUS: the four sticks and the wheel, 364…1684,
    /// then zeros.
    pub raw: [u16; 16],
}
