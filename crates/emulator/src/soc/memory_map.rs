//! Which register block answers at an address, and which RCC bits clock and reset it (RM0090 table 1, 7.3).

/// A register block of the chip that is modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// 2, 3, 4, 5 or 10.
    Timer(u8),
    /// 1, 3 or 6.
    Usart(u8),
    Spi1,
    I2c3,
    /// CAN1 at offset 0, CAN2 at 0x400.
    Can,
    Pwr,
    Iwdg,
    /// ADC1–3 at 0, 0x100, 0x200 and the common registers at 0x300.
    Adc,
    Syscfg,
    Exti,
    /// Port A = 0 … I = 8.
    Gpio(u8),
    Rcc,
    Flash,
    Dma(u8),
}

impl Block {
    pub const ALL: [Self; 29] = [
        Self::Rcc,
        Self::Pwr,
        Self::Flash,
        Self::Gpio(0),
        Self::Gpio(1),
        Self::Gpio(2),
        Self::Gpio(3),
        Self::Gpio(4),
        Self::Gpio(5),
        Self::Gpio(6),
        Self::Gpio(7),
        Self::Gpio(8),
        Self::Syscfg,
        Self::Exti,
        Self::Dma(1),
        Self::Dma(2),
        Self::Timer(2),
        Self::Timer(3),
        Self::Timer(4),
        Self::Timer(5),
        Self::Timer(10),
        Self::Usart(1),
        Self::Usart(3),
        Self::Usart(6),
        Self::Spi1,
        Self::I2c3,
        Self::Can,
        Self::Adc,
        Self::Iwdg,
    ];
}

/// The four enable (and reset) registers of RCC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bus {
    Ahb1,
    Apb1,
    Apb2,
}

/// A clock-enable bit. The reset bit has the same position in the reset register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockGate {
    pub bus: Bus,
    pub bit: u8,
    /// Name of the bit, such as `"APB1ENR.USART3EN"`.
    pub name: &'static str,
}

impl ClockGate {
    /// The peripheral that it clocks, such as `"USART3"`.
    pub fn peripheral(&self) -> &'static str {
        let bit = self.name.rsplit('.').next().unwrap_or(self.name);
        bit.strip_suffix("EN").unwrap_or(bit)
    }
}

/// The block at `addr` and the offset in it.
pub fn locate(addr: u32) -> Option<(Block, u32)> {
    let (block, size) = match addr & !0x3FF {
        0x4000_0000 => (Block::Timer(2), 0x400),
        0x4000_0400 => (Block::Timer(3), 0x400),
        0x4000_0800 => (Block::Timer(4), 0x400),
        0x4000_0C00 => (Block::Timer(5), 0x400),
        0x4000_3000 => (Block::Iwdg, 0x400),
        0x4000_4800 => (Block::Usart(3), 0x400),
        0x4000_5C00 => (Block::I2c3, 0x400),
        0x4000_6400 | 0x4000_6800 => (Block::Can, 0x800),
        0x4000_7000 => (Block::Pwr, 0x400),
        0x4001_1000 => (Block::Usart(1), 0x400),
        0x4001_1400 => (Block::Usart(6), 0x400),
        0x4001_2000 => (Block::Adc, 0x400),
        0x4001_3000 => (Block::Spi1, 0x400),
        0x4001_3800 => (Block::Syscfg, 0x400),
        0x4001_3C00 => (Block::Exti, 0x400),
        0x4001_4400 => (Block::Timer(10), 0x400),
        base @ 0x4002_0000..=0x4002_2000 => {
            (Block::Gpio(((base - 0x4002_0000) >> 10) as u8), 0x400)
        }
        0x4002_3800 => (Block::Rcc, 0x400),
        0x4002_3C00 => (Block::Flash, 0x400),
        0x4002_6000 => (Block::Dma(1), 0x400),
        0x4002_6400 => (Block::Dma(2), 0x400),
        _ => return None,
    };
    let base = if block == Block::Can {
        0x4000_6400
    } else {
        addr & !(size - 1)
    };
    Some((block, addr - base))
}

/// The clock gate of the registers at `offset` of `block`; `None` if the block is always clocked.
pub fn clock_gate(block: Block, offset: u32) -> Option<ClockGate> {
    let (bus, bit, name) = match block {
        Block::Timer(2) => (Bus::Apb1, 0, "APB1ENR.TIM2EN"),
        Block::Timer(3) => (Bus::Apb1, 1, "APB1ENR.TIM3EN"),
        Block::Timer(4) => (Bus::Apb1, 2, "APB1ENR.TIM4EN"),
        Block::Timer(5) => (Bus::Apb1, 3, "APB1ENR.TIM5EN"),
        Block::Timer(_) => (Bus::Apb2, 17, "APB2ENR.TIM10EN"),
        Block::Usart(3) => (Bus::Apb1, 18, "APB1ENR.USART3EN"),
        Block::Usart(1) => (Bus::Apb2, 4, "APB2ENR.USART1EN"),
        Block::Usart(_) => (Bus::Apb2, 5, "APB2ENR.USART6EN"),
        Block::Spi1 => (Bus::Apb2, 12, "APB2ENR.SPI1EN"),
        Block::I2c3 => (Bus::Apb1, 23, "APB1ENR.I2C3EN"),
        Block::Can if offset < 0x400 => (Bus::Apb1, 25, "APB1ENR.CAN1EN"),
        Block::Can => (Bus::Apb1, 26, "APB1ENR.CAN2EN"),
        Block::Pwr => (Bus::Apb1, 28, "APB1ENR.PWREN"),
        Block::Adc => match offset {
            0..0x100 => (Bus::Apb2, 8, "APB2ENR.ADC1EN"),
            0x100..0x200 => (Bus::Apb2, 9, "APB2ENR.ADC2EN"),
            _ => (Bus::Apb2, 10, "APB2ENR.ADC3EN"),
        },
        Block::Syscfg => (Bus::Apb2, 14, "APB2ENR.SYSCFGEN"),
        Block::Gpio(port) => (
            Bus::Ahb1,
            port,
            GPIO_ENABLES.get(usize::from(port)).copied()?,
        ),
        Block::Dma(1) => (Bus::Ahb1, 21, "AHB1ENR.DMA1EN"),
        Block::Dma(_) => (Bus::Ahb1, 22, "AHB1ENR.DMA2EN"),
        Block::Rcc | Block::Flash | Block::Exti | Block::Iwdg => return None,
    };
    Some(ClockGate { bus, bit, name })
}

const GPIO_ENABLES: [&str; 9] = [
    "AHB1ENR.GPIOAEN",
    "AHB1ENR.GPIOBEN",
    "AHB1ENR.GPIOCEN",
    "AHB1ENR.GPIODEN",
    "AHB1ENR.GPIOEEN",
    "AHB1ENR.GPIOFEN",
    "AHB1ENR.GPIOGEN",
    "AHB1ENR.GPIOHEN",
    "AHB1ENR.GPIOIEN",
];

/// The RCC reset bit of the registers at `offset` of `block`; `None` if only a system reset resets them.
pub fn reset_bit(block: Block, offset: u32) -> Option<(Bus, u8)> {
    match block {
        // One bit for the three converters (RM0090 7.3.9).
        Block::Adc => Some((Bus::Apb2, 8)),
        _ => clock_gate(block, offset).map(|gate| (gate.bus, gate.bit)),
    }
}

/// RCC reset bits of CAN1 and CAN2, which share one block in the model.
pub const CAN_RESETS: [(Bus, u8); 2] = [(Bus::Apb1, 25), (Bus::Apb1, 26)];

/// Name of an address outside the modelled blocks.
pub fn unmodelled_name(addr: u32) -> String {
    UNMODELLED
        .iter()
        .find(|(base, size, _)| (*base..base + size).contains(&addr))
        .map_or_else(
            || format!("{addr:#010x}"),
            |(base, _, name)| format!("{name}+{:#x}", addr - base),
        )
}

/// Blocks of the chip that the board does not use, by address and size.
const UNMODELLED: [(u32, u32, &str); 33] = [
    (0x4000_1000, 0x400, "TIM6"),
    (0x4000_1400, 0x400, "TIM7"),
    (0x4000_1800, 0x400, "TIM12"),
    (0x4000_1C00, 0x400, "TIM13"),
    (0x4000_2000, 0x400, "TIM14"),
    (0x4000_2800, 0x400, "RTC"),
    (0x4000_2C00, 0x400, "WWDG"),
    (0x4000_3800, 0x400, "SPI2"),
    (0x4000_3C00, 0x400, "SPI3"),
    (0x4000_4400, 0x400, "USART2"),
    (0x4000_4C00, 0x400, "UART4"),
    (0x4000_5000, 0x400, "UART5"),
    (0x4000_5400, 0x400, "I2C1"),
    (0x4000_5800, 0x400, "I2C2"),
    (0x4000_7400, 0x400, "DAC"),
    (0x4001_0000, 0x400, "TIM1"),
    (0x4001_0400, 0x400, "TIM8"),
    (0x4001_2C00, 0x400, "SDIO"),
    (0x4001_4000, 0x400, "TIM9"),
    (0x4001_4800, 0x400, "TIM11"),
    (0x4002_3000, 0x400, "CRC"),
    (0x4002_4000, 0x1000, "BKPSRAM"),
    (0x4002_8000, 0x1400, "ETH"),
    (0x4004_0000, 0x4_0000, "USB_OTG_HS"),
    (0x5000_0000, 0x4_0000, "USB_OTG_FS"),
    (0x5005_0000, 0x400, "DCMI"),
    (0x5006_0000, 0x400, "CRYP"),
    (0x5006_0400, 0x400, "HASH"),
    (0x5006_0800, 0x400, "RNG"),
    (0xA000_0000, 0x1000, "FSMC"),
    (0x4000_3400, 0x400, "I2S2ext"),
    (0x4000_4000, 0x400, "I2S3ext"),
    (0x4000_6000, 0x400, "reserved 0x40006000"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_of_the_memory_map_find_their_blocks() {
        // RM0090 table 1.
        assert_eq!(locate(0x4000_0024), Some((Block::Timer(2), 0x24)));
        assert_eq!(locate(0x4000_4804), Some((Block::Usart(3), 0x04)));
        assert_eq!(locate(0x4000_6618), Some((Block::Can, 0x218)));
        assert_eq!(locate(0x4000_681C), Some((Block::Can, 0x41C)));
        assert_eq!(locate(0x4001_2308), Some((Block::Adc, 0x308)));
        assert_eq!(locate(0x4002_1818), Some((Block::Gpio(6), 0x18)));
        assert_eq!(locate(0x4002_6428), Some((Block::Dma(2), 0x28)));
        assert_eq!(locate(0x4002_2400), None);
        assert_eq!(locate(0x5006_0800), None);
    }

    #[test]
    fn each_register_block_resets_by_its_own_bit() {
        let mut bits: Vec<_> = Block::ALL.iter().filter_map(|b| reset_bit(*b, 0)).collect();
        let all = bits.len();
        bits.sort_by_key(|(bus, bit)| (*bus as u8, *bit));
        bits.dedup();
        assert_eq!(bits.len(), all);
    }

    #[test]
    fn gates_are_those_of_the_enable_registers() {
        // RM0090 7.3.10, 7.3.13 and 7.3.14, read off the register maps.
        for (block, offset, bus, bit) in [
            (Block::Gpio(0), 0, Bus::Ahb1, 0),
            (Block::Gpio(8), 0, Bus::Ahb1, 8),
            (Block::Dma(1), 0, Bus::Ahb1, 21),
            (Block::Dma(2), 0, Bus::Ahb1, 22),
            (Block::Timer(2), 0, Bus::Apb1, 0),
            (Block::Timer(5), 0, Bus::Apb1, 3),
            (Block::Usart(3), 0, Bus::Apb1, 18),
            (Block::I2c3, 0, Bus::Apb1, 23),
            (Block::Can, 0, Bus::Apb1, 25),
            (Block::Can, 0x400, Bus::Apb1, 26),
            (Block::Pwr, 0, Bus::Apb1, 28),
            (Block::Usart(1), 0, Bus::Apb2, 4),
            (Block::Usart(6), 0, Bus::Apb2, 5),
            (Block::Adc, 0x200, Bus::Apb2, 10),
            (Block::Spi1, 0, Bus::Apb2, 12),
            (Block::Syscfg, 0, Bus::Apb2, 14),
            (Block::Timer(10), 0, Bus::Apb2, 17),
        ] {
            let gate = clock_gate(block, offset).map(|gate| (gate.bus, gate.bit));
            assert_eq!(gate, Some((bus, bit)), "{block:?}");
        }
        // The converters share ADCRST, bit 8.
        assert_eq!(reset_bit(Block::Adc, 0x200), Some((Bus::Apb2, 8)));
    }
}
