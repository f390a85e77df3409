//! ISER, ICER, ISPR, ICPR, IABR, IPR and STIR.

use super::{Surroundings, System};
use crate::{core::exception::Exception, soc::access::Access};

impl System {
    /// `register` between 0xE000_E100 and 0xE000_E4EF, word-aligned.
    pub(super) fn read_nvic(&self, register: u32) -> Option<u32> {
        let word = register >> 2 & 0x1F;
        Some(match register >> 7 & 0xF {
            0x2 | 0x3 => self.nvic.enabled_word(word),
            0x4 | 0x5 => self.nvic.pending_word(word),
            0x6 => self.nvic.active_word(word),
            0x8 | 0x9 => self.priorities(16 + (register - 0xE000_E400)),
            _ => return None,
        })
    }

    pub(super) fn write_nvic(
        &mut self,
        register: u32,
        access: Access,
        value: u32,
        around: &Surroundings<'_>,
    ) -> bool {
        let word = register >> 2 & 0x1F;
        let bits = access.written_over(0, value);
        match register {
            0xE000_E100..=0xE000_E17C => self.nvic.enable_word(word, bits),
            0xE000_E180..=0xE000_E1FC => self.nvic.disable_word(word, bits),
            0xE000_E200..=0xE000_E27C => self.nvic.set_pending_word(word, bits),
            0xE000_E280..=0xE000_E2FC => self.nvic.clear_pending_word(word, bits, around.line_high),
            0xE000_E400..=0xE000_E4EF => {
                self.set_priorities(16 + (register - 0xE000_E400), access, value);
            }
            0xE000_EF00 => {
                let irq = value & 0x1FF;
                self.nvic.set_pending_word(irq >> 5, 1 << (irq & 31));
            }
            _ => return false,
        }
        true
    }

    /// The priority bytes of exceptions `first` … `first` + 3.
    pub(super) fn priorities(&self, first: u32) -> u32 {
        let byte =
            |i| Exception::from_number(first + i).map_or(0, |e| self.nvic.priority_register(e));
        u32::from_le_bytes([byte(0), byte(1), byte(2), byte(3)])
    }

    pub(super) fn set_priorities(&mut self, first: u32, access: Access, value: u32) {
        let bytes = access
            .written_over(self.priorities(first), value)
            .to_le_bytes();
        for (i, byte) in (first..).zip(bytes) {
            if let Some(exception) = Exception::from_number(i) {
                self.nvic.set_priority_register(exception, byte);
            }
        }
    }
}
