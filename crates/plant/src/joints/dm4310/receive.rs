//! Frames to a DM4310 and its replies.

use super::registers::{ControlMode, NotModelled};
use super::{Dm4310, State, Target};
use crate::{
    joints::drive::{Drive, Reception, Shaft},
    time::{MS, Ps},
    wire::CanFrame,
};

const REGISTERS: u32 = 0x7FF;
const READ: u8 = 0x33;
const WRITE: u8 = 0x55;
const STORE: u8 = 0xAA;
const REFRESH: u8 = 0xCC;
/// While a motor stores its registers it neither receives nor sends for this time. It was measured through a USB adapter,
/// after a write. The reconstruction and python-damiao-driver answer a write alone at once.
const STORE_TIME: Ps = 150 * MS;

/// The part of an identifier that is compared with ESC_ID. The bits above select the mode (umeow0716/damiao_firmware,
/// `can_protocol.c`, a reconstruction of the maker's program).
const ADDRESS: u32 = 0xFF;
const MIT: u32 = 0x000;
const POSITION_SPEED: u32 = 0x100;
const SPEED: u32 = 0x200;

const ENABLE: u8 = 0xFC;
const DISABLE: u8 = 0xFD;
const SET_ZERO: u8 = 0xFE;
const CLEAR: u8 = 0xFB;

impl Dm4310 {
    pub(super) fn take_frame(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Reception {
        if !self.powered() || frame.extended || frame.remote || now < self.deaf_until {
            return Reception::Ignored;
        }
        if frame.id == REGISTERS {
            return self.register_request(frame, shaft, now);
        }
        if frame.id & ADDRESS != self.esc_id() {
            return Reception::Ignored;
        }
        self.parts.last_frame_at = now;
        if let Some(tail) = service(frame) {
            self.serve(tail, shaft);
        } else if let Some(target) = self.target_of(frame)
            && self.enabled()
        {
            self.target = target;
        }
        self.reply(shaft, now);
        Reception::Accepted
    }

    fn mode_offset(&self) -> u32 {
        match self.registers.control_mode {
            ControlMode::Mit => MIT,
            ControlMode::PositionSpeed => POSITION_SPEED,
            ControlMode::Speed => SPEED,
        }
    }

    fn serve(&mut self, tail: u8, shaft: Shaft) {
        match (tail, self.state) {
            (ENABLE, State::Disabled) => self.state = State::Enabled,
            (DISABLE, state) => {
                self.parts.stop_frames += 1;
                if state == State::Enabled {
                    self.switch_off(State::Disabled);
                }
            }
            (SET_ZERO, _) => self.parts.zero_rad = shaft.pos_rad,
            // A trip whose cause persists returns at once.
            (CLEAR, State::Tripped(_)) if !self.parts.faults.tripped => {
                self.state = State::Disabled
            }
            _ => {}
        }
    }

    /// Executes a command of the current mode. A command of another mode changes nothing, but gets a reply.
    fn target_of(&self, frame: &CanFrame) -> Option<Target> {
        if frame.id & !ADDRESS != self.mode_offset() {
            return None;
        }
        let [a, b, c, d, rest @ ..] = frame.data;
        let first = f64::from(f32::from_le_bytes([a, b, c, d]));
        let second = f64::from(f32::from_le_bytes(rest));
        match (self.registers.control_mode, frame.dlc) {
            (ControlMode::Mit, 8) => {
                Some(Target::Mit(self.registers.ranges().command(&frame.data)))
            }
            (ControlMode::PositionSpeed, 8) if first.is_finite() && second.is_finite() => {
                Some(Target::PositionSpeed {
                    pos_rad: first,
                    max_rps: second,
                })
            }
            (ControlMode::Speed, 4 | 8) if first.is_finite() => {
                Some(Target::Speed { vel_rps: first })
            }
            _ => None,
        }
    }

    fn register_request(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Reception {
        let [low, high, request, register, value @ ..] = frame.data;
        if u32::from(u16::from_le_bytes([low, high])) != self.esc_id() || frame.dlc < 4 {
            return Reception::Ignored;
        }
        self.parts.last_frame_at = now;
        let done = match (request, frame.dlc) {
            (READ, _) => self.answer(frame, now),
            (WRITE, 8) => {
                let done = self.registers.write(register, value);
                if self.parts.faults.slow_writes {
                    self.deaf_until = now + STORE_TIME;
                }
                done.and_then(|()| self.answer(frame, now.max(self.deaf_until)))
            }
            (STORE, _) => {
                self.stored = self.registers;
                self.deaf_until = now + STORE_TIME;
                self.parts
                    .replies
                    .other(self.mst_id(), frame.data, self.deaf_until);
                Ok(())
            }
            (REFRESH, _) => {
                self.reply(shaft, now);
                Ok(())
            }
            _ => return Reception::Ignored,
        };
        match done {
            Ok(()) => Reception::Accepted,
            Err(NotModelled) => Reception::NotModelled(format!(
                "DM4310: request {request:#04x} for register {register:#04x} with {value:02x?} is not modelled"
            )),
        }
    }

    fn answer(&mut self, frame: &CanFrame, now: Ps) -> Result<(), NotModelled> {
        let mut data = frame.data;
        data[4..].copy_from_slice(&self.registers.read(frame.data[3])?);
        self.parts.replies.other(self.mst_id(), data, now);
        Ok(())
    }

    fn reply(&mut self, shaft: Shaft, now: Ps) {
        let error = match self.state {
            State::Disabled => 0,
            State::Enabled => 1,
            State::Tripped(trip) => trip as u8,
        };
        let (motion, fed_back) = self.registers.ranges().feedback(
            shaft.pos_rad - self.parts.zero_rad,
            shaft.vel_rps,
            self.parts.actuator.torque_nm(),
        );
        let mut data = [0; 8];
        data[0] = error << 4 | (self.esc_id() & 0xF) as u8;
        data[1..6].copy_from_slice(&motion);
        data[6] = self.parts.actuator.driver_c().round() as u8;
        data[7] = self.parts.actuator.winding_c().round() as u8;
        let id = self.mst_id();
        self.parts
            .replies
            .feedback(id, data, fed_back, self.parts.faults.frozen, now);
    }
}

/// The last byte of a service frame, which counts under any identifier that reaches the motor.
fn service(frame: &CanFrame) -> Option<u8> {
    let [pattern @ .., tail] = frame.data;
    let is_service = frame.dlc == 8
        && pattern == [0xFF; 7]
        && matches!(tail, ENABLE | DISABLE | SET_ZERO | CLEAR);
    is_service.then_some(tail)
}
