//! The flash patch and breakpoint unit (ARMv7-M ARM C1.11): six comparators for code, two for literals.

use super::reg;

const COMPARATORS: usize = 8;
/// Only these compare instruction addresses.
const FOR_CODE: usize = 6;
/// FP_CTRL: their numbers, in NUM_LIT and NUM_CODE.
const CTRL_NUMBERS: u32 = 2 << 8 | 6 << 4;
const CTRL_KEY: u32 = 1 << 1;
const ENABLE: u32 = 1;
/// Bits 28 to 2 of the address.
const ADDRESS: u32 = 0x1FFF_FFFC;
/// REPLACE: a breakpoint on the lower or the upper half-word. Without either the comparator remaps.
const LOWER: u32 = 1 << 30;
const UPPER: u32 = 1 << 31;

#[derive(Debug, Default)]
pub struct Breakpoints {
    enabled: bool,
    comparators: [u32; COMPARATORS],
}

impl Breakpoints {
    /// Sets breakpoints as a debugger does, at up to six addresses.
    pub fn set(&mut self, addresses: &[u32]) {
        self.enabled = true;
        let places = self.comparators.iter_mut().take(FOR_CODE);
        for (place, address) in places.zip(addresses) {
            let half = if address & 2 == 0 { LOWER } else { UPPER };
            *place = address & ADDRESS | half | ENABLE;
        }
    }

    pub(super) fn any_in(&self, start: u32, end: u32) -> bool {
        let halves = [(LOWER, 0), (UPPER, 2)];
        let lies_in = |comparator: &u32| {
            let half = |(bit, offset)| {
                let address = (comparator & ADDRESS) + offset;
                comparator & bit != 0 && (start..end).contains(&address)
            };
            comparator & ENABLE != 0 && halves.into_iter().any(half)
        };
        self.enabled && self.comparators.iter().any(lies_in)
    }

    pub(super) fn read(&self, register: u32) -> Option<u32> {
        match register {
            reg::FP_CTRL => Some(CTRL_NUMBERS | u32::from(self.enabled)),
            _ => self.comparators.get(place(register)?).copied(),
        }
    }

    pub(super) fn write(&mut self, register: u32, value: u32) -> bool {
        if register == reg::FP_CTRL {
            if value & CTRL_KEY != 0 {
                self.enabled = value & ENABLE != 0;
            }
            return true;
        }
        // Patching flash is not modelled.
        let remaps = value & ENABLE != 0 && value & (LOWER | UPPER) == 0;
        match place(register).and_then(|place| self.comparators.get_mut(place)) {
            Some(comparator) if !remaps => {
                *comparator = value;
                true
            }
            _ => false,
        }
    }
}

fn place(register: u32) -> Option<usize> {
    let offset = register.checked_sub(reg::FP_COMP0)?;
    Some(offset as usize / 4)
}
