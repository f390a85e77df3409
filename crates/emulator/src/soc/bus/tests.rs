//! Register sequences of the reference manual, performed on the whole chip without its CPU.

mod clocks;
mod dma;
mod pins;
mod timers;
mod usart;

use super::Soc;
use crate::{
    soc::{guest_memory::GuestMemory, test_board::TestBoard},
    time::Ps,
};

const RCC: u32 = 0x4002_3800;
const AHB1ENR: u32 = RCC + 0x30;
const APB1ENR: u32 = RCC + 0x40;
const APB2ENR: u32 = RCC + 0x44;
const FLASH_ACR: u32 = 0x4002_3C00;
const PWR_CR: u32 = 0x4000_7000;

/// SRAM and CCM.
struct Ram {
    sram: Vec<u8>,
    ccm: Vec<u8>,
}

impl Ram {
    fn at(&mut self, addr: u32, len: usize) -> Option<&mut [u8]> {
        let (memory, base) = match addr {
            0x2000_0000..0x2002_0000 => (&mut self.sram, 0x2000_0000),
            0x1000_0000..0x1001_0000 => (&mut self.ccm, 0x1000_0000),
            _ => return None,
        };
        let first = (addr - base) as usize;
        memory.get_mut(first..first + len)
    }
}

impl GuestMemory for Ram {
    fn read(&mut self, addr: u32, out: &mut [u8]) -> bool {
        let found = self.at(addr, out.len());
        if let Some(bytes) = &found {
            out.copy_from_slice(bytes);
        }
        found.is_some()
    }

    fn write(&mut self, addr: u32, data: &[u8]) -> bool {
        let found = self.at(addr, data.len());
        if let Some(bytes) = found {
            bytes.copy_from_slice(data);
            return true;
        }
        false
    }
}

/// A board without a CPU: the test makes the accesses.
struct Bench {
    soc: Soc,
    ram: Ram,
    now: Ps,
}

impl Bench {
    fn new() -> Self {
        let ram = Ram {
            sram: vec![0; 0x2_0000],
            ccm: vec![0; 0x1_0000],
        };
        Self {
            soc: Soc::new(Box::new(TestBoard::default())),
            ram,
            now: 0,
        }
    }

    fn read(&mut self, addr: u32) -> u32 {
        self.soc.read(addr, 4, self.now, &mut self.ram).unwrap()
    }

    fn write(&mut self, addr: u32, value: u32) {
        self.soc
            .write(addr, 4, value, self.now, &mut self.ram)
            .unwrap();
    }

    fn set_bits(&mut self, addr: u32, bits: u32) {
        let old = self.read(addr);
        self.write(addr, old | bits);
    }

    fn run_until(&mut self, at: Ps) {
        self.now = at;
        self.soc.run_due(at, &mut self.ram).unwrap();
    }

    fn run_for(&mut self, duration: Ps) {
        self.run_until(self.now + duration);
    }

    /// A 12 MHz crystal, PLL and prescalers: 168, 42 and 84 MHz.
    fn clock_up(&mut self) {
        self.set_bits(RCC, 1 << 16);
        self.run_for(2 * crate::time::MS);
        self.write(RCC + 0x04, 6 | 168 << 6 | 1 << 22 | 7 << 24);
        self.set_bits(RCC, 1 << 24);
        self.run_for(crate::time::MS);
        self.write(FLASH_ACR, 5);
        self.write(RCC + 0x08, 0b10 | 0b101 << 10 | 0b100 << 13);
    }

    fn errors(&self) -> Vec<&str> {
        self.soc
            .errors
            .list()
            .iter()
            .map(|e| e.message.as_str())
            .collect()
    }

    fn has_error(&self, part: &str) -> bool {
        self.errors().iter().any(|message| message.contains(part))
    }
}
