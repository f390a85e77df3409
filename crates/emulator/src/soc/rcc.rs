//! RCC: oscillators, PLL, prescalers, clock enables, resets and reset flags (RM0090 section 7).

mod frequencies;
mod oscillator;
mod registers;

pub use frequencies::SystemClock;
use frequencies::{BusClocks, HSI_HZ, Pll};
use oscillator::Oscillator;
use registers::{bdcr, cr, csr, reg};

use crate::soc::{
    access::Access,
    clocks::ClockTree,
    memory_map::Bus,
    peripheral::{Ctx, Peripheral, Unmodelled},
    reset::ResetCause,
    scheduler::Target,
};

/// Reset values of AHB1LPENR to APB2LPENR: every clock keeps running in sleep.
const SLEEP_ENABLES: [u32; 6] = [0x7E67_91FF, 0x0000_00F1, 1, 0, 0x36FE_C9FF, 0x0007_5F33];

#[derive(Debug)]
pub struct Rcc {
    cr: u32,
    pllcfgr: u32,
    cfgr: u32,
    csr: u32,
    bdcr: u32,
    sscgr: u32,
    plli2scfgr: u32,
    /// Reset bits of AHB1, AHB2, AHB3, –, APB1 and APB2, in the order of the registers.
    resets: [u32; 6],
    enables: [u32; 6],
    source: SystemClock,
    /// Number of start-ups of each oscillator. An event of an earlier start-up is stale.
    generation: [u32; 4],
    frequencies_changed: bool,
    /// Whether PWR_CR.DBP is set.
    backup_unlocked: bool,
    risen_resets: Vec<(Bus, u32)>,
}

impl Default for Rcc {
    fn default() -> Self {
        Self {
            cr: cr::RESET,
            pllcfgr: 0x2400_3010,
            cfgr: 0,
            csr: 0,
            bdcr: 0,
            sscgr: 0,
            plli2scfgr: 0x2000_3000,
            resets: [0; 6],
            enables: [0x0010_0000, 0, 0, 0, 0, 0],
            source: SystemClock::Hsi,
            generation: [0; 4],
            frequencies_changed: false,
            backup_unlocked: false,
            risen_resets: Vec::new(),
        }
    }
}

impl Rcc {
    /// Adds the flag of a reset that just happened; every internal reset also pulls NRST (RM0090 figure 20).
    pub fn note_reset(&mut self, cause: ResetCause) {
        if cause == ResetCause::PowerOn {
            (self.csr, self.bdcr) = (0, 0);
        }
        self.csr |= csr::PINRSTF
            | match cause {
                ResetCause::PowerOn => csr::PORRSTF | csr::BORRSTF,
                ResetCause::Software => csr::SFTRSTF,
                ResetCause::IndependentWatchdog => csr::IWDGRSTF,
            };
    }

    /// BDCR can be written only while PWR_CR.DBP is set.
    pub fn set_backup_unlocked(&mut self, unlocked: bool) {
        self.backup_unlocked = unlocked;
    }

    /// True once after each change of a frequency in the tree.
    pub fn take_frequencies_changed(&mut self) -> bool {
        std::mem::take(&mut self.frequencies_changed)
    }

    /// True while the reset bit of a block stands at 1.
    pub fn holds_in_reset(&self, (bus, bit): (Bus, u8)) -> bool {
        let register = match bus {
            Bus::Ahb1 => 0,
            Bus::Apb1 => 4,
            Bus::Apb2 => 5,
        };
        self.resets[register] >> bit & 1 == 1
    }

    /// Reset bits that rose since the last call.
    pub fn take_resets(&mut self) -> Vec<(Bus, u32)> {
        std::mem::take(&mut self.risen_resets)
    }

    fn value(&self, register: u32) -> Result<u32, Unmodelled> {
        Ok(match register {
            reg::CR => self.cr,
            reg::PLLCFGR => self.pllcfgr,
            reg::CFGR => self.cfgr | self.source.sws() << 2,
            reg::CIR => 0,
            reg::AHB1RSTR | reg::AHB2RSTR | reg::AHB3RSTR | reg::APB1RSTR | reg::APB2RSTR => {
                self.resets[bank(register, reg::AHB1RSTR)]
            }
            reg::AHB1ENR | reg::AHB2ENR | reg::AHB3ENR | reg::APB1ENR | reg::APB2ENR => {
                self.enables[bank(register, reg::AHB1ENR)]
            }
            reg::AHB1LPENR | reg::AHB2LPENR | reg::AHB3LPENR | reg::APB1LPENR | reg::APB2LPENR => {
                SLEEP_ENABLES[bank(register, reg::AHB1LPENR)]
            }
            reg::BDCR => self.bdcr,
            reg::CSR => self.csr,
            reg::SSCGR => self.sscgr,
            reg::PLLI2SCFGR => self.plli2scfgr,
            // This register belongs to the F42x. It is reserved on the F407, but drivers for the whole family access it.
            reg::DCKCFGR => 0,
            _ => return Err(reg::MAP.unmodelled_read("RCC", register)),
        })
    }

    fn store(&mut self, register: u32, value: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        match register {
            reg::CR => return self.write_cr(value, ctx),
            reg::PLLCFGR => self.write_pllcfgr(value, ctx),
            reg::CFGR => return self.write_cfgr(value, ctx),
            // No ready interrupt is ever pending, so clearing flags does nothing.
            reg::CIR if value & 0x0000_FF00 == 0 => {}
            reg::AHB1RSTR | reg::AHB2RSTR | reg::AHB3RSTR | reg::APB1RSTR | reg::APB2RSTR => {
                self.write_resets(register, value)
            }
            reg::AHB1ENR | reg::AHB2ENR | reg::AHB3ENR | reg::APB1ENR | reg::APB2ENR => {
                self.enables[bank(register, reg::AHB1ENR)] = value;
                self.publish_enables(ctx.clocks);
            }
            reg::AHB1LPENR | reg::AHB2LPENR | reg::AHB3LPENR | reg::APB1LPENR | reg::APB2LPENR => {
                let kept = SLEEP_ENABLES[bank(register, reg::AHB1LPENR)];
                if value & kept != kept {
                    return Err(reg::MAP.unmodelled(
                        "RCC",
                        register,
                        "a clock that stops in sleep",
                    ));
                }
            }
            reg::BDCR if self.backup_unlocked => return self.write_bdcr(value),
            reg::BDCR => {
                ctx.errors
                    .report(ctx.now, "RCC: BDCR written while PWR_CR.DBP is 0: ignored");
            }
            reg::CSR => self.write_csr(value, ctx),
            reg::SSCGR if value >> 31 == 0 => self.sscgr = value,
            reg::PLLI2SCFGR => self.plli2scfgr = value,
            reg::DCKCFGR => {}
            _ => return Err(reg::MAP.unmodelled_write("RCC", register, value)),
        }
        Ok(())
    }

    fn write_cr(&mut self, value: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        if value & (cr::CSSON | cr::PLLI2SON) != 0 {
            return Err(reg::MAP.unmodelled("RCC", reg::CR, "bit CSSON or PLLI2SON"));
        }
        self.cr = self.cr & !cr::SETTINGS | value & cr::SETTINGS;
        self.switch(Oscillator::Hsi, value & cr::HSION != 0, ctx);
        self.switch_hse(value, ctx);
        if value & cr::PLLON != 0 && self.cr & cr::PLLON == 0 {
            self.check_pll_start(ctx);
        }
        self.switch(Oscillator::Pll, value & cr::PLLON != 0, ctx);
        Ok(())
    }

    fn switch_hse(&mut self, value: u32, ctx: &mut Ctx<'_>) {
        let bypass = value & cr::HSEBYP != 0;
        if bypass && value & cr::HSEON != 0 {
            ctx.errors.report(
                ctx.now,
                "RCC: HSEBYP is set, but the board has a crystal and no clock input: HSE never gets ready",
            );
            self.cr |= cr::HSEON;
            return;
        }
        self.switch(Oscillator::Hse, value & cr::HSEON != 0, ctx);
    }

    fn check_pll_start(&self, ctx: &mut Ctx<'_>) {
        let pll = Pll::from_pllcfgr(self.pllcfgr, ctx.board.hse_hz());
        for problem in pll.problems() {
            ctx.errors.report(ctx.now, problem);
        }
        let source = if frequencies::uses_hse(self.pllcfgr) {
            Oscillator::Hse
        } else {
            Oscillator::Hsi
        };
        if !self.ready(source) {
            ctx.errors.report(
                ctx.now,
                format!("RCC: PLL started while its source {source:?} is not ready"),
            );
        }
    }

    /// Starts or stops an oscillator; what drives SYSCLK cannot be stopped (RM0090 7.3.1).
    fn switch(&mut self, oscillator: Oscillator, on: bool, ctx: &mut Ctx<'_>) {
        let (on_bit, ready_bit) = oscillator.bits();
        let register = self.register_of(oscillator);
        let was_on = *register & on_bit != 0;
        if on && !was_on {
            *register |= on_bit;
            let generation = &mut self.generation[oscillator as usize];
            *generation += 1;
            ctx.scheduler.at(
                ctx.now + oscillator.startup(),
                Target::Rcc,
                *generation << 2 | oscillator as u32,
            );
        } else if !on && was_on && !self.drives_sysclk(oscillator) {
            *self.register_of(oscillator) &= !(on_bit | ready_bit);
            self.generation[oscillator as usize] += 1;
            ctx.clocks.lsi_on = self.csr & csr::LSIRDY != 0;
        }
    }

    fn register_of(&mut self, oscillator: Oscillator) -> &mut u32 {
        match oscillator {
            Oscillator::Lsi => &mut self.csr,
            _ => &mut self.cr,
        }
    }

    fn ready(&self, oscillator: Oscillator) -> bool {
        let register = if oscillator == Oscillator::Lsi {
            self.csr
        } else {
            self.cr
        };
        register & oscillator.bits().1 != 0
    }

    fn drives_sysclk(&self, oscillator: Oscillator) -> bool {
        let by_pll = frequencies::uses_hse(self.pllcfgr);
        match (self.source, oscillator) {
            (SystemClock::Hsi, Oscillator::Hsi)
            | (SystemClock::Hse, Oscillator::Hse)
            | (SystemClock::Pll, Oscillator::Pll) => true,
            (SystemClock::Pll, Oscillator::Hse) => by_pll,
            (SystemClock::Pll, Oscillator::Hsi) => !by_pll,
            _ => false,
        }
    }

    fn write_pllcfgr(&mut self, value: u32, ctx: &mut Ctx<'_>) {
        if self.cr & cr::PLLON == 0 {
            self.pllcfgr = value & 0x0F43_7FFF | self.pllcfgr & 0xF0BC_8000;
        } else if value != self.pllcfgr {
            ctx.errors
                .report(ctx.now, "RCC: PLLCFGR written while the PLL is on: ignored");
        }
    }

    fn write_cfgr(&mut self, value: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        if value & 0xFFE0_0000 != 0 {
            return Err(reg::MAP.unmodelled("RCC", reg::CFGR, "clock output or I2S source"));
        }
        if SystemClock::from_sw(value).is_none() {
            return Err(reg::MAP.unmodelled("RCC", reg::CFGR, "SW = 3 (not allowed)"));
        }
        self.cfgr = value & 0x001F_FCF3;
        self.follow_sw();
        self.publish_frequencies(ctx);
        Ok(())
    }

    /// Switches SYSCLK to the requested source as soon as that is ready.
    fn follow_sw(&mut self) {
        let Some(wanted) = SystemClock::from_sw(self.cfgr) else {
            return;
        };
        let oscillator = match wanted {
            SystemClock::Hsi => Oscillator::Hsi,
            SystemClock::Hse => Oscillator::Hse,
            SystemClock::Pll => Oscillator::Pll,
        };
        if self.ready(oscillator) {
            self.source = wanted;
        }
    }

    fn publish_frequencies(&mut self, ctx: &mut Ctx<'_>) {
        let sysclk_hz = match self.source {
            SystemClock::Hsi => HSI_HZ,
            SystemClock::Hse => ctx.board.hse_hz(),
            SystemClock::Pll => Pll::from_pllcfgr(self.pllcfgr, ctx.board.hse_hz()).output_hz(),
        };
        let buses = BusClocks::new(sysclk_hz, self.cfgr);
        for problem in buses.problems() {
            ctx.errors.report(ctx.now, problem);
        }
        let before = *ctx.clocks;
        ctx.clocks.hclk_hz = buses.hclk_hz;
        ctx.clocks.pclk1_hz = buses.pclk1_hz;
        ctx.clocks.pclk2_hz = buses.pclk2_hz;
        ctx.clocks.tim1_hz = buses.tim1_hz;
        ctx.clocks.tim2_hz = buses.tim2_hz;
        self.frequencies_changed |= before != *ctx.clocks;
    }

    fn publish_enables(&self, clocks: &mut ClockTree) {
        clocks.ahb1enr = self.enables[0];
        clocks.apb1enr = self.enables[4];
        clocks.apb2enr = self.enables[5];
    }

    fn write_resets(&mut self, register: u32, value: u32) {
        let index = bank(register, reg::AHB1RSTR);
        let risen = value & !self.resets[index];
        self.resets[index] = value;
        let bus = match index {
            0 => Bus::Ahb1,
            4 => Bus::Apb1,
            5 => Bus::Apb2,
            _ => return,
        };
        if risen != 0 {
            self.risen_resets.push((bus, risen));
        }
    }

    fn write_bdcr(&mut self, value: u32) -> Result<(), Unmodelled> {
        if value & (bdcr::LSEON | bdcr::LSEBYP) != 0 {
            return Err(reg::MAP.unmodelled("RCC", reg::BDCR, "bit LSEON (no low-speed crystal)"));
        }
        self.bdcr = if value & bdcr::BDRST != 0 {
            bdcr::BDRST
        } else {
            value & (bdcr::RTCSEL | bdcr::RTCEN)
        };
        Ok(())
    }

    fn write_csr(&mut self, value: u32, ctx: &mut Ctx<'_>) {
        if value & csr::RMVF != 0 {
            self.csr &= !csr::FLAGS;
        }
        self.switch(Oscillator::Lsi, value & csr::LSION != 0, ctx);
    }
}

impl Peripheral for Rcc {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        Ok(access.read_of(self.value(access.register)?))
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        let whole = access.written_over(self.value(access.register)?, value);
        self.store(access.register, whole, ctx)
    }

    fn event(&mut self, tag: u32, ctx: &mut Ctx<'_>) {
        let oscillator = Oscillator::ALL[(tag & 3) as usize];
        if self.generation[oscillator as usize] != tag >> 2 {
            return;
        }
        *self.register_of(oscillator) |= oscillator.bits().1;
        ctx.clocks.lsi_on = self.csr & csr::LSIRDY != 0;
        self.follow_sw();
        self.publish_frequencies(ctx);
    }

    /// Reset flags and the backup domain survive a system reset.
    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self {
            csr: self.csr & csr::FLAGS,
            bdcr: self.bdcr,
            generation: self.generation.map(|g| g + 1),
            ..Self::default()
        };
        *ctx.clocks = ClockTree::default();
    }
}

fn bank(register: u32, first: u32) -> usize {
    ((register - first) / 4) as usize
}
