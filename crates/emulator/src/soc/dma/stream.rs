//! One DMA stream: its registers, and the progress of its transfer (RM0090 10.3, 10.5.5–10.5.10).

use crate::soc::registers::registers;

registers! {
    CR = 0x00,
    NDTR = 0x04,
    PAR = 0x08,
    M0AR = 0x0C,
    M1AR = 0x10,
    FCR = 0x14,
}

pub const EN: u32 = 1;
pub const TEIE: u32 = 1 << 2;
pub const HTIE: u32 = 1 << 3;
pub const TCIE: u32 = 1 << 4;
const DMEIE: u32 = 1 << 1;
const PFCTRL: u32 = 1 << 5;
const DIR: u32 = 3 << 6;
const CIRC: u32 = 1 << 8;
const PINC: u32 = 1 << 9;
const MINC: u32 = 1 << 10;
const PINCOS: u32 = 1 << 15;
const DBM_CT: u32 = 3 << 18;
const PBURST: u32 = 3 << 21;
const INTERRUPT_ENABLES: u32 = DMEIE | TEIE | HTIE | TCIE;
const CR_BITS: u32 = 0x0FEF_FFFF;
const FCR_BITS: u32 = 0x87;
/// Direct mode off: through the FIFO.
const DMDIS: u32 = 1 << 2;
/// FIFO empty.
const FS_EMPTY: u32 = 0b100 << 3;

/// Status flags at their positions in a stream's group of LISR or HISR.
pub mod flag {
    pub const TEIF: u32 = 1 << 3;
    pub const HTIF: u32 = 1 << 4;
    pub const TCIF: u32 = 1 << 5;
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    PeripheralToMemory,
    MemoryToPeripheral,
}

/// One item to move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Item {
    pub direction: Direction,
    pub peripheral_addr: u32,
    pub memory_addr: u32,
    /// Size: 1, 2 or 4 bytes.
    pub size: u8,
}

#[derive(Clone, Copy, Debug)]
pub struct Stream {
    pub cr: u32,
    ndtr: u32,
    par: u32,
    m0ar: u32,
    m1ar: u32,
    fcr: u32,
    /// NDTR when the stream was enabled, restored by circular mode.
    reload: u32,
    pub flags: u32,
}

impl Default for Stream {
    fn default() -> Self {
        Self {
            cr: 0,
            ndtr: 0,
            par: 0,
            m0ar: 0,
            m1ar: 0,
            fcr: 1,
            reload: 0,
            flags: 0,
        }
    }
}

impl Stream {
    pub fn enabled(&self) -> bool {
        self.cr & EN != 0
    }

    pub fn channel(&self) -> u8 {
        (self.cr >> 25 & 7) as u8
    }

    /// PL, 3 is very high.
    pub fn priority(&self) -> u32 {
        self.cr >> 16 & 3
    }

    pub fn interrupts(&self) -> bool {
        let enabled = [(TEIE, flag::TEIF), (HTIE, flag::HTIF), (TCIE, flag::TCIF)];
        enabled
            .iter()
            .any(|(enable, flag)| self.cr & enable != 0 && self.flags & flag != 0)
    }

    pub fn register(&self, offset: u32) -> Option<u32> {
        Some(match offset {
            reg::CR => self.cr,
            reg::NDTR => self.ndtr,
            reg::PAR => self.par,
            reg::M0AR => self.m0ar,
            reg::M1AR => self.m1ar,
            reg::FCR => self.fcr | FS_EMPTY,
            _ => return None,
        })
    }

    /// Items still to be moved.
    pub fn items_left(&self) -> u32 {
        self.ndtr
    }

    /// Returns true if the write enabled the stream, or an error that names what is not modelled.
    pub fn set_register(&mut self, offset: u32, value: u32) -> Result<bool, &'static str> {
        match offset {
            reg::CR => return self.write_cr(value),
            // Locked while the stream runs.
            _ if self.enabled() => {}
            reg::NDTR => self.ndtr = value & 0xFFFF,
            reg::PAR => self.par = value,
            reg::M0AR => self.m0ar = value,
            reg::M1AR => self.m1ar = value,
            _ => self.fcr = value & FCR_BITS,
        }
        Ok(false)
    }

    fn write_cr(&mut self, value: u32) -> Result<bool, &'static str> {
        let value = value & CR_BITS;
        let (was_on, on) = (self.enabled(), value & EN != 0);
        if was_on {
            let open = INTERRUPT_ENABLES | EN;
            self.cr = self.cr & !open | value & open;
            if !on {
                // A stream stopped by software reports completion (RM0090 10.3.14).
                self.flags |= flag::TCIF;
            }
            return Ok(false);
        }
        self.cr = value;
        if on {
            self.check_modelled()?;
            self.reload = self.ndtr;
        }
        Ok(on)
    }

    fn check_modelled(&self) -> Result<(), &'static str> {
        let unusual = [
            (PFCTRL, "peripheral flow control"),
            (PINCOS, "PINCOS"),
            (DBM_CT, "double buffer mode"),
            (PBURST, "peripheral burst"),
        ];
        match unusual.iter().find(|(bit, _)| self.cr & bit != 0) {
            Some((_, what)) => Err(what),
            None if self.cr & DIR > 1 << 6 => Err("memory-to-memory transfer"),
            // The FIFO would keep items until its threshold is reached.
            None if self.fcr & DMDIS != 0 => Err("FIFO mode"),
            None => Ok(()),
        }
    }

    fn item_size(&self) -> u8 {
        1 << (self.cr >> 11 & 3).min(2)
    }

    /// The item that the next request moves. In direct mode MSIZE is ignored, and both sides use PSIZE (RM0090 10.3.12).
    pub fn next_item(&self) -> Item {
        let size = self.item_size();
        let done = (self.reload - self.ndtr) * u32::from(size);
        let step = |bit: u32| if self.cr & bit != 0 { done } else { 0 };
        Item {
            direction: if self.cr & DIR == 0 {
                Direction::PeripheralToMemory
            } else {
                Direction::MemoryToPeripheral
            },
            peripheral_addr: self.par.wrapping_add(step(PINC)),
            memory_addr: self.m0ar.wrapping_add(step(MINC)),
            size,
        }
    }

    /// Notes that one item was moved.
    pub fn item_done(&mut self) {
        self.ndtr -= 1;
        if self.ndtr == self.reload / 2 {
            self.flags |= flag::HTIF;
        }
        if self.ndtr == 0 {
            self.flags |= flag::TCIF;
            if self.cr & CIRC != 0 {
                self.ndtr = self.reload;
            } else {
                self.cr &= !EN;
            }
        }
    }

    /// Ends the transfer after a bus error.
    pub fn fail(&mut self) {
        self.flags |= flag::TEIF;
        self.cr &= !EN;
    }

    /// Whether the stream can serve a request.
    pub fn ready(&self) -> bool {
        self.enabled() && self.ndtr > 0
    }
}
