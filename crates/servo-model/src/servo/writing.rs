//! What a servo does with a request, and what it answers.

use super::{
    Servo,
    memory::{
        BAUD_RATE, GOAL_POSITION, HOMING_OFFSET, ID, MODE, REG_WRITE_FLAG, RESPONSE_LEVEL,
        RETURN_DELAY, STATUS, TORQUE_ENABLE, sign_magnitude, signed,
    },
    profile::Profile,
};
use crate::frame::{self, BROADCAST, Frame, Request};

/// Baud rates by the code in register 6.
const BAUD_RATES: [u32; 8] = [
    1_000_000, 500_000, 250_000, 128_000, 115_200, 76_800, 57_600, 38_400,
];
/// An answer without data has one byte less of length than of frame.
const MOST_READ: u8 = 250;

/// An answer, and when it starts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reply {
    /// Bytes on the line.
    pub bytes: Vec<u8>,
    /// Time from the end of the request to the start of the answer, ns.
    pub after_ns: u64,
}

impl Reply {
    /// The same answer with another id.
    pub fn with_id(&self, id: u8) -> Self {
        let mut bytes = self.bytes.clone();
        if let [_, _, own, _, error, data @ .., _] = bytes.as_slice() {
            debug_assert_ne!(*own, BROADCAST);
            bytes = frame::answer(id, *error, data);
        }
        Self { bytes, ..*self }
    }
}

impl Servo {
    /// Id by which it answers.
    pub fn id(&self) -> u8 {
        self.memory.get(ID) as u8
    }

    /// Baud rate at which it hears and answers, b/s.
    pub fn baud(&self) -> u32 {
        let code = usize::from(self.memory.get(BAUD_RATE));
        BAUD_RATES.get(code).copied().unwrap_or(BAUD_RATES[0])
    }

    /// Answers a frame that it heard whole at [`advance`](Self::advance)'s time. A change of id or baud rate is in force after the
    /// answer.
    pub fn hear(&mut self, frame: &Frame) -> Option<Reply> {
        let is_mine = frame.id == self.id();
        if !is_mine && frame.id != BROADCAST {
            return None;
        }
        let id = self.id();
        let delay_ns = self.return_delay_ns();
        let reply = |bytes| {
            Some(Reply {
                bytes,
                after_ns: delay_ns,
            })
        };
        match frame.request()? {
            Request::Ping if is_mine => reply(frame::answer(id, self.error(), &[])),
            Request::Ping => Some(self.turn(usize::from(id), &[])),
            Request::Read { address, length } if is_mine && length <= MOST_READ => {
                let data = self.memory.read(address, length);
                reply(frame::answer(id, self.error(), &data))
            }
            Request::Write { address, data } => {
                let says = is_mine && self.answers_writes();
                self.write(address, data);
                says.then(|| reply(frame::answer(id, self.error(), &[])))?
            }
            Request::RegWrite { address, data } => {
                self.registered = Some((address, data.to_vec()));
                self.memory.set(REG_WRITE_FLAG, 1);
                let says = is_mine && self.answers_writes();
                says.then(|| reply(frame::answer(id, self.error(), &[])))?
            }
            Request::Action => {
                if let Some((address, data)) = self.registered.take() {
                    self.memory.set(REG_WRITE_FLAG, 0);
                    self.write(address, &data);
                }
                let says = is_mine && self.answers_writes();
                says.then(|| reply(frame::answer(id, self.error(), &[])))?
            }
            Request::SyncRead {
                address,
                length,
                ids,
            } if !is_mine && length <= MOST_READ => {
                let place = ids.iter().position(|asked| *asked == id)?;
                let data = self.memory.read(address, length);
                Some(self.turn(place, &data))
            }
            Request::SyncWrite {
                address,
                length,
                records,
            } if !is_mine => {
                for record in records.chunks_exact(usize::from(length) + 1) {
                    if let Some((_, data)) = record.split_first().filter(|(to, _)| **to == id) {
                        self.write(address, data);
                    }
                }
                None
            }
            _ => None,
        }
    }

    /// An answer in its turn: those before it are given the time of an answer as long as its own.
    fn turn(&self, place: usize, data: &[u8]) -> Reply {
        let bytes = frame::answer(self.id(), self.error(), data);
        let one_ns = bytes.len() as u64 * 10_000_000_000 / u64::from(self.baud());
        let delay_ns = self.return_delay_ns();
        Reply {
            bytes,
            after_ns: place as u64 * (one_ns + delay_ns) + delay_ns,
        }
    }

    /// Two microseconds for each unit, and no less than that.
    fn return_delay_ns(&self) -> u64 {
        2_000 * u64::from(self.memory.get(RETURN_DELAY).max(1))
    }

    fn answers_writes(&self) -> bool {
        self.memory.get(RESPONSE_LEVEL) != 0
    }

    fn error(&self) -> u8 {
        self.memory.get(STATUS) as u8
    }

    fn write(&mut self, address: u8, data: &[u8]) {
        let torque = self.memory.get(TORQUE_ENABLE);
        let mode = self.memory.get(MODE);
        self.memory.write(address, data);
        if TORQUE_ENABLE.is_in(address, data.len()) {
            self.torque_written(torque);
        }
        if self.memory.get(MODE) != mode {
            self.profile = Profile::at(self.position());
            self.step_goal = self.position();
        }
        if GOAL_POSITION.is_in(address, data.len()) {
            self.goal_written();
        }
        self.feed_back();
    }

    /// 128 makes the present position the centre; any write lets go of an overload.
    fn torque_written(&mut self, before: u16) {
        match self.memory.get(TORQUE_ENABLE) {
            128 => {
                let offset = signed(self.memory.get(HOMING_OFFSET), 11);
                let encoder = (self.position() as i32 + offset).rem_euclid(4096);
                let centred = (encoder - 2048).clamp(-2047, 2047);
                self.memory
                    .set_kept(HOMING_OFFSET, sign_magnitude(centred, 11));
                self.memory.set(TORQUE_ENABLE, before);
                let centre = self.position();
                self.memory
                    .set(GOAL_POSITION, sign_magnitude(centre as i32, 15));
                self.profile = Profile::at(centre);
            }
            1 if before != 1 => {
                self.profile = Profile::at(self.position());
                self.step_goal = self.position();
                self.protection.reset();
            }
            0 | 1 => self.protection.reset(),
            _ => self.memory.set(TORQUE_ENABLE, before),
        }
    }

    /// In mode 3 a goal is a number of steps from here. A goal that leads away from the load lets go of an overload.
    fn goal_written(&mut self) {
        let goal = f64::from(signed(self.memory.get(GOAL_POSITION), 15));
        if self.memory.get(MODE) == 3 {
            self.step_goal = self.position() + goal;
        }
        let way = self.goal() - self.position();
        if self.protection.is_overloaded() && way * self.duty < 0.0 {
            self.protection.reset();
            self.profile = Profile::at(self.position());
        }
    }
}
