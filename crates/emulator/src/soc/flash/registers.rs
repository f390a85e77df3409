//! Bits of the flash interface's registers (RM0090 3.9).

pub mod acr {
    pub const LATENCY: u32 = 0x7;
    pub const PRFTEN: u32 = 1 << 8;
    pub const ICEN: u32 = 1 << 9;
    pub const DCEN: u32 = 1 << 10;
    pub const ICRST: u32 = 1 << 11;
    pub const DCRST: u32 = 1 << 12;
    pub const KNOWN: u32 = LATENCY | PRFTEN | ICEN | DCEN | ICRST | DCRST;
}

pub mod sr {
    pub const EOP: u32 = 1 << 0;
    pub const PGPERR: u32 = 1 << 6;
    pub const PGSERR: u32 = 1 << 7;
    pub const BSY: u32 = 1 << 16;
    /// OPERR, WRPERR, PGAERR, PGPERR and PGSERR.
    pub const ERRORS: u32 = 0xF2;
    /// Cleared by writing 1.
    pub const CLEARABLE: u32 = EOP | ERRORS;
}

pub mod cr {
    pub const PG: u32 = 1 << 0;
    pub const SER: u32 = 1 << 1;
    pub const MER: u32 = 1 << 2;
    pub const STRT: u32 = 1 << 16;
    pub const EOPIE: u32 = 1 << 24;
    pub const ERRIE: u32 = 1 << 25;
    pub const LOCK: u32 = 1 << 31;
    /// Bits that can be written and read back while nothing is under way.
    pub const KEPT: u32 = 0x0300_037F;

    pub fn sector(control: u32) -> u8 {
        (control >> 3 & 0xF) as u8
    }
}
