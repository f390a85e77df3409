//! Exception numbers of the Cortex-M4 and their names on the STM32F407.

use crate::soc::irq::{IRQ_COUNT, Irq};

/// Thread mode, 15 system exceptions and the chip's interrupts.
pub const EXCEPTION_COUNT: usize = 16 + IRQ_COUNT;

/// A number as IPSR holds it; 0 stands for thread mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Exception(u8);

impl Exception {
    pub const THREAD: Self = Self(0);
    pub const NMI: Self = Self(2);
    pub const HARD_FAULT: Self = Self(3);
    pub const MEM_MANAGE: Self = Self(4);
    pub const BUS_FAULT: Self = Self(5);
    pub const USAGE_FAULT: Self = Self(6);
    pub const SV_CALL: Self = Self(11);
    pub const PEND_SV: Self = Self(14);
    pub const SYS_TICK: Self = Self(15);

    /// Returns `None` past the chip's last interrupt.
    pub fn from_number(number: u32) -> Option<Self> {
        u8::try_from(number)
            .ok()
            .filter(|&n| usize::from(n) < EXCEPTION_COUNT)
            .map(Self)
    }

    pub fn from_irq(irq: Irq) -> Self {
        Self(irq + 16)
    }

    pub fn number(self) -> u32 {
        self.0.into()
    }

    pub fn index(self) -> usize {
        self.0.into()
    }

    /// The interrupt of this exception, or `None` for a system exception.
    pub fn irq(self) -> Option<Irq> {
        self.0.checked_sub(16)
    }

    /// Name in the reference manual's vector table (RM0090 table 62); `thread` for thread mode.
    pub fn name(self) -> &'static str {
        match self.irq() {
            Some(irq) => IRQ_NAMES[usize::from(irq)],
            None => match self.0 {
                0 => "thread",
                1 => "Reset",
                2 => "NMI",
                3 => "HardFault",
                4 => "MemManage",
                5 => "BusFault",
                6 => "UsageFault",
                11 => "SVCall",
                12 => "DebugMonitor",
                14 => "PendSV",
                15 => "SysTick",
                _ => "reserved exception",
            },
        }
    }
}

#[rustfmt::skip]
const IRQ_NAMES: [&str; IRQ_COUNT] = [
    "WWDG", "PVD", "TAMP_STAMP", "RTC_WKUP", "FLASH", "RCC", "EXTI0", "EXTI1", "EXTI2", "EXTI3", "EXTI4",
    "DMA1_Stream0", "DMA1_Stream1", "DMA1_Stream2", "DMA1_Stream3", "DMA1_Stream4", "DMA1_Stream5", "DMA1_Stream6",
    "ADC", "CAN1_TX", "CAN1_RX0", "CAN1_RX1", "CAN1_SCE", "EXTI9_5", "TIM1_BRK_TIM9", "TIM1_UP_TIM10",
    "TIM1_TRG_COM_TIM11", "TIM1_CC", "TIM2", "TIM3", "TIM4", "I2C1_EV", "I2C1_ER", "I2C2_EV", "I2C2_ER", "SPI1",
    "SPI2", "USART1", "USART2", "USART3", "EXTI15_10", "RTC_Alarm", "OTG_FS_WKUP", "TIM8_BRK_TIM12", "TIM8_UP_TIM13",
    "TIM8_TRG_COM_TIM14", "TIM8_CC", "DMA1_Stream7", "FSMC", "SDIO", "TIM5", "SPI3", "UART4", "UART5", "TIM6_DAC",
    "TIM7", "DMA2_Stream0", "DMA2_Stream1", "DMA2_Stream2", "DMA2_Stream3", "DMA2_Stream4", "ETH", "ETH_WKUP",
    "CAN2_TX", "CAN2_RX0", "CAN2_RX1", "CAN2_SCE", "OTG_FS", "DMA2_Stream5", "DMA2_Stream6", "DMA2_Stream7", "USART6",
    "I2C3_EV", "I2C3_ER", "OTG_HS_EP1_OUT", "OTG_HS_EP1_IN", "OTG_HS_WKUP", "OTG_HS", "DCMI", "CRYP", "HASH_RNG",
    "FPU",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_at_the_positions_of_the_reference_manual() {
        for (irq, name) in [
            (0, "WWDG"),
            (28, "TIM2"),
            (52, "UART4"),
            (53, "UART5"),
            (63, "CAN2_TX"),
            (81, "FPU"),
        ] {
            assert_eq!(Exception::from_irq(irq).name(), name);
        }
    }
}
