//! The STM32F407's peripherals: registers in, wires out. One file a peripheral.
//!
//! What the wires lead to is behind [`board::Board`].

pub mod access;
pub mod adc;
pub mod blocks;
pub mod board;
pub mod board_errors;
pub mod bus;
pub mod can;
pub mod can_bus;
pub mod clocks;
pub mod dma;
pub mod dma_request;
pub mod exti;
pub mod flash;
pub mod flash_cells;
pub mod gpio;
pub mod guest_memory;
pub mod i2c;
pub mod irq;
pub mod iwdg;
pub mod memory_map;
pub mod peripheral;
pub mod pins;
pub mod pwr;
pub mod rcc;
mod registers;
pub mod reset;
pub mod routing;
pub mod scheduler;
pub mod signals;
pub mod spi;
pub mod syscfg;
#[cfg(test)]
mod test_bench;
#[cfg(test)]
pub(crate) mod test_board;
pub mod timer;
pub mod usart;
pub mod wave;
