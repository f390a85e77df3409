//! System control block and FPU control (ARMv7-M ARM B3.2).

use super::{CCR_DIV_0_TRP, CCR_UNALIGN_TRP, FPCCR_RESET, System};
use crate::{core::exception::Exception, soc::access::Access};

/// Cortex-M4 r0p1, as on the STM32F407.
const CPUID: u32 = 0x410F_C241;
const AIRCR_KEY: u32 = 0x05FA;
const AIRCR_KEY_READ: u32 = 0xFA05_0000;
const AIRCR_SYSRESETREQ: u32 = 1 << 2;
/// Eight MPU regions, none programmed.
const MPU_TYPE: u32 = 0x0000_0800;

/// Enable bits of SHCSR and the exceptions they enable.
const SHCSR_ENABLES: [(u32, Exception); 3] = [
    (1 << 16, Exception::MEM_MANAGE),
    (1 << 17, Exception::BUS_FAULT),
    (1 << 18, Exception::USAGE_FAULT),
];

impl System {
    pub(super) fn read_scb(&self, register: u32) -> Option<u32> {
        Some(match register {
            0xE000_ED00 => CPUID,
            0xE000_ED04 => self.icsr(),
            0xE000_ED08 => self.vtor,
            0xE000_ED0C => AIRCR_KEY_READ | u32::from(self.nvic.priority_group()) << 8,
            0xE000_ED10 => self.scr,
            0xE000_ED14 => self.ccr,
            0xE000_ED18..=0xE000_ED20 => self.priorities(4 + (register - 0xE000_ED18)),
            0xE000_ED24 => self.shcsr(),
            0xE000_ED28 => self.faults.cfsr,
            0xE000_ED2C => self.faults.hfsr,
            0xE000_ED30 => 0, // DFSR: no debugger
            0xE000_ED34 => 0, // MMFAR: no fault of ours has a valid address in it
            0xE000_ED38 => self.faults.bfar,
            0xE000_ED88 => self.cpacr,
            0xE000_ED90 => MPU_TYPE,
            0xE000_ED94 => 0, // MPU_CTRL
            0xE000_EF34 => self.fpccr,
            0xE000_EF3C => 0, // FPDSCR
            0xE000_EF40 => 0x1011_0021,
            0xE000_EF44 => 0x1100_0011,
            _ => return None,
        })
    }

    pub(super) fn write_scb(&mut self, register: u32, access: Access, value: u32) -> bool {
        match register {
            0xE000_ED04 => self.write_icsr(value),
            0xE000_ED08 => self.vtor = value & 0x3FFF_FF80,
            0xE000_ED0C if value >> 16 == AIRCR_KEY => {
                self.nvic.set_priority_group((value >> 8 & 7) as u8);
                self.reset_requested |= value & AIRCR_SYSRESETREQ != 0;
            }
            0xE000_ED0C => {} // without the key the write has no effect
            0xE000_ED10 => self.scr = access.written_over(self.scr, value) & 0x16,
            0xE000_ED14 => {
                let ccr = access.written_over(self.ccr, value);
                if ccr & (CCR_DIV_0_TRP | CCR_UNALIGN_TRP) != 0 {
                    return false;
                }
                self.ccr = ccr & 0x303;
            }
            0xE000_ED18..=0xE000_ED20 => {
                self.set_priorities(4 + (register - 0xE000_ED18), access, value)
            }
            0xE000_ED24 => {
                let enables = access.written_over(self.shcsr(), value);
                for (bit, exception) in SHCSR_ENABLES {
                    self.nvic.set_enabled(exception, enables & bit != 0);
                }
            }
            0xE000_ED28 => self.faults.cfsr &= !access.written_over(0, value),
            0xE000_ED2C => self.faults.hfsr &= !access.written_over(0, value),
            0xE000_ED30 => {}
            0xE000_ED88 => self.cpacr = access.written_over(self.cpacr, value) & 0x00F0_0000,
            0xE000_ED94 if value == 0 => {}
            // Other stacking modes than the default would need another frame logic.
            0xE000_EF34 => return value & FPCCR_RESET == FPCCR_RESET,
            0xE000_EF3C if value == 0 => {}
            _ => return false,
        }
        true
    }

    fn icsr(&self) -> u32 {
        u32::from(self.nvic.is_pending(Exception::NMI)) << 31
            | u32::from(self.nvic.is_pending(Exception::PEND_SV)) << 28
            | u32::from(self.nvic.is_pending(Exception::SYS_TICK)) << 26
            | u32::from(self.nvic.irq_pending()) << 22
            | self.nvic.vect_pending() << 12
            | u32::from(self.nvic.returns_to_base()) << 11
            | self.nvic.current().number()
    }

    fn write_icsr(&mut self, value: u32) {
        let sets = [
            (31, Exception::NMI),
            (28, Exception::PEND_SV),
            (26, Exception::SYS_TICK),
        ];
        for (bit, exception) in sets {
            if value >> bit & 1 == 1 {
                self.nvic.pend(exception);
            }
        }
        for (bit, exception) in [(27, Exception::PEND_SV), (25, Exception::SYS_TICK)] {
            if value >> bit & 1 == 1 {
                self.nvic.unpend(exception);
            }
        }
    }

    fn shcsr(&self) -> u32 {
        let enables = SHCSR_ENABLES
            .iter()
            .filter(|(_, e)| self.nvic.is_enabled(*e))
            .map(|(bit, _)| bit)
            .sum::<u32>();
        let active = [
            (0, Exception::MEM_MANAGE),
            (1, Exception::BUS_FAULT),
            (3, Exception::USAGE_FAULT),
            (7, Exception::SV_CALL),
            (10, Exception::PEND_SV),
            (11, Exception::SYS_TICK),
        ];
        active
            .iter()
            .map(|(bit, e)| u32::from(self.nvic.is_active(*e)) << bit)
            .sum::<u32>()
            | enables
    }
}
