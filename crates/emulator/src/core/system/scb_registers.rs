//! System control block and FPU control (ARMv7-M ARM B3.2).

use super::{CCR_DIV_0_TRP, CCR_UNALIGN_TRP, FPCCR_RESET, System, reg};
use crate::{core::exception::Exception, soc::access::Access};

/// Cortex-M4 r0p1, as on the STM32F407.
const CPUID: u32 = 0x410F_C241;
const AIRCR_KEY: u32 = 0x05FA;
const AIRCR_KEY_READ: u32 = 0xFA05_0000;
const AIRCR_SYSRESETREQ: u32 = 1 << 2;
/// MPU_TYPE: eight regions.
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
            reg::CPUID => CPUID,
            reg::ICSR => self.icsr(),
            reg::VTOR => self.vtor,
            reg::AIRCR => AIRCR_KEY_READ | u32::from(self.nvic.priority_group()) << 8,
            reg::SCR => self.scr,
            reg::CCR => self.ccr,
            reg::SHPR1..=reg::SHPR3 => self.priorities(4 + (register - reg::SHPR1)),
            reg::SHCSR => self.shcsr(),
            reg::CFSR => self.faults.cfsr,
            reg::HFSR => self.faults.hfsr,
            reg::DFSR => 0,  // no debugger
            reg::MMFAR => 0, // no modelled fault sets a valid address
            reg::BFAR => self.faults.bfar,
            reg::CPACR => self.cpacr,
            reg::MPU_TYPE => MPU_TYPE,
            reg::MPU_CTRL => 0,
            reg::FPCCR => self.fpccr,
            reg::FPDSCR => 0,
            reg::MVFR0 => 0x1011_0021,
            reg::MVFR1 => 0x1100_0011,
            _ => return None,
        })
    }

    pub(super) fn write_scb(&mut self, register: u32, access: Access, value: u32) -> bool {
        match register {
            reg::ICSR => self.write_icsr(value),
            reg::VTOR => self.vtor = value & 0x3FFF_FF80,
            reg::AIRCR if value >> 16 == AIRCR_KEY => {
                self.nvic.set_priority_group((value >> 8 & 7) as u8);
                self.reset_requested |= value & AIRCR_SYSRESETREQ != 0;
            }
            reg::AIRCR => {} // without the key the write has no effect
            reg::SCR => self.scr = access.written_over(self.scr, value) & 0x16,
            reg::CCR => {
                let ccr = access.written_over(self.ccr, value);
                if ccr & (CCR_DIV_0_TRP | CCR_UNALIGN_TRP) != 0 {
                    return false;
                }
                self.ccr = ccr & 0x303;
            }
            reg::SHPR1..=reg::SHPR3 => {
                self.set_priorities(4 + (register - reg::SHPR1), access, value)
            }
            reg::SHCSR => {
                let enables = access.written_over(self.shcsr(), value);
                for (bit, exception) in SHCSR_ENABLES {
                    self.nvic.set_enabled(exception, enables & bit != 0);
                }
            }
            reg::CFSR => self.faults.cfsr &= !access.written_over(0, value),
            reg::HFSR => self.faults.hfsr &= !access.written_over(0, value),
            reg::DFSR => {}
            reg::CPACR => self.cpacr = access.written_over(self.cpacr, value) & 0x00F0_0000,
            reg::MPU_CTRL if value == 0 => {}
            // Stacking modes other than the default are not modelled.
            reg::FPCCR => return value & FPCCR_RESET == FPCCR_RESET,
            reg::FPDSCR if value == 0 => {}
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
