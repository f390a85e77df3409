//! Static cycle estimate of a block of Thumb code.
//!
//! Figures from the Cortex-M4 technical reference manual (table 3-1, and 7-1 for the FPU), flash counted as a hit in
//! the ART cache: one cycle an instruction; single loads two, one when they follow another load; stores one (write
//! buffer); multiple transfers 1 + registers; taken branches three (two for conditional ones, which half the time are
//! not taken); SDIV/UDIV seven (2 to 12); VDIV and VSQRT 14; VMLA and VFMA three.

/// Cost of one run through a block, and effects of it that the engine does not report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockCost {
    /// Instructions that the core issues, those of a failed IT condition included.
    pub instructions: u16,
    /// Core cycles that they take with no wait state.
    pub cycles: u16,
    /// Whether the block contains a SEV.
    pub sends_event: bool,
    /// Whether the block contains a floating-point instruction.
    pub uses_fpu: bool,
}

const TAKEN_BRANCH: u16 = 3;
const CONDITIONAL_BRANCH: u16 = 2;
const PIPELINE_REFILL: u16 = 2;
const DIVIDE: u16 = 7;
const FP_DIVIDE: u16 = 14;
const FP_MULTIPLY_ADD: u16 = 3;

enum Kind {
    Plain(u16),
    /// A single load, which pipelines with the one before it.
    Load,
    Event,
    Fpu(u16),
}

/// Computes the cost of `code`, the bytes of one straight run of instructions.
pub fn block_cost(code: &[u8]) -> BlockCost {
    let mut cost = BlockCost::default();
    let mut after_load = false;
    let mut halfwords = code
        .chunks_exact(2)
        .map(|b| u16::from_le_bytes([b[0], b[1]]));
    while let Some(first) = halfwords.next() {
        let kind = match first >> 11 {
            0b11101..=0b11111 => wide(first, halfwords.next().unwrap_or(0)),
            _ => narrow(first),
        };
        cost.instructions += 1;
        cost.cycles += match kind {
            Kind::Plain(cycles) | Kind::Fpu(cycles) => cycles,
            Kind::Load if after_load => 1,
            Kind::Load => 2,
            Kind::Event => 1,
        };
        cost.sends_event |= matches!(kind, Kind::Event);
        cost.uses_fpu |= matches!(kind, Kind::Fpu(_));
        after_load = matches!(kind, Kind::Load);
    }
    cost
}

fn registers(list: u16) -> u16 {
    list.count_ones() as u16
}

/// 16-bit encodings (ARMv7-M ARM A5.2).
fn narrow(op: u16) -> Kind {
    match op >> 12 {
        0x4 if op & 0xFF00 == 0x4700 => Kind::Plain(TAKEN_BRANCH),
        0x4 if op & 0xFC87 == 0x4487 => Kind::Plain(TAKEN_BRANCH),
        0x4 if op >> 11 == 0b01001 => Kind::Load,
        0x5 if op >> 9 & 7 >= 3 => Kind::Load,
        0x6..=0x9 if op >> 11 & 1 == 1 => Kind::Load,
        0xB => miscellaneous(op),
        0xC => Kind::Plain(1 + registers(op & 0xFF)),
        0xD if op >> 8 & 0xF < 0xE => Kind::Plain(CONDITIONAL_BRANCH),
        0xE => Kind::Plain(TAKEN_BRANCH),
        _ => Kind::Plain(1),
    }
}

fn miscellaneous(op: u16) -> Kind {
    const SEV: u16 = 0xBF40;
    match op {
        SEV => Kind::Event,
        // PUSH, POP (bit 8: LR or PC)
        _ if op & 0xFE00 == 0xB400 => Kind::Plain(1 + registers(op & 0x1FF)),
        _ if op & 0xFE00 == 0xBC00 => {
            let refill = if op & 0x100 != 0 { PIPELINE_REFILL } else { 0 };
            Kind::Plain(1 + registers(op & 0x1FF) + refill)
        }
        // CBZ, CBNZ
        _ if op & 0xF500 == 0xB100 => Kind::Plain(CONDITIONAL_BRANCH),
        _ => Kind::Plain(1),
    }
}

/// 32-bit encodings (ARMv7-M ARM A5.3).
fn wide(first: u16, second: u16) -> Kind {
    if first & 0xEC00 == 0xEC00 {
        return coprocessor(first, second);
    }
    match first >> 11 & 3 {
        1 => multiple_or_shifted(first, second),
        2 if second >> 15 == 1 => branch_or_control(first, second),
        3 => single_or_multiply(first, second),
        _ => Kind::Plain(1),
    }
}

fn multiple_or_shifted(first: u16, second: u16) -> Kind {
    let op = first >> 4 & 0x7F;
    if op & 0x64 == 0x00 {
        let loads_pc = op & 1 == 1 && second >> 15 == 1;
        return Kind::Plain(1 + registers(second) + if loads_pc { PIPELINE_REFILL } else { 0 });
    }
    if op & 0x64 == 0x04 {
        let table_branch = first & 0xFFF0 == 0xE8D0 && second & 0xFFE0 == 0xF000;
        let exclusive = op & 0x12 == 0;
        return Kind::Plain(if table_branch {
            2 + PIPELINE_REFILL
        } else if exclusive {
            2
        } else {
            3
        });
    }
    Kind::Plain(1)
}

fn branch_or_control(first: u16, second: u16) -> Kind {
    const SEV_W: (u16, u16) = (0xF3AF, 0x8004);
    if (first, second) == SEV_W {
        return Kind::Event;
    }
    match second & 0xD000 {
        0xD000 | 0x9000 => Kind::Plain(TAKEN_BRANCH),
        0x8000 if first & 0x0380 != 0x0380 => Kind::Plain(CONDITIONAL_BRANCH),
        // MSR, MRS, barriers and hints
        _ => Kind::Plain(2),
    }
}

fn single_or_multiply(first: u16, second: u16) -> Kind {
    let op = first >> 4 & 0x7F;
    match op {
        _ if op & 0x67 == 0x05 && second >> 12 == 15 => Kind::Plain(2 + PIPELINE_REFILL),
        _ if op & 0x60 == 0 && op & 1 == 1 => Kind::Load,
        0x39 | 0x3B => Kind::Plain(DIVIDE),
        _ => Kind::Plain(1),
    }
}

/// Coprocessors 10 and 11 are the FPU (ARMv7-M ARM A6).
fn coprocessor(first: u16, second: u16) -> Kind {
    if second & 0x0E00 != 0x0A00 {
        return Kind::Plain(1);
    }
    let double = second >> 8 & 1 == 1;
    if first & 0xFE00 == 0xEC00 {
        let words = second & 0xFF;
        return Kind::Fpu(match first & 0x01E0 {
            // VMOV between two core registers and the FPU
            0x0040 => 2,
            // VLDR, VSTR: offset addressing without write-back
            _ if first & 0x0120 == 0x0100 => {
                if double {
                    3
                } else {
                    2
                }
            }
            _ => 1 + words,
        });
    }
    if second & 0x10 != 0 {
        return Kind::Fpu(1);
    }
    Kind::Fpu(match first >> 4 & 0xB {
        0x0 | 0x1 | 0x9 | 0xA => FP_MULTIPLY_ADD,
        0x8 => FP_DIVIDE,
        0xB if first & 0xF == 1 && second & 0xC0 == 0xC0 => FP_DIVIDE,
        _ => 1,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(halfwords: &[u16]) -> (u16, u16) {
        let bytes: Vec<u8> = halfwords.iter().flat_map(|h| h.to_le_bytes()).collect();
        let cost = block_cost(&bytes);
        (cost.instructions, cost.cycles)
    }

    /// Encodings from llvm-mc, cycles from the technical reference manual.
    #[test]
    fn single_instructions_cost_what_the_manual_says() {
        assert_eq!(cost(&[0x3001]), (1, 1), "adds r0, #1");
        assert_eq!(cost(&[0x6808]), (1, 2), "ldr r0, [r1]");
        assert_eq!(
            cost(&[0x6808, 0x684A]),
            (2, 3),
            "ldr r0, [r1]; ldr r2, [r1, #4]"
        );
        assert_eq!(cost(&[0x6008]), (1, 1), "str r0, [r1]");
        assert_eq!(cost(&[0xB5F0]), (1, 6), "push {{r4-r7, lr}}: 1 + 5");
        assert_eq!(cost(&[0xBDF0]), (1, 8), "pop {{r4-r7, pc}}: 1 + 5 + refill");
        assert_eq!(cost(&[0xFB90, 0xF0F1]), (1, 7), "sdiv r0, r0, r1");
        assert_eq!(cost(&[0xEE80, 0x0A20]), (1, 14), "vdiv.f32 s0, s0, s1");
        assert_eq!(cost(&[0xEEB1, 0x0AE0]), (1, 14), "vsqrt.f32 s0, s1");
        assert_eq!(cost(&[0xEEA0, 0x1A20]), (1, 3), "vfma.f32 s2, s0, s1");
        assert_eq!(cost(&[0xEE30, 0x0A20]), (1, 1), "vadd.f32 s0, s0, s1");
        assert_eq!(cost(&[0xF000, 0xF800]), (1, 3), "bl");
    }
}
