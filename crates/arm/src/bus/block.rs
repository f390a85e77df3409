//! Neighbouring registers that are read or written at once.

use super::{Alarms, BusError, register::Register};

/// All registers from one to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    first: Register,
    last: Register,
}

impl Block {
    /// Takes the registers from `first` to `last`; in the other order, from `last` to `first`.
    pub const fn new(first: Register, last: Register) -> Self {
        if first.address() <= last.address() {
            Self { first, last }
        } else {
            Self {
                first: last,
                last: first,
            }
        }
    }

    pub(super) fn address(self) -> u8 {
        self.first.address()
    }

    pub(super) fn size(self) -> u8 {
        self.last.end() - self.first.address()
    }

    /// Returns the words for what is read.
    pub(super) fn words(self) -> String {
        if self.first == self.last {
            self.first.to_string()
        } else {
            format!("{} to {}", self.first, self.last)
        }
    }
}

impl From<Register> for Block {
    fn from(register: Register) -> Self {
        Self::new(register, register)
    }
}

/// What a servo answered for a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockReading {
    pub alarms: Alarms,
    block: Block,
    data: Vec<u8>,
}

impl BlockReading {
    pub(super) fn new(block: Block, alarms: Alarms, data: Vec<u8>) -> Self {
        Self {
            alarms,
            block,
            data,
        }
    }

    /// Returns the value of a register. `None` if the block has it not.
    pub fn value(&self, register: Register) -> Option<i32> {
        let from = register.address().checked_sub(self.block.address())?;
        register.decode(self.data.get(usize::from(from)..)?)
    }
}

/// Values for neighbouring registers, in the order of their addresses.
pub(super) struct Values<'a>(pub &'a [(Register, i32)]);

impl Values<'_> {
    /// Returns the address of the first register and the bytes.
    pub(super) fn encode(&self) -> Result<(u8, Vec<u8>), BusError> {
        let mut bytes = Vec::new();
        let mut next = None;
        for &(register, value) in self.0 {
            let (is_next, end) = (
                next.is_none_or(|at| at == register.address()),
                register.end(),
            );
            if !is_next {
                return Err(BusError::NotNeighbours { register });
            }
            next = Some(end);
            if !register.encode(value, &mut bytes) {
                return Err(BusError::Value { register, value });
            }
        }
        let first = self.0.first().ok_or(BusError::Nothing)?;
        Ok((first.0.address(), bytes))
    }

    pub(super) fn words(&self) -> String {
        let each: Vec<String> = self.0.iter().map(|(r, v)| format!("{r} = {v}")).collect();
        each.join(", ")
    }
}
