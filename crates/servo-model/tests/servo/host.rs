//! A host of a few lines, written from the manufacturer's protocol.

use robot_servo_model::{Bus, Servo, Version, View, VirtualWire};

/// Longer than any answer takes, ns.
pub const PATIENCE_NS: u64 = 5_000_000;
pub const SECOND_NS: u64 = 1_000_000_000;

pub struct Host {
    pub wire: VirtualWire,
}

/// An answer: error byte and data.
pub type Answer = (u8, Vec<u8>);

pub fn frame(id: u8, instruction: u8, parameters: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0xFF, 0xFF, id, parameters.len() as u8 + 2, instruction];
    bytes.extend_from_slice(parameters);
    let sum: u32 = bytes[2..].iter().map(|byte| u32::from(*byte)).sum();
    bytes.push(!(sum as u8));
    bytes
}

impl Host {
    pub fn new(servos: Vec<Servo>) -> Self {
        Self {
            wire: VirtualWire::new(Bus::new(servos, 1)),
        }
    }

    /// One servo as shipped, with its shaft at 2048.
    pub fn with_one() -> Self {
        Self::new(vec![Servo::new(Version::Volts12, 2048.0)])
    }

    /// Sends a frame, and returns all bytes that come within [`PATIENCE_NS`].
    pub fn raw(&mut self, bytes: &[u8]) -> Vec<u8> {
        self.wire.write(bytes);
        self.wire.flush();
        let mut answer = vec![0; 256];
        let deadline = self.wire.now_ns() + PATIENCE_NS;
        let read = self.wire.read(&mut answer, deadline);
        answer.truncate(read);
        answer
    }

    /// Sends a request, and returns the answer of that servo, if it is one.
    pub fn ask(&mut self, id: u8, instruction: u8, parameters: &[u8]) -> Option<Answer> {
        let bytes = self.raw(&frame(id, instruction, parameters));
        let [0xFF, 0xFF, from, length, error, data @ .., sum] = bytes.as_slice() else {
            return None;
        };
        let mut all = vec![*from, *length, *error];
        all.extend_from_slice(data);
        let right = !all.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        let is_right = *from == id && usize::from(*length) == data.len() + 2 && right == *sum;
        is_right.then(|| (*error, data.to_vec()))
    }

    pub fn write(&mut self, id: u8, address: u8, data: &[u8]) {
        let parameters = [&[address][..], data].concat();
        self.ask(id, 3, &parameters).expect("an answer");
    }

    pub fn write_u16(&mut self, id: u8, address: u8, value: u16) {
        self.write(id, address, &value.to_le_bytes());
    }

    pub fn read_u8(&mut self, id: u8, address: u8) -> u8 {
        self.ask(id, 2, &[address, 1]).expect("an answer").1[0]
    }

    pub fn read_u16(&mut self, id: u8, address: u8) -> u16 {
        let (_, data) = self.ask(id, 2, &[address, 2]).expect("an answer");
        u16::from_le_bytes([data[0], data[1]])
    }

    pub fn wait_s(&mut self, seconds: f64) {
        self.wire.wait((seconds * SECOND_NS as f64) as u64);
    }

    pub fn view(&mut self) -> View {
        self.wire.bus().view()[0]
    }
}
