//! Offsets and bits of the RCC registers (RM0090 7.3).

use crate::soc::registers::registers;

registers! {
    CR = 0x00,
    PLLCFGR = 0x04,
    CFGR = 0x08,
    CIR = 0x0C,
    AHB1RSTR = 0x10,
    AHB2RSTR = 0x14,
    AHB3RSTR = 0x18,
    APB1RSTR = 0x20,
    APB2RSTR = 0x24,
    AHB1ENR = 0x30,
    AHB2ENR = 0x34,
    AHB3ENR = 0x38,
    APB1ENR = 0x40,
    APB2ENR = 0x44,
    AHB1LPENR = 0x50,
    AHB2LPENR = 0x54,
    AHB3LPENR = 0x58,
    APB1LPENR = 0x60,
    APB2LPENR = 0x64,
    BDCR = 0x70,
    CSR = 0x74,
    SSCGR = 0x80,
    PLLI2SCFGR = 0x84,
    PLLSAICFGR = 0x88,
    DCKCFGR = 0x8C,
}

pub mod cr {
    pub const HSION: u32 = 1;
    pub const HSIRDY: u32 = 1 << 1;
    pub const HSEON: u32 = 1 << 16;
    pub const HSERDY: u32 = 1 << 17;
    pub const HSEBYP: u32 = 1 << 18;
    pub const CSSON: u32 = 1 << 19;
    pub const PLLON: u32 = 1 << 24;
    pub const PLLRDY: u32 = 1 << 25;
    pub const PLLI2SON: u32 = 1 << 26;
    /// HSITRIM and HSEBYP: no more than kept.
    pub const SETTINGS: u32 = 0xF8 | HSEBYP;
    /// HSI on and ready, trim in the middle.
    pub const RESET: u32 = 0x83;
}

pub mod csr {
    pub const LSION: u32 = 1;
    pub const LSIRDY: u32 = 1 << 1;
    pub const RMVF: u32 = 1 << 24;
    pub const BORRSTF: u32 = 1 << 25;
    pub const PINRSTF: u32 = 1 << 26;
    pub const PORRSTF: u32 = 1 << 27;
    pub const SFTRSTF: u32 = 1 << 28;
    pub const IWDGRSTF: u32 = 1 << 29;
    pub const FLAGS: u32 = 0xFE00_0000;
}

pub mod bdcr {
    pub const LSEON: u32 = 1;
    pub const LSEBYP: u32 = 1 << 2;
    pub const RTCSEL: u32 = 3 << 8;
    pub const RTCEN: u32 = 1 << 15;
    pub const BDRST: u32 = 1 << 16;
}
