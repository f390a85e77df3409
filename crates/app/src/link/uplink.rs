//! The robot's state, robot → PC.

use super::{
    HEADER, Keys, Sticks,
    fields::{FrameReader, FrameWriter},
    scale::{ANGLE, SPEED, VOLTAGE, finite},
};

/// Length of a state frame.
pub const UPLINK_LEN: usize = 94;

/// State of one motor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotorState {
    /// Angle in rad, ±π. That of a wheel wraps.
    pub pos_rad: f32,
    /// Speed in rad/s. The frame holds ±33.
    pub vel_rps: f32,
}

/// The robot's state at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uplink {
    /// Time since boot in s.
    pub time_s: f32,
    /// Battery voltage. The frame holds 20…60; 20 also means not measured.
    pub battery_v: f32,
    /// Temperature of the microcontroller in °C.
    pub mcu_c: i8,
    /// Specific force in body axes (x forward, y left, z up).
    pub accel_mps2: [f32; 3],
    /// Angular rate in body axes, rad/s.
    pub gyro_rps: [f32; 3],
    /// Attitude, body to world: x, y, z, w.
    pub q_xyzw: [f32; 4],
    /// Keys of the remote control.
    pub keys: Keys,
    /// Sticks of the remote control.
    pub sticks: Sticks,
    /// Left wheel, right wheel, left front, left rear, right front, right rear joint.
    pub motors: [MotorState; 6],
}

impl Uplink {
    /// The frame. Every value is limited to what its field holds.
    pub fn encode(&self) -> [u8; UPLINK_LEN] {
        let mut frame = FrameWriter::new(HEADER);
        frame.put(finite(self.time_s));
        frame.put([VOLTAGE.code8(self.battery_v)]);
        frame.put(self.mcu_c.to_le_bytes());
        let vectors = self.accel_mps2.iter().chain(&self.gyro_rps);
        for value in vectors.chain(&self.q_xyzw) {
            frame.put(finite(*value));
        }
        frame.put(self.keys.bits().to_le_bytes());
        let Sticks { lx, rx, ly, l2, ry } = self.sticks;
        for value in [lx, rx, ly, l2, ry] {
            frame.put(finite(value));
        }
        for motor in &self.motors {
            frame.put(ANGLE.code16(motor.pos_rad));
            frame.put(SPEED.code16(motor.vel_rps));
        }
        frame.finish()
    }

    /// Returns `None` if header or CRC is wrong.
    pub fn decode(frame: &[u8; UPLINK_LEN]) -> Option<Self> {
        let mut fields = FrameReader::new(HEADER, frame)?;
        // Fields are evaluated in the order in which they are written here.
        Some(Self {
            time_s: fields.take_f32(),
            battery_v: VOLTAGE.value8(u8::from_le_bytes(fields.take())),
            mcu_c: i8::from_le_bytes(fields.take()),
            accel_mps2: fields.take_f32s(),
            gyro_rps: fields.take_f32s(),
            q_xyzw: fields.take_f32s(),
            keys: Keys::from_bits_retain(u16::from_le_bytes(fields.take())),
            sticks: Sticks {
                lx: fields.take_f32(),
                rx: fields.take_f32(),
                ly: fields.take_f32(),
                l2: fields.take_f32(),
                ry: fields.take_f32(),
            },
            motors: core::array::from_fn(|_| MotorState {
                pos_rad: ANGLE.value16(fields.take()),
                vel_rps: SPEED.value16(fields.take()),
            }),
        })
    }
}
