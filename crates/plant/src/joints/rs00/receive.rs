//! Frames to an RS00 and its replies.

use super::{Mode, RANGES, Rs00, Target};
use crate::{
    joints::drive::{Drive, Reception, Shaft},
    time::Ps,
    wire::CanFrame,
};

const ENABLE_OR_MODE: u8 = 0xFC;
const STOP: u8 = 0xFD;
const SET_ZERO: u8 = 0xFE;
const FAULTS: u8 = 0xFB;
/// Byte 6 of a service frame that means the plain service.
const PLAIN: u8 = 0xFF;

impl Rs00 {
    pub(super) fn take_frame(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Reception {
        let addressed = frame.id & 0xFF == self.id() && frame.id <= 0x2FF;
        if !self.powered() || !addressed || frame.extended || frame.remote || frame.dlc != 8 {
            return Reception::Ignored;
        }
        self.parts.last_frame_at = now;
        let [service @ .., detail, tail] = frame.data;
        let is_service = frame.id >> 8 == 0 && service == [0xFF; 6];
        match (tail, detail) {
            (ENABLE_OR_MODE, PLAIN) if is_service => self.running = self.fault_word == 0,
            (ENABLE_OR_MODE, mode) if is_service => self.set_mode(mode),
            (STOP, PLAIN) if is_service => {
                self.parts.stop_frames += 1;
                self.switch_off();
            }
            (SET_ZERO, _) if is_service => self.set_zero(shaft),
            (FAULTS, PLAIN) if is_service => self.clear_faults(),
            (FAULTS, _) if is_service => {
                self.reply_faults(now);
                return Reception::Accepted;
            }
            // Identifiers, saving, unsolicited reports and another protocol are not modelled.
            (0xF7..=0xFA | STOP, _) if is_service => {
                return Reception::NotModelled(format!(
                    "RS00: {:02x?} is not modelled",
                    frame.data
                ));
            }
            _ => self.take_target(frame),
        }
        self.reply(shaft, now);
        Reception::Accepted
    }

    /// Sets the mode. It is assumed that this works only while stopped.
    fn set_mode(&mut self, mode: u8) {
        if self.running {
            return;
        }
        match mode {
            0 => self.mode = Mode::Mit,
            1 => self.mode = Mode::Position,
            2 => self.mode = Mode::Speed,
            _ => {}
        }
    }

    /// Sets the zero. The goal also becomes 0.
    fn set_zero(&mut self, shaft: Shaft) {
        self.parts.zero_rad = shaft.pos_rad;
        match &mut self.target {
            Target::Mit(command) => command.pos_rad = 0.0,
            Target::Position { pos_rad, .. } => *pos_rad = 0.0,
            Target::None | Target::Speed { .. } => {}
        }
    }

    /// Clears a fault. A fault whose cause persists returns at once.
    fn clear_faults(&mut self) {
        if !self.parts.faults.tripped {
            self.fault_word = 0;
        }
    }

    /// A command of another mode than the present one has no effect.
    fn take_target(&mut self, frame: &CanFrame) {
        if !self.running || frame.id >> 8 != self.mode as u32 {
            return;
        }
        let [a, b, c, d, rest @ ..] = frame.data;
        let first = f64::from(f32::from_le_bytes([a, b, c, d]));
        let second = f64::from(f32::from_le_bytes(rest));
        let finite = first.is_finite() && second.is_finite();
        match self.mode {
            Mode::Mit => self.target = Target::Mit(RANGES.command(&frame.data)),
            Mode::Position if finite => {
                self.target = Target::Position {
                    pos_rad: first,
                    max_rps: second,
                }
            }
            Mode::Speed if finite => {
                self.target = Target::Speed {
                    vel_rps: first,
                    max_a: second,
                }
            }
            Mode::Position | Mode::Speed => {}
        }
    }

    /// Bytes 6 and 7 as in the Chinese manual: state, fault and warning above twelve bits of temperature.
    fn reply(&mut self, shaft: Shaft, now: Ps) {
        const RUN: u16 = 2 << 14;
        const FAULT: u16 = 1 << 13;
        let (motion, fed_back) = RANGES.feedback(
            shaft.pos_rad - self.parts.zero_rad,
            shaft.vel_rps,
            self.parts.actuator.torque_nm(),
        );
        let state = u16::from(self.running) * RUN;
        let fault = u16::from(self.fault_word != 0) * FAULT;
        let tenths_c = (self.parts.actuator.winding_c() * 10.0).round() as u16 & 0x0FFF;
        let mut data = [0; 8];
        data[0] = self.id() as u8;
        data[1..6].copy_from_slice(&motion);
        data[6..].copy_from_slice(&(state | fault | tenths_c).to_be_bytes());
        self.parts
            .replies
            .feedback(self.host_id, data, fed_back, self.parts.faults.frozen, now);
    }

    /// No source gives the byte order of the fault word: low byte first, as in the private protocol.
    fn reply_faults(&mut self, now: Ps) {
        let mut data = [0; 8];
        data[0] = self.id() as u8;
        data[1..5].copy_from_slice(&self.fault_word.to_le_bytes());
        self.parts.replies.other(self.host_id, data, now);
    }
}
