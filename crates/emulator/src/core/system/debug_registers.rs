//! DWT cycle counter, DEMCR and DBGMCU: what firmware uses of the debug hardware. No debugger is attached.

const DEMCR_TRCENA: u32 = 1 << 24;
const DWT_CYCCNTENA: u32 = 1;
/// Four comparators (ARMv7-M ARM C1.8.7).
const DWT_NUMCOMP: u32 = 4 << 28;
/// STM32F405/407, revision 2 (RM0090 38.6.1).
const DBGMCU_IDCODE: u32 = 0x1007_6413;

#[derive(Debug, Default)]
pub(super) struct Debug {
    demcr: u32,
    counting: bool,
    /// CYCCNT while it stands still, else its value when it started.
    cyccnt: u32,
    started_at: u64,
    dbgmcu: [u32; 3],
}

impl Debug {
    pub(super) fn read(&self, register: u32, cycles: u64) -> Option<u32> {
        Some(match register {
            0xE000_1000 => DWT_NUMCOMP | u32::from(self.counting),
            0xE000_1004 => self.cyccnt(cycles),
            0xE000_1FB4 => 0, // LSR: unlocked
            0xE000_EDF0 => 0, // DHCSR: C_DEBUGEN clear
            0xE000_EDFC => self.demcr,
            0xE004_2000 => DBGMCU_IDCODE,
            0xE004_2004..=0xE004_200C => self.dbgmcu[(register as usize - 0xE004_2004) / 4],
            _ => return None,
        })
    }

    pub(super) fn write(&mut self, register: u32, value: u32, cycles: u64) -> bool {
        match register {
            0xE000_1000 => {
                self.cyccnt = self.cyccnt(cycles);
                self.started_at = cycles;
                self.counting = value & DWT_CYCCNTENA != 0;
            }
            0xE000_1004 => {
                self.cyccnt = value;
                self.started_at = cycles;
            }
            0xE000_1FB0 => {} // LAR
            0xE000_EDFC => self.demcr = value & (DEMCR_TRCENA | 0x7F1),
            // Only what a debugger would see of a sleeping or stopped core.
            0xE004_2004..=0xE004_200C => self.dbgmcu[(register as usize - 0xE004_2004) / 4] = value,
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
