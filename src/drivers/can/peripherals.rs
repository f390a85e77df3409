//! The two CAN peripherals in the form that `bxcan` needs: proofs of ownership with a register address.

use bxcan::{FilterOwner, Instance, MasterInstance, RegisterBlock};
use embassy_stm32::{Peri, pac, peripherals};

/// Proof of ownership of CAN1, which also owns the filter banks of both peripherals.
pub struct Can1(());

/// Proof of ownership of CAN2.
pub struct Can2(());

impl Can1 {
    /// Consumes the HAL's token.
    pub fn new(_token: Peri<'static, peripherals::CAN1>) -> Self {
        Self(())
    }
}

impl Can2 {
    /// Consumes the HAL's token.
    pub fn new(_token: Peri<'static, peripherals::CAN2>) -> Self {
        Self(())
    }
}

// SAFETY: `Can1` stands for the HAL's only token of CAN1, and the address is CAN1's.
unsafe impl Instance for Can1 {
    const REGISTERS: *mut RegisterBlock = pac::CAN1.as_ptr().cast();
}

// SAFETY: on the STM32F407 CAN1 owns all 28 filter banks (RM0090 32.7.4).
unsafe impl FilterOwner for Can1 {
    const NUM_FILTER_BANKS: u8 = 28;
}

// SAFETY: CAN2 is CAN1's slave on this chip.
unsafe impl MasterInstance for Can1 {}

// SAFETY: `Can2` stands for the HAL's only token of CAN2, and the address is CAN2's.
unsafe impl Instance for Can2 {
    const REGISTERS: *mut RegisterBlock = pac::CAN2.as_ptr().cast();
}
