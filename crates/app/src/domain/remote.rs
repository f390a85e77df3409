//! What the pilot's radio says.

use super::age_us;
use crate::math::scalar;

/// Sticks and switches, normalised.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RemoteState {
    /// −1 … 1 each, as of a FrSky transmitter, whatever the settings say.
    pub channels: [f32; 16],
    /// Forward stick, −1 … 1, forward positive.
    pub vx: f32,
    /// Turn stick, −1 … 1, left turn positive.
    pub wz: f32,
    /// Left stick's vertical, −1 … 1, up positive: picks the motor in bring-up.
    pub select: f32,
    /// Last frame that really came over the air; 0 = none yet.
    pub ts_us: u64,
}

/// Who decides where the robot goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum DriveMode {
    /// The sticks.
    #[default]
    Manual = 0,
    /// The computer on the PC link.
    Pc = 1,
    /// `logic/user_logic.rs`.
    Custom = 2,
}

/// What the pilot asks for with the switches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct OperatorState {
    pub enabled: bool,
    /// The enable switch is off beyond doubt; never together with `enabled`. Neither of the two: not known for sure.
    pub disabled: bool,
    pub e_stop: bool,
    /// The left stick is held to the right: what bring-up's torque needs.
    pub dead_man: bool,
    /// Three-position switch.
    pub mode: DriveMode,
    pub ts_us: u64,
}

impl Default for OperatorState {
    /// Until a frame says otherwise the operator wants a stop.
    fn default() -> Self {
        Self {
            enabled: false,
            disabled: false,
            e_stop: true,
            dead_man: false,
            mode: DriveMode::Manual,
            ts_us: 0,
        }
    }
}

/// Quality of the radio link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RemoteDiagnostics {
    /// Frames a second on the wire, smoothed.
    pub frame_rate_hz: f32,
    /// Fraction of the last 64 frames that came whole and without the frame-lost flag, at the last accepted one; frames
    /// before the first count as good.
    pub quality: f32,
    /// Accepted frames, with or without the frame-lost flag.
    pub frames: u32,
    /// Frames that carried the frame-lost flag (the receiver repeats old values in them).
    pub lost_frames: u32,
    /// Bytes that belonged to no accepted frame.
    pub discarded_bytes: u32,
    /// Bursts of bytes dropped because the UART flagged one of them (parity, framing, noise, overrun).
    pub damaged_bursts: u32,
    /// The receiver itself says that the radio is gone.
    pub failsafe: bool,
    /// Age of the last frame that came over the air; `u32::MAX` before the first.
    pub age_us: u32,
    /// Last frame on the wire, 0 = none yet.
    pub frame_ts_us: u64,
    /// Last frame that came over the air, 0 = none yet.
    pub good_ts_us: u64,
}

impl RemoteDiagnostics {
    /// The same link seen at `now_us`: ages grow and the rate falls when frames stay away.
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

/// One decoded frame: all that the radio stage publishes, together so that it is always consistent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RemoteUpdate {
    pub state: RemoteState,
    pub operator: OperatorState,
    pub diagnostics: RemoteDiagnostics,
    /// Channels as on the wire in the last frame, lost or not: SBUS 0 … 2047; of DBUS the four sticks and the wheel,
    /// 364 … 1684, then zeros.
    pub raw: [u16; 16],
}
