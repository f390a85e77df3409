//! The STM32F407's peripherals, with their registers and signals. Each has its own file.
//!
//! The devices at the other ends of the wires are behind [`board::Board`].

pub(crate) mod access;
pub(crate) mod adc;
pub(crate) mod blocks;
pub mod board;
pub mod board_errors;
pub mod bus;
pub(crate) mod can;
pub(crate) mod clocks;
pub(crate) mod dma;
pub(crate) mod dma_request;
pub(crate) mod exti;
pub mod flash;
pub mod flash_cells;
pub(crate) mod gpio;
pub mod guest_memory;
pub(crate) mod i2c;
pub(crate) mod irq;
pub(crate) mod iwdg;
pub(crate) mod memory_map;
pub mod peripheral;
pub mod pins;
pub(crate) mod pwr;
pub(crate) mod rcc;
mod registers;
pub mod reset;
pub(crate) mod routing;
pub(crate) mod scheduler;
pub mod signals;
pub(crate) mod spi;
pub(crate) mod syscfg;
#[cfg(test)]
mod test_bench;
#[cfg(test)]
pub(crate) mod test_board;
pub(crate) mod timer;
pub(crate) mod usart;
pub mod wave;
