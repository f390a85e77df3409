//! Bits of the USART registers (RM0090 30.6), and a check for bits that are not modelled.

use crate::soc::{peripheral::Unmodelled, registers::registers};

registers! {
    SR = 0x00,
    DR = 0x04,
    BRR = 0x08,
    CR1 = 0x0C,
    CR2 = 0x10,
    CR3 = 0x14,
    GTPR = 0x18,
}

pub mod sr {
    pub const PE: u32 = 1;
    pub const FE: u32 = 1 << 1;
    pub const NE: u32 = 1 << 2;
    pub const ORE: u32 = 1 << 3;
    pub const IDLE: u32 = 1 << 4;
    pub const RXNE: u32 = 1 << 5;
    pub const TC: u32 = 1 << 6;
    pub const TXE: u32 = 1 << 7;
    /// Cleared by reading SR and then DR.
    pub const CLEARED_BY_DR_READ: u32 = PE | FE | NE | ORE | IDLE;
}

pub mod cr1 {
    pub const RE: u32 = 1 << 2;
    pub const TE: u32 = 1 << 3;
    pub const IDLEIE: u32 = 1 << 4;
    pub const RXNEIE: u32 = 1 << 5;
    pub const TCIE: u32 = 1 << 6;
    pub const TXEIE: u32 = 1 << 7;
    pub const PEIE: u32 = 1 << 8;
    pub const PS: u32 = 1 << 9;
    pub const PCE: u32 = 1 << 10;
    pub const M: u32 = 1 << 12;
    pub const UE: u32 = 1 << 13;
    pub const OVER8: u32 = 1 << 15;
    pub const MODELLED: u32 =
        RE | TE | IDLEIE | RXNEIE | TCIE | TXEIE | PEIE | PS | PCE | M | UE | OVER8;
}

pub mod cr3 {
    pub const EIE: u32 = 1;
    pub const DMAR: u32 = 1 << 6;
    pub const DMAT: u32 = 1 << 7;
    pub const ONEBIT: u32 = 1 << 11;
    pub const MODELLED: u32 = EIE | DMAR | DMAT | ONEBIT;
}

/// STOP, bits 13 and 12: whole stop bits only.
const CR2_MODELLED: u32 = 1 << 13;

/// The bits of a write that request functions that are not modelled (LIN, smartcard, IrDA, mute mode, flow control …).
pub fn check_write(number: u8, register: u32, value: u32) -> Result<(), Unmodelled> {
    let modelled = match register {
        reg::SR | reg::BRR => u32::MAX,
        reg::DR => 0x1FF,
        reg::CR1 => cr1::MODELLED,
        reg::CR2 => CR2_MODELLED,
        reg::CR3 => cr3::MODELLED,
        _ => 0,
    };
    let beyond = value & !modelled;
    if beyond != 0 || register > reg::GTPR {
        return Err(reg::MAP.unmodelled_write(name(number), register, value));
    }
    Ok(())
}

pub fn name(number: u8) -> String {
    format!("USART{number}")
}
