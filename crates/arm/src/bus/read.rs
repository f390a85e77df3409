//! Pings and reads.

use super::{
    Alarms, Block, BlockReading, BusError, Cause, ServoBus, ServoError,
    ask::Outcome,
    exchange::Question,
    frame::Instruction,
    register::{self, Register},
};

/// A value with the servo's alarms at that moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    pub value: i32,
    pub alarms: Alarms,
}

impl ServoBus {
    /// Asks a servo whether it is there. Returns its alarms.
    pub fn ping(&mut self, id: u8) -> Result<Alarms, BusError> {
        self.last_had_echo = false;
        match self.ask(id, &Question::Do(Instruction::Ping, &[]), "ping") {
            Ok(answer) => Ok(answer.alarms),
            // A servo with a voltage alarm answers a ping with a copy of the ping. An adapter that returns what is sent looks
            // the same, so that something else is asked.
            Err(BusError::Servo(error)) if error.cause == Cause::NoAnswer && self.last_had_echo => {
                Ok(self.read(id, register::ID)?.alarms)
            }
            Err(error) => Err(error),
        }
    }

    /// Reads one register.
    pub fn read(&mut self, id: u8, register: Register) -> Result<Reading, BusError> {
        let block = Block::from(register);
        let reading = self.read_block(id, block)?;
        let value = reading.value(register);
        let alarms = reading.alarms;
        // The length was checked, so that the value is there.
        let value =
            value.ok_or_else(|| self.servo_error(id, register.name(), 1, Cause::Damaged))?;
        Ok(Reading { value, alarms })
    }

    /// Reads neighbouring registers at once.
    pub fn read_block(&mut self, id: u8, block: Block) -> Result<BlockReading, BusError> {
        let question = Question::Read {
            address: block.address(),
            size: block.size(),
        };
        let asked = format!("read {}", block.words());
        let answer = self.ask(id, &question, &asked)?;
        let reading = BlockReading::new(block, answer.alarms, answer.data);
        self.learn(id, &reading);
        Ok(reading)
    }

    /// Reads the same registers of several servos with one request. The outcomes are in the order of `ids`: one servo's error
    /// leaves the values of the others.
    pub fn sync_read(
        &mut self,
        ids: &[u8],
        block: Block,
    ) -> Result<Vec<Result<BlockReading, ServoError>>, BusError> {
        let question = Question::SyncRead {
            address: block.address(),
            size: block.size(),
        };
        let asked = format!("read {}", block.words());
        let outcomes = self.ask_all(ids, &question, &asked)?;
        let reading = |outcome: Outcome| {
            outcome.map(|answer| BlockReading::new(block, answer.alarms, answer.data))
        };
        let readings: Vec<_> = outcomes.into_iter().map(reading).collect();
        for (id, reading) in ids.iter().zip(&readings) {
            if let Ok(reading) = reading {
                self.learn(*id, reading);
            }
        }
        Ok(readings)
    }

    /// A servo's own delay becomes part of its time-out.
    fn learn(&mut self, id: u8, reading: &BlockReading) {
        if let Some(delay) = reading.value(register::RETURN_DELAY) {
            self.timing.learn(id, delay);
        }
    }
}
