//! The STM32F407's peripherals: registers in, wires out. One file a peripheral.

pub mod absent;
pub mod access;
pub mod blocks;
pub mod bus;
pub mod clocks;
pub mod dma_request;
pub mod exti;
pub mod flash;
pub mod gpio;
pub mod guest_memory;
pub mod irq;
pub mod memory_map;
pub mod peripheral;
pub mod pins;
pub mod pwr;
pub mod rcc;
pub mod reset;
pub mod scheduler;
pub mod syscfg;
pub mod timer;
