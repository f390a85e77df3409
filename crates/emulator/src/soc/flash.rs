//! Flash interface (RM0090 3.9): wait states, caches, the key and lock of the control register. An erase or a program
//! that begins is counted; what it does to the contents is not modelled, so the machine stops there.

use robot_plant::time::{MS, Ps, US};

use crate::soc::{
    access::Access,
    peripheral::{Ctx, Peripheral, Unmodelled},
};

const LATENCY: u32 = 0x7;
const ICEN_DCEN: u32 = 0x600;
const RESET_CACHES: u32 = 0x1800;
const ACR: u32 = LATENCY | 0x100 | ICEN_DCEN | RESET_CACHES;

/// One wait state each 30 MHz at 2.7–3.6 V (RM0090 table 10).
const HZ_PER_WAIT_STATE: u32 = 30_000_000;

/// Written to KEYR one after the other they open CR; anything else keeps it shut until the next reset.
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

mod cr {
    pub const PG: u32 = 1 << 0;
    pub const SER: u32 = 1 << 1;
    pub const MER: u32 = 1 << 2;
    pub const STRT: u32 = 1 << 16;
    pub const LOCK: u32 = 1 << 31;
    /// SER, MER, SNB, PSIZE, EOPIE, ERRIE.
    pub const KEPT: u32 = 0x0300_037E;
}

/// Typical times at 2.7–3.6 V by 32-bit parallelism (STM32F407 datasheet, flash memory programming).
const ERASE_16_KIB: Ps = 250 * MS;
const ERASE_64_KIB: Ps = 550 * MS;
const ERASE_128_KIB: Ps = 1_000 * MS;
const ERASE_ALL: Ps = 8_000 * MS;
const PROGRAM_WORD: Ps = 16 * US;

/// Counted since power-on. The one bank of this chip serves no fetch while it works.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashStats {
    pub erases: u64,
    pub programs: u64,
    pub longest_stall: Ps,
}

impl FlashStats {
    fn erase(&mut self, stall: Ps) {
        self.erases += 1;
        self.longest_stall = self.longest_stall.max(stall);
    }

    fn program(&mut self) {
        self.programs += 1;
        self.longest_stall = self.longest_stall.max(PROGRAM_WORD);
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Lock {
    #[default]
    Locked,
    FirstKeyGiven,
    Open,
    UntilReset,
}

#[derive(Debug, Default)]
pub struct Flash {
    acr: u32,
    lock: Lock,
    cr: u32,
    stats: FlashStats,
}

impl Flash {
    pub fn stats(&self) -> FlashStats {
        self.stats
    }

    fn give_key(&mut self, key: u32, ctx: &mut Ctx<'_>) {
        self.lock = match (self.lock, key) {
            (Lock::Locked, key) if key == KEYS[0] => Lock::FirstKeyGiven,
            (Lock::FirstKeyGiven, key) if key == KEYS[1] => Lock::Open,
            (Lock::Open, _) => Lock::Open,
            _ => {
                let message = format!("FLASH: wrong key {key:#010x}: CR stays locked until reset");
                ctx.errors.report(ctx.now, message);
                Lock::UntilReset
            }
        };
    }

    fn write_control(&mut self, value: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        if self.lock != Lock::Open {
            ctx.errors
                .report(ctx.now, "FLASH: CR written while locked: ignored");
            return Ok(());
        }
        let erase = value & cr::STRT != 0 && value & (cr::SER | cr::MER) != 0;
        if erase {
            self.stats.erase(erase_time(value));
            return Err(unmodelled(0x10, &format!("erase ({value:#010x})")));
        }
        if value & cr::PG != 0 {
            self.stats.program();
            return Err(unmodelled(0x10, &format!("programming ({value:#010x})")));
        }
        self.cr = value & cr::KEPT;
        if value & cr::LOCK != 0 {
            self.lock = Lock::Locked;
        }
        Ok(())
    }

    /// Files a board error where `hclk_hz` asks for more wait states than set.
    pub fn check_speed(&self, ctx: &mut Ctx<'_>) {
        let needed = ctx
            .clocks
            .hclk_hz
            .div_ceil(HZ_PER_WAIT_STATE)
            .saturating_sub(1);
        let set = self.acr & LATENCY;
        if set < needed {
            let hclk_hz = ctx.clocks.hclk_hz;
            ctx.errors.report(
                ctx.now,
                format!("FLASH: {set} wait states at HCLK {hclk_hz} Hz, needs {needed}: fetches return garbage"),
            );
        }
    }
}

impl Peripheral for Flash {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        match access.register {
            0x00 => Ok(access.read_of(self.acr)),
            0x10 if self.lock == Lock::Open => Ok(access.read_of(self.cr)),
            0x10 => Ok(access.read_of(self.cr | cr::LOCK)),
            _ => Err(unmodelled(offset, "read")),
        }
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        match access.register {
            0x00 => {}
            0x04 => {
                self.give_key(value, ctx);
                return Ok(());
            }
            0x10 => return self.write_control(access.written_over(self.cr, value), ctx),
            _ => return Err(unmodelled(offset, &format!("write of {value:#010x}"))),
        }
        let whole = access.written_over(self.acr, value) & ACR;
        if whole & RESET_CACHES != 0 && self.acr & ICEN_DCEN != 0 {
            ctx.errors.report(
                ctx.now,
                "FLASH: ACR cache reset while the caches are on: ignored",
            );
        }
        self.acr = whole;
        self.check_speed(ctx);
        Ok(())
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, _ctx: &mut Ctx<'_>) {
        *self = Self {
            stats: self.stats,
            ..Self::default()
        };
    }
}

/// Sectors 0–3 hold 16 KiB, 4 holds 64 KiB, the rest 128 KiB (RM0090 table 5).
fn erase_time(control: u32) -> Ps {
    if control & cr::MER != 0 {
        return ERASE_ALL;
    }
    match control >> 3 & 0xF {
        0..=3 => ERASE_16_KIB,
        4 => ERASE_64_KIB,
        _ => ERASE_128_KIB,
    }
}

fn unmodelled(offset: u32, what: &str) -> Unmodelled {
    let names = ["ACR", "KEYR", "OPTKEYR", "SR", "CR", "OPTCR"];
    let register = names.get((offset / 4) as usize).map_or_else(
        || format!("FLASH+{offset:#x}"),
        |name| format!("FLASH.{name}"),
    );
    Unmodelled {
        register,
        what: what.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soc::test_bench::Bench;

    const KEYR: u32 = 0x04;
    const CR: u32 = 0x10;
    // Sector 1: SNB = 1; 32-bit parallelism.
    const ERASE_SECTOR_1: u32 = 2 << 8 | 1 << 3 | cr::SER;

    fn unlocked(bench: &mut Bench) -> Flash {
        let mut flash = Flash::default();
        bench.write(&mut flash, KEYR, 0x4567_0123);
        bench.write(&mut flash, KEYR, 0xCDEF_89AB);
        flash
    }

    #[test]
    fn an_erase_is_counted_with_its_time_and_survives_a_reset_in_the_count() {
        let mut bench = Bench::new();
        let mut flash = unlocked(&mut bench);
        assert_eq!(flash.stats(), FlashStats::default());
        bench.write(&mut flash, CR, ERASE_SECTOR_1);
        assert_eq!(flash.stats(), FlashStats::default(), "not started");
        assert_eq!(bench.read(&mut flash, CR), ERASE_SECTOR_1);
        let started = flash.write(CR, 4, ERASE_SECTOR_1 | cr::STRT, &mut bench.ctx());
        assert!(started.is_err(), "the contents are not modelled");
        flash.reset(&mut bench.ctx());
        let counted = FlashStats {
            erases: 1,
            programs: 0,
            longest_stall: 250 * MS,
        };
        assert_eq!(flash.stats(), counted);
        assert_eq!(bench.read(&mut flash, CR), 1 << 31, "locked again");
    }

    #[test]
    fn programming_is_counted() {
        let mut bench = Bench::new();
        let mut flash = unlocked(&mut bench);
        let begun = flash.write(CR, 4, 2 << 8 | cr::PG, &mut bench.ctx());
        assert!(begun.is_err());
        assert_eq!(
            (flash.stats().programs, flash.stats().longest_stall),
            (1, 16 * US)
        );
    }

    #[test]
    fn without_both_keys_in_order_nothing_begins() {
        let mut bench = Bench::new();
        let mut flash = Flash::default();
        bench.write(&mut flash, KEYR, 0xCDEF_89AB);
        bench.write(&mut flash, KEYR, 0x4567_0123);
        bench.write(&mut flash, CR, ERASE_SECTOR_1 | cr::STRT);
        assert_eq!(flash.stats(), FlashStats::default());
        assert_eq!(bench.error_texts().len(), 3, "{:?}", bench.error_texts());
    }
}
