//! ISER, ICER, ISPR, ICPR, IABR, IPR and STIR.

use super::{Surroundings, System, reg};
use crate::{core::exception::Exception, soc::access::Access};

/// Past the last of the active bits.
const NVIC_IABR_END: u32 = reg::NVIC_IABR0 + 0x80;

impl System {
    /// `register` from NVIC_ISER0 to NVIC_IPR59, word-aligned.
    pub(super) fn read_nvic(&self, register: u32) -> Option<u32> {
        let word = register >> 2 & 0x1F;
        Some(match register {
            reg::NVIC_ISER0..reg::NVIC_ISPR0 => self.nvic.enabled_word(word),
            reg::NVIC_ISPR0..reg::NVIC_IABR0 => self.nvic.pending_word(word),
            reg::NVIC_IABR0..NVIC_IABR_END => self.nvic.active_word(word),
            reg::NVIC_IPR0..=reg::NVIC_IPR59 => self.priorities(16 + (register - reg::NVIC_IPR0)),
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
            reg::NVIC_ISER0..reg::NVIC_ICER0 => self.nvic.enable_word(word, bits),
            reg::NVIC_ICER0..reg::NVIC_ISPR0 => self.nvic.disable_word(word, bits),
            reg::NVIC_ISPR0..reg::NVIC_ICPR0 => self.nvic.set_pending_word(word, bits),
            reg::NVIC_ICPR0..reg::NVIC_IABR0 => {
                self.nvic.clear_pending_word(word, bits, around.line_high)
            }
            reg::NVIC_IPR0..=reg::NVIC_IPR59 => {
                self.set_priorities(16 + (register - reg::NVIC_IPR0), access, value);
            }
            reg::STIR => {
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
