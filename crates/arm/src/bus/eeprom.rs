//! Writes that survive without power.

use std::time::Duration;

use super::{
    BusError, Cause, ServoBus,
    ask::check_id,
    frame::{self, Instruction},
    register::{self, Memory, Register},
};

/// A servo takes some time to store a value, in which it may not answer.
const STORING: Duration = Duration::from_millis(20);

impl ServoBus {
    /// Stores values: switches torque off, takes the lock away, writes, looks, and locks again. **The torque stays off.** What is
    /// stored already is not written again, as the memory wears out.
    pub fn store(&mut self, id: u8, values: &[(Register, i32)]) -> Result<(), BusError> {
        let mut changes = Vec::new();
        for &(register, value) in values {
            if self.read(id, register)?.value != value {
                changes.push((register, value));
            }
        }
        if changes.is_empty() {
            return Ok(());
        }
        self.write(id, register::TORQUE_ENABLE, 0)?;
        self.write(id, register::LOCK, 0)?;
        let stored = self.store_each(id, &changes);
        let locked = self.write(id, register::LOCK, 1);
        stored?;
        locked?;
        Ok(())
    }

    fn store_each(&mut self, id: u8, changes: &[(Register, i32)]) -> Result<(), BusError> {
        for &(register, wanted) in changes {
            self.write(id, register, wanted)?;
            if register.memory() == Memory::Eeprom {
                self.wait(STORING)?;
            }
            let has = self.read(id, register)?.value;
            if has != wanted {
                let asked = format!("store {register}");
                let cause = Cause::NotKept { wanted, has };
                return Err(self.servo_error(id, &asked, 1, cause).into());
            }
        }
        Ok(())
    }

    /// Gives a servo another id. No servo may have it yet.
    pub fn change_id(&mut self, from: u8, to: u8) -> Result<(), BusError> {
        check_id(to)?;
        self.ping(from)?;
        self.write(from, register::TORQUE_ENABLE, 0)?;
        self.write(from, register::LOCK, 0)?;
        // It answers with the one id or the other, so the answer is not waited for.
        let parameters = [register::ID.address(), to];
        self.tell(frame::request(from, Instruction::Write, &parameters))?;
        self.unsettled.extend([from, to]);
        self.wait(STORING)?;
        if let Err(error) = self.ping(to) {
            // The request may have been lost: then it is still there with its old id.
            return match self.ping(from) {
                Ok(_) => {
                    let (wanted, has) = (i32::from(to), i32::from(from));
                    let cause = Cause::NotKept { wanted, has };
                    self.write(from, register::LOCK, 1)?;
                    Err(self.servo_error(from, "store id", 1, cause).into())
                }
                Err(_) => Err(error),
            };
        }
        self.write(to, register::LOCK, 1)?;
        Ok(())
    }
}
