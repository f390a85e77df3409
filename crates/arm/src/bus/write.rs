//! Writes.

use super::{
    Alarms, Block, BusError, Cause, ServoBus,
    ask::check_id,
    block::Values,
    exchange::Question,
    frame::{self, Instruction},
    register::{self, Memory, Register},
};

impl ServoBus {
    /// Writes one register. Returns the servo's alarms. What survives without power is better written with
    /// [`store`](Self::store).
    pub fn write(&mut self, id: u8, register: Register, value: i32) -> Result<Alarms, BusError> {
        self.write_block(id, &[(register, value)])
    }

    /// Writes neighbouring registers at once.
    pub fn write_block(&mut self, id: u8, values: &[(Register, i32)]) -> Result<Alarms, BusError> {
        let parameters = parameters(values)?;
        let asked = format!("write {}", Values(values).words());
        if self.mute.contains(&id) {
            return self.write_and_look(id, values, &parameters, &asked);
        }
        let question = Question::Do(Instruction::Write, &parameters);
        match self.ask(id, &question, &asked) {
            Ok(answer) => {
                self.learn_written(id, values);
                Ok(answer.alarms)
            }
            Err(BusError::Servo(error)) if error.cause == Cause::NoAnswer => {
                match self.read(id, register::RESPONSE_LEVEL) {
                    Ok(level) if level.value == 0 => {
                        self.mute.insert(id);
                        self.write_and_look(id, values, &parameters, &asked)
                    }
                    _ => Err(error.into()),
                }
            }
            Err(error) => Err(error),
        }
    }

    /// Sends values that the servo takes when [`action`](Self::action) is called.
    pub fn reg_write(&mut self, id: u8, values: &[(Register, i32)]) -> Result<Alarms, BusError> {
        let parameters = parameters(values)?;
        let asked = format!("prepare {}", Values(values).words());
        let answer = self.ask(
            id,
            &Question::Do(Instruction::RegWrite, &parameters),
            &asked,
        )?;
        Ok(answer.alarms)
    }

    /// Lets all servos take at once what [`reg_write`](Self::reg_write) sent. Nobody answers.
    pub fn action(&mut self) -> Result<(), BusError> {
        self.tell(frame::request(frame::BROADCAST, Instruction::Action, &[]))
    }

    /// Writes the same registers of several servos with one request: they take the values at the same moment. Nobody answers.
    pub fn sync_write(&mut self, values: &[(u8, &[(Register, i32)])]) -> Result<(), BusError> {
        let mut all: Option<Vec<u8>> = None;
        for (id, registers) in values {
            check_id(*id)?;
            let written = parameters(registers)?;
            let (address, bytes) = written.split_first().ok_or(BusError::Nothing)?;
            let size = u8::try_from(bytes.len()).map_err(|_| BusError::TooLong)?;
            let all = all.get_or_insert_with(|| vec![*address, size]);
            if *all.get(..2).unwrap_or_default() != [*address, size] {
                let register = registers.first().ok_or(BusError::Nothing)?.0;
                return Err(BusError::NotNeighbours { register });
            }
            all.push(*id);
            all.extend(bytes);
        }
        let parameters = all.ok_or(BusError::Nothing)?;
        self.tell(frame::request(
            frame::BROADCAST,
            Instruction::SyncWrite,
            &parameters,
        ))
    }

    /// Writes a register of every servo on the bus. Nobody answers.
    pub fn broadcast(&mut self, register: Register, value: i32) -> Result<(), BusError> {
        let parameters = parameters(&[(register, value)])?;
        self.tell(frame::request(
            frame::BROADCAST,
            Instruction::Write,
            &parameters,
        ))
    }

    /// Sends a request that nobody answers.
    pub(super) fn tell(&mut self, request: Option<Vec<u8>>) -> Result<(), BusError> {
        let request = request.ok_or(BusError::TooLong)?;
        self.wire.send(&request)?;
        self.statistics.sent += 1;
        Ok(())
    }

    /// Writes to a servo that answers reads only, and reads what it holds then.
    fn write_and_look(
        &mut self,
        id: u8,
        values: &[(Register, i32)],
        parameters: &[u8],
        asked: &str,
    ) -> Result<Alarms, BusError> {
        let (Some(first), Some(last)) = (values.first(), values.last()) else {
            return Err(BusError::Nothing);
        };
        let mut left = self.retries.tries.max(1);
        loop {
            self.tell(frame::request(id, Instruction::Write, parameters))?;
            let reading = self.read_block(id, Block::new(first.0, last.0))?;
            let differs = values.iter().find_map(|(register, wanted)| {
                let has = reading.value(*register)?;
                (has != *wanted).then_some(Cause::NotKept {
                    wanted: *wanted,
                    has,
                })
            });
            left -= 1;
            match differs {
                None => return Ok(reading.alarms),
                Some(cause) if left == 0 => {
                    return Err(self
                        .servo_error(id, asked, self.retries.tries, cause)
                        .into());
                }
                Some(_) => {}
            }
        }
    }

    fn learn_written(&mut self, id: u8, values: &[(Register, i32)]) {
        for (register, value) in values {
            if *register == register::RETURN_DELAY {
                self.timing.learn(id, *value);
            }
        }
    }
}

/// The address and the bytes of a write.
fn parameters(values: &[(Register, i32)]) -> Result<Vec<u8>, BusError> {
    let read_only = values.iter().find(|(r, _)| r.memory() == Memory::ReadOnly);
    if let Some((register, _)) = read_only {
        return Err(BusError::ReadOnly {
            register: *register,
        });
    }
    let (address, bytes) = Values(values).encode()?;
    Ok([&[address], &bytes[..]].concat())
}
