//! Accesses that must be word-aligned whatever CCR says: LDM, STM, LDRD, STRD, VLDR, VSTR and their kind (ARMv7-M ARM
//! A3.2.1). The engine carries them out at any address.
//!
//! The two lowest bits of each base register are tracked through the block. Where they cannot be tracked, the register is
//! checked after the block, provided that it has not changed since the access.

/// Registers that must hold aligned addresses in one run through a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WordAccesses {
    /// Bit 4·r + n: register r plus n must be a multiple of four before the block.
    pub before: u64,
    /// Bit r: register r must be a multiple of four after it.
    pub after: u16,
    /// One access goes to a constant address that is not word-aligned.
    pub wrong: bool,
}

/// Registers that are checked: R0 to R12. Stack pointer and PC are always aligned, and a call changes LR.
const LOOKED_AT: std::ops::Range<usize> = 0..13;
const SP: usize = 13;
const PC: usize = 15;

/// The two lowest bits of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LowBits {
    /// The bits of this register before the block, plus a constant.
    Start {
        register: usize,
        plus: u32,
    },
    Known(u32),
    Lost,
}

impl LowBits {
    fn plus(self, more: u32) -> Self {
        match self {
            Self::Start { register, plus } => Self::Start {
                register,
                plus: plus.wrapping_add(more) & 3,
            },
            Self::Known(low) => Self::Known(low.wrapping_add(more) & 3),
            Self::Lost => Self::Lost,
        }
    }
}

/// Finds the accesses of `code`, the bytes of one straight run of instructions.
pub fn word_accesses(code: &[u8]) -> WordAccesses {
    let mut block = Block::default();
    let mut halves = code.as_chunks().0.iter().copied().map(u16::from_le_bytes);
    while let Some(half) = halves.next() {
        block.may_be_skipped = block.conditional > 0;
        block.conditional = block.conditional.saturating_sub(1);
        if half & 0xFF00 == 0xBF00 && half & 0x000F != 0 {
            // IT: the lowest 1 of the mask ends it.
            block.conditional = 4 - (half & 0x000F).trailing_zeros();
        } else if half >= 0xE800 {
            block.wide(half.into(), halves.next().unwrap_or(0).into());
        } else {
            block.narrow(half.into());
        }
    }
    block.accesses
}

struct Block {
    registers: [LowBits; 16],
    /// Instructions left in an IT block.
    conditional: u32,
    may_be_skipped: bool,
    accesses: WordAccesses,
}

impl Default for Block {
    fn default() -> Self {
        let mut registers = std::array::from_fn(|register| LowBits::Start { register, plus: 0 });
        registers[SP] = LowBits::Known(0);
        // ADR uses the PC rounded down to a word.
        registers[PC] = LowBits::Known(0);
        Self {
            registers,
            conditional: 0,
            may_be_skipped: false,
            accesses: WordAccesses::default(),
        }
    }
}

impl Block {
    fn get(&self, register: u32) -> LowBits {
        self.registers[register as usize & 15]
    }

    fn set(&mut self, register: u32, low: LowBits) {
        let register = register as usize & 15;
        if LOOKED_AT.contains(&register) {
            self.registers[register] = if self.may_be_skipped {
                LowBits::Lost
            } else {
                low
            };
            self.accesses.after &= !(1 << register);
        }
    }

    fn lose(&mut self, register: u32) {
        self.set(register, LowBits::Lost);
    }

    fn lose_all(&mut self, list: u32) {
        for register in (0..16).filter(|r| list >> r & 1 == 1) {
            self.lose(register);
        }
    }

    /// Ignores a conditional access, which may not take place.
    fn access(&mut self, base: u32) {
        let register = base as usize & 15;
        if self.may_be_skipped || !LOOKED_AT.contains(&register) {
            return;
        }
        match self.registers[register] {
            LowBits::Start { register, plus } if LOOKED_AT.contains(&register) => {
                self.accesses.before |= 1 << (4 * register as u32 + plus);
            }
            LowBits::Start { .. } => {}
            LowBits::Known(low) => self.accesses.wrong |= low != 0,
            LowBits::Lost => self.accesses.after |= 1 << register,
        }
    }

    /// 16-bit encodings (ARMv7-M ARM A5.2).
    fn narrow(&mut self, op: u32) {
        let (rd, rn, upper) = (op & 7, op >> 3 & 7, op >> 8 & 7);
        let imm8 = op & 0xFF;
        match op >> 11 {
            // MOVS between registers is encoded as a shift by 0.
            0b00000 if op >> 6 & 0x1F == 0 => self.set(rd, self.get(rn)),
            0b00011 if op >> 9 & 3 == 2 => self.set(rd, self.get(rn).plus(op >> 6 & 7)),
            0b00011 if op >> 9 & 3 == 3 => {
                self.set(rd, self.get(rn).plus((op >> 6 & 7).wrapping_neg()));
            }
            0b00000..=0b00011 => self.lose(rd),
            0b00100 => self.set(upper, LowBits::Known(imm8 & 3)),
            0b00110 => self.set(upper, self.get(upper).plus(imm8)),
            0b00111 => self.set(upper, self.get(upper).plus(imm8.wrapping_neg())),
            0b01000 => self.data_processing(op),
            0b01001 | 0b10011 => self.lose(upper),
            0b01010 | 0b01011 if op >> 9 & 7 >= 3 => self.lose(rd),
            0b01101 | 0b01111 | 0b10001 => self.lose(rd),
            // ADR, and an address on the stack.
            0b10100 | 0b10101 => self.set(upper, LowBits::Known(0)),
            0b10110 | 0b10111 => match op >> 8 {
                0xB2 | 0xBA => self.lose(rd),
                0xBC | 0xBD => self.lose_all(imm8),
                _ => {}
            },
            0b11000 => self.access(upper),
            0b11001 => {
                self.access(upper);
                self.lose_all(imm8);
            }
            _ => {}
        }
    }

    /// Data processing on two registers, and the instructions that reach the high ones.
    fn data_processing(&mut self, op: u32) {
        let (high_rd, rm) = (op >> 4 & 8 | op & 7, op >> 3 & 15);
        match op >> 8 {
            0x44 => self.lose(high_rd),
            0x46 => self.set(high_rd, self.get(rm)),
            0x45 | 0x47 => {}
            // TST, CMP and CMN write no register.
            _ if matches!(op >> 6 & 15, 8 | 10 | 11) => {}
            _ => self.lose(op & 7),
        }
    }

    /// 32-bit encodings (ARMv7-M ARM A5.3).
    fn wide(&mut self, first: u32, second: u32) {
        let (rn, rt, rd) = (first & 15, second >> 12 & 15, second >> 8 & 15);
        if first & 0xEC00 == 0xEC00 {
            return self.coprocessor(first, second);
        }
        let op = first >> 4 & 0x7F;
        let loads = op & 1 == 1;
        match first >> 11 & 3 {
            1 if op & 0x64 == 0x00 => {
                self.access(rn);
                if loads {
                    self.lose_all(second);
                }
            }
            1 if op & 0x64 == 0x04 && op & 0x12 == 0 => {
                // The engine checks the alignment of exclusives and table branches.
                self.lose_all(1 << rt | 1 << rd | 1 << (second & 15));
            }
            1 if op & 0x64 == 0x04 => {
                self.access(rn);
                if loads {
                    self.lose_all(1 << rt | 1 << rd);
                }
            }
            1 => self.lose(rd),
            2 if second >> 15 == 1 => {
                // MRS writes a register; branches and other control instructions do not.
                if first & 0xFFE0 == 0xF3E0 && second & 0xD000 == 0x8000 {
                    self.lose(rd);
                }
            }
            2 => self.immediate(first, second),
            _ if op & 0x60 == 0x00 => {
                if loads {
                    self.lose(rt);
                }
                // Write-back, by any number of bytes.
                if first >> 7 & 1 == 0 && second >> 11 & 1 == 1 && second >> 8 & 1 == 1 {
                    self.lose(rn);
                }
            }
            _ => {
                self.lose(rd);
                if op & 0x78 == 0x38 {
                    // The upper half of a long product.
                    self.lose(rt);
                }
            }
        }
    }

    fn immediate(&mut self, first: u32, second: u32) {
        let (rn, rd) = (first & 15, second >> 8 & 15);
        let imm12 = (first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xFF;
        let before = self.get(rn);
        let plain = first >> 9 & 1 == 1;
        let low = if plain {
            match first >> 4 & 0x1F {
                0x00 => before.plus(imm12),
                0x0A => before.plus(imm12.wrapping_neg()),
                0x04 => LowBits::Known(imm12 & 3),
                // MOVT leaves the lower half.
                0x0C => self.get(rd),
                _ => LowBits::Lost,
            }
        } else {
            let low = expanded(imm12) & 3;
            match (first >> 5 & 15, low) {
                (0, 0) | (1, 3) => LowBits::Known(0),
                (0, 3) | (1 | 2, 0) if rn != 15 => before,
                // MOV, and a bit set for sure.
                (2, _) => LowBits::Known(low),
                (8, _) => before.plus(low),
                (13, _) => before.plus(low.wrapping_neg()),
                _ => LowBits::Lost,
            }
        };
        self.set(rd, low);
    }

    /// The FPU (ARMv7-M ARM A6).
    fn coprocessor(&mut self, first: u32, second: u32) {
        let (rn, rt) = (first & 15, second >> 12 & 15);
        let to_core = first >> 4 & 1 == 1;
        if first & 0xFE00 == 0xEC00 {
            if first & 0x01E0 != 0x0040 {
                self.access(rn);
            } else if to_core {
                self.lose_all(1 << rn | 1 << rt);
            }
        } else if first & 0xFF00 == 0xEE00 && second >> 4 & 1 == 1 && to_core {
            self.lose(rt);
        }
    }
}

/// `ThumbExpandImm` (ARMv7-M ARM A5.3.2).
fn expanded(imm12: u32) -> u32 {
    let byte = imm12 & 0xFF;
    match imm12 >> 8 {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte << 24 | byte << 16 | byte << 8 | byte,
        _ => (byte | 0x80).rotate_right(imm12 >> 7),
    }
}

#[cfg(test)]
mod tests;
