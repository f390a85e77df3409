//! Bits of the I2C registers (RM0090 27.6), and a check for bits that are not modelled.

use crate::soc::{peripheral::Unmodelled, registers::registers};

registers! {
    CR1 = 0x00,
    CR2 = 0x04,
    OAR1 = 0x08,
    OAR2 = 0x0C,
    DR = 0x10,
    SR1 = 0x14,
    SR2 = 0x18,
    CCR = 0x1C,
    TRISE = 0x20,
    FLTR = 0x24,
}

pub mod cr1 {
    pub const PE: u32 = 1;
    pub const START: u32 = 1 << 8;
    pub const STOP: u32 = 1 << 9;
    pub const ACK: u32 = 1 << 10;
    pub const SWRST: u32 = 1 << 15;
    pub const MODELLED: u32 = PE | START | STOP | ACK | SWRST;
}

pub mod cr2 {
    pub const FREQ: u32 = 0x3F;
    pub const ITERREN: u32 = 1 << 8;
    pub const ITEVTEN: u32 = 1 << 9;
    pub const ITBUFEN: u32 = 1 << 10;
    pub const DMAEN: u32 = 1 << 11;
    pub const LAST: u32 = 1 << 12;
    pub const MODELLED: u32 = FREQ | ITERREN | ITEVTEN | ITBUFEN | DMAEN | LAST;
}

pub mod sr1 {
    pub const SB: u32 = 1;
    pub const ADDR: u32 = 1 << 1;
    pub const BTF: u32 = 1 << 2;
    pub const RXNE: u32 = 1 << 6;
    pub const TXE: u32 = 1 << 7;
    pub const AF: u32 = 1 << 10;
    /// BERR, ARLO, AF, OVR, PECERR, TIMEOUT and SMBALERT: cleared by writing 0.
    pub const ERRORS: u32 = 0xDF00;
}

pub mod sr2 {
    pub const MSL: u32 = 1;
    pub const BUSY: u32 = 1 << 1;
    pub const TRA: u32 = 1 << 2;
}

/// The bits of a write that request functions that are not modelled (slave, SMBus, PEC, POS, 10-bit own addresses …).
pub fn check_write(register: u32, value: u32) -> Result<(), Unmodelled> {
    let modelled = match register {
        reg::CR1 => cr1::MODELLED,
        reg::CR2 => cr2::MODELLED,
        // Own addresses may be set, but are not used without slave mode. Software keeps bit 14 of OAR1 at 1.
        reg::OAR1 | reg::OAR2 => 0x43FE,
        reg::DR | reg::SR1 | reg::SR2 => u32::MAX,
        reg::CCR => 0xCFFF,
        reg::TRISE => 0x3F,
        _ => 0,
    };
    if value & !modelled != 0 || register > reg::FLTR {
        return Err(reg::MAP.unmodelled_write("I2C3", register, value));
    }
    Ok(())
}
