//! The debug hardware: what a probe sets over SWD, and what firmware can read and undo of it (ARMv7-M ARM C1; RM0090
//! 38.16). All of it outlives every reset but power-on. The cycle counter of the DWT is here too.

use super::{breakpoints::Breakpoints, reg};
use crate::core::exception::Exception;

const DHCSR_C_DEBUGEN: u32 = 1;
const DHCSR_S_REGRDY: u32 = 1 << 16;
const DEMCR_TRCENA: u32 = 1 << 24;
/// DEMCR.VC_CORERESET: the core halts at the reset vector.
pub const DEMCR_VC_CORERESET: u32 = 1;
/// DEMCR.VC_HARDERR: the core halts at HardFault.
pub const DEMCR_VC_HARDERR: u32 = 1 << 10;
/// All catch bits, VC_CORERESET to VC_HARDERR.
const DEMCR_VC_ALL: u32 = 0x7F1;
/// The catch bits of an exception. VC_INTERR, for faults of an exception's own entry, catches nothing here.
const CATCHES: [(Exception, u32); 4] = [
    (Exception::HARD_FAULT, DEMCR_VC_HARDERR),
    (Exception::MEM_MANAGE, 1 << 4),
    (Exception::BUS_FAULT, 1 << 8),
    (Exception::USAGE_FAULT, 0b111 << 5),
];
const DWT_CYCCNTENA: u32 = 1;
/// Four comparators (ARMv7-M ARM C1.8.7).
const DWT_NUMCOMP: u32 = 4 << 28;
/// STM32F405/407, revision 2 (RM0090 38.6.1).
const DBGMCU_IDCODE: u32 = 0x1007_6413;
/// DBG_IWDG_STOP of DBGMCU_APB1_FZ: the watchdog stands while the core is halted.
const APB1_FZ_IWDG: u32 = 1 << 12;

/// Past the last register of the flash patch and breakpoint unit.
const FPB_END: u32 = reg::FP_CTRL + 0x1000;

/// The debug registers of the core and of DBGMCU.
#[derive(Debug, Default)]
pub struct Debug {
    /// C_DEBUGEN: halts are possible. Only a probe writes it.
    enabled: bool,
    demcr: u32,
    /// A probe sets these bits of DEMCR again at once when they are cleared.
    kept_catches: u32,
    /// The comparators of the FPB.
    pub breakpoints: Breakpoints,
    counting: bool,
    /// CYCCNT while it stands still, else its value when it started.
    cyccnt: u32,
    started_at: u64,
    /// CR, APB1_FZ, APB2_FZ.
    dbgmcu: [u32; 3],
}

impl Debug {
    /// A probe takes hold of the core and sets catch bits of DEMCR.
    pub fn attach(&mut self, catches: u32) {
        self.enabled = true;
        self.demcr |= catches;
    }

    /// Sets catch bits that a probe sets again as soon as they are cleared.
    pub fn keep_catches_set(&mut self, catches: u32) {
        self.kept_catches = catches;
        self.demcr |= catches;
    }

    /// Stops the watchdogs while the core is halted, as OpenOCD's target script for this chip does.
    pub fn freeze_watchdogs(&mut self) {
        self.dbgmcu[1] |= APB1_FZ_IWDG | 1 << 11;
    }

    /// Whether a probe has enabled halting debug (DHCSR.C_DEBUGEN).
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// The core halts at the reset vector.
    pub fn catches_reset(&self) -> bool {
        self.enabled && self.demcr & DEMCR_VC_CORERESET != 0
    }

    /// The core halts before the first instruction of the handler.
    pub fn catches(&self, exception: Exception) -> bool {
        let caught = |(of, bits): &(Exception, u32)| *of == exception && self.demcr & bits != 0;
        self.enabled && CATCHES.iter().any(caught)
    }

    /// A hardware breakpoint lies in this code.
    pub fn breaks_in(&self, start: u32, end: u32) -> bool {
        self.enabled && self.breakpoints.any_in(start, end)
    }

    /// Whether the watchdog stands while the core is halted (DBG_IWDG_STOP).
    pub fn stops_watchdog(&self) -> bool {
        self.dbgmcu[1] & APB1_FZ_IWDG != 0
    }

    /// CYCCNT does not count while the core is halted.
    pub fn halted_for(&mut self, cycles: u64) {
        self.started_at += cycles;
    }

    pub(super) fn read(&self, register: u32, cycles: u64) -> Option<u32> {
        Some(match register {
            reg::DWT_CTRL => DWT_NUMCOMP | u32::from(self.counting),
            reg::DWT_CYCCNT => self.cyccnt(cycles),
            // FUNCTION 0 to 3: no watchpoint.
            reg::DWT_FUNCTION0 | reg::DWT_FUNCTION1 | reg::DWT_FUNCTION2 | reg::DWT_FUNCTION3 => 0,
            reg::DWT_LSR => 0, // LSR: unlocked
            reg::FP_CTRL..FPB_END => return self.breakpoints.read(register),
            // Code that reads the register is running, so the core is not halted.
            reg::DHCSR if self.enabled => DHCSR_S_REGRDY | DHCSR_C_DEBUGEN,
            reg::DHCSR => DHCSR_S_REGRDY,
            reg::DEMCR => self.demcr,
            reg::DBGMCU_IDCODE => DBGMCU_IDCODE,
            reg::DBGMCU_CR..=reg::DBGMCU_APB2_FZ => {
                self.dbgmcu[((register - reg::DBGMCU_CR) / 4) as usize]
            }
            _ => return None,
        })
    }

    pub(super) fn write(&mut self, register: u32, value: u32, cycles: u64) -> bool {
        match register {
            reg::DWT_CTRL => {
                self.cyccnt = self.cyccnt(cycles);
                self.started_at = cycles;
                self.counting = value & DWT_CYCCNTENA != 0;
            }
            reg::DWT_CYCCNT => {
                self.cyccnt = value;
                self.started_at = cycles;
            }
            reg::DWT_FUNCTION0 | reg::DWT_FUNCTION1 | reg::DWT_FUNCTION2 | reg::DWT_FUNCTION3 => {
                return value == 0;
            }
            reg::DWT_LAR => {} // LAR
            reg::FP_CTRL..FPB_END => return self.breakpoints.write(register, value),
            reg::DEMCR => self.demcr = value & (DEMCR_TRCENA | DEMCR_VC_ALL) | self.kept_catches,
            reg::DBGMCU_CR..=reg::DBGMCU_APB2_FZ => {
                self.dbgmcu[((register - reg::DBGMCU_CR) / 4) as usize] = value
            }
            _ => return false,
        }
        true
    }

    fn cyccnt(&self, cycles: u64) -> u32 {
        if self.counting && self.demcr & DEMCR_TRCENA != 0 {
            self.cyccnt.wrapping_add((cycles - self.started_at) as u32)
        } else {
            self.cyccnt
        }
    }
}
