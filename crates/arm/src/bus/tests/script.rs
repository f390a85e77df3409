//! A line whose servos are a function of the test, in simulated time.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex},
    time::Duration,
};

use crate::bus::{ServoBus, Wire, WireError};

/// Bytes that come so long after the request.
pub type Burst = (Duration, Vec<u8>);

/// What was sent so far.
pub type Sent = Arc<Mutex<Vec<Vec<u8>>>>;

pub struct ScriptWire<F> {
    now: Duration,
    due: VecDeque<Burst>,
    sent: Sent,
    servos: F,
}

impl<F: FnMut(&[u8]) -> Vec<Burst> + Send + 'static> ScriptWire<F> {
    /// `servos` says what comes for a request.
    pub fn bus(servos: F) -> (ServoBus, Sent) {
        let sent = Sent::default();
        let wire = Self {
            now: Duration::ZERO,
            due: VecDeque::new(),
            sent: sent.clone(),
            servos,
        };
        (ServoBus::new(Box::new(wire), 1_000_000), sent)
    }
}

impl<F: FnMut(&[u8]) -> Vec<Burst> + Send> Wire for ScriptWire<F> {
    fn name(&self) -> &str {
        "script"
    }

    fn now(&self) -> Duration {
        self.now
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), WireError> {
        // Filler between tries is no request.
        if bytes.iter().all(|byte| *byte == 0) {
            return Ok(());
        }
        self.sent.lock().unwrap().push(bytes.to_vec());
        let bursts = (self.servos)(bytes);
        let due = bursts
            .into_iter()
            .map(|(after, bytes)| (self.now + after, bytes));
        self.due.extend(due);
        self.due.make_contiguous().sort_by_key(|(at, _)| *at);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Duration) -> Result<usize, WireError> {
        match self.due.front_mut() {
            Some((at, bytes)) if *at <= deadline.max(self.now) => {
                self.now = self.now.max(*at);
                let count = bytes.len().min(buffer.len());
                buffer[..count].copy_from_slice(&bytes[..count]);
                bytes.drain(..count);
                if bytes.is_empty() {
                    self.due.pop_front();
                }
                Ok(count)
            }
            _ => {
                self.now = self.now.max(deadline);
                Ok(0)
            }
        }
    }

    fn set_baud(&mut self, _: u32) -> Result<(), WireError> {
        Ok(())
    }

    fn reopen(&mut self) -> Result<(), WireError> {
        Ok(())
    }
}

/// An answer, put together by hand: `FF FF id length status data checksum`.
pub fn answer(id: u8, status: u8, data: &[u8]) -> Vec<u8> {
    let length = data.len() as u8 + 2;
    let sum: u32 = [id, length, status]
        .iter()
        .chain(data)
        .map(|b| u32::from(*b))
        .sum();
    let checksum = 255 - (sum % 256) as u8;
    [&[0xFF, 0xFF, id, length, status], data, &[checksum]].concat()
}

/// Comes at once.
pub fn soon(bytes: Vec<u8>) -> Vec<Burst> {
    vec![(Duration::from_micros(600), bytes)]
}
