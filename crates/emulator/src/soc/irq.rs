//! Interrupt request lines from the peripherals to the NVIC.

/// Position in the vector table after the 16 system exceptions (RM0090 table 62).
pub type Irq = u8;

pub const IRQ_COUNT: usize = 82;

/// Level of each request line. The NVIC latches rising edges and checks the level again when a handler returns.
#[derive(Debug, Default)]
pub struct IrqLines {
    level: u128,
    risen: u128,
}

impl IrqLines {
    pub fn set(&mut self, irq: Irq, high: bool) {
        let bit = 1u128 << irq;
        if high {
            self.risen |= bit & !self.level;
            self.level |= bit;
        } else {
            self.level &= !bit;
        }
    }

    pub fn level(&self, irq: Irq) -> bool {
        self.level >> irq & 1 == 1
    }

    /// Lines that rose since the last call.
    pub fn take_risen(&mut self) -> u128 {
        std::mem::take(&mut self.risen)
    }
}
