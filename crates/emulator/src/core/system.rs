//! The core's private peripherals at 0xE000_0000: NVIC, SCB, SysTick and the debug hardware.

use crate::{
    core::{
        exception::Exception,
        faults::FaultStatus,
        nvic::{Masks, Nvic},
        systick::SysTick,
    },
    soc::{access::Access, peripheral::Unmodelled},
};

mod breakpoints;
pub mod debug_registers;
mod nvic_registers;
mod reg;
mod scb_registers;

use debug_registers::Debug;

/// Registers of the private peripheral bus.
#[derive(Debug)]
pub(crate) struct System {
    pub nvic: Nvic,
    pub systick: SysTick,
    pub faults: FaultStatus,
    pub debug: Debug,
    vtor: u32,
    scr: u32,
    ccr: u32,
    cpacr: u32,
    fpccr: u32,
    actlr: u32,
    reset_requested: bool,
}

const CCR_STKALIGN: u32 = 1 << 9;
const CCR_DIV_0_TRP: u32 = 1 << 4;
const CCR_UNALIGN_TRP: u32 = 1 << 3;
const SCR_SLEEPONEXIT: u32 = 1 << 1;
const SCR_SLEEPDEEP: u32 = 1 << 2;
const SCR_SEVONPEND: u32 = 1 << 4;
const CCR_USERSETMPEND: u32 = 1 << 1;
const CPACR_FPU: u32 = 0xF << 20;
/// ASPEN and LSPEN: automatic state preservation, lazily.
const FPCCR_RESET: u32 = 0xC000_0000;

impl Default for System {
    fn default() -> Self {
        Self {
            nvic: Nvic::default(),
            systick: SysTick::default(),
            faults: FaultStatus::default(),
            debug: Debug::default(),
            vtor: 0,
            scr: 0,
            ccr: CCR_STKALIGN,
            cpacr: 0,
            fpccr: FPCCR_RESET,
            actlr: 0,
            reset_requested: false,
        }
    }
}

/// State of the rest of the machine that an access depends on.
pub(crate) struct Surroundings<'a> {
    pub cycles: u64,
    /// Level of each interrupt's request line.
    pub line_high: &'a dyn Fn(u8) -> bool,
}

impl System {
    /// Performs a system reset. Debug registers keep their values, which only power-on clears.
    pub fn reset(&mut self) {
        let debug = std::mem::take(&mut self.debug);
        *self = Self {
            debug,
            ..Self::default()
        };
    }

    pub fn read(
        &mut self,
        addr: u32,
        size: u8,
        around: &Surroundings<'_>,
    ) -> Result<u32, Unmodelled> {
        let access = Access::new(addr, size);
        let word = match access.register {
            reg::ICTR => 2, // 96 interrupt lines
            reg::ACTLR => self.actlr,
            reg::SYST_CSR => self.systick.read_ctrl(),
            reg::SYST_RVR => self.systick.reload(),
            reg::SYST_CVR => self.systick.value(around.cycles),
            reg::SYST_CALIB => 0, // no calibration value
            r @ reg::NVIC_ISER0..=reg::NVIC_IPR59 => {
                self.read_nvic(r).ok_or_else(|| unmodelled(r, "read"))?
            }
            r @ (reg::CPUID..=reg::MPU_CTRL | reg::FPCCR..=reg::MVFR1) => {
                self.read_scb(r).ok_or_else(|| unmodelled(r, "read"))?
            }
            r => self
                .debug
                .read(r, around.cycles)
                .ok_or_else(|| unmodelled(r, "read"))?,
        };
        Ok(access.read_of(word))
    }

    pub fn write(
        &mut self,
        addr: u32,
        size: u8,
        value: u32,
        around: &Surroundings<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(addr, size);
        let refused = || unmodelled(access.register, &format!("write of 0x{value:08X}"));
        let done = match access.register {
            reg::ACTLR => {
                self.actlr = access.written_over(self.actlr, value);
                true
            }
            reg::SYST_CSR => {
                self.systick.write_ctrl(value, around.cycles);
                true
            }
            reg::SYST_RVR => {
                self.systick.write_reload(value);
                true
            }
            reg::SYST_CVR => {
                self.systick.write_value(around.cycles);
                true
            }
            r @ (reg::NVIC_ISER0..=reg::NVIC_IPR59 | reg::STIR) => {
                self.write_nvic(r, access, value, around)
            }
            r @ (reg::CPUID..=reg::MPU_CTRL | reg::FPCCR..=reg::MVFR1) => {
                self.write_scb(r, access, value)
            }
            r => self.debug.write(r, value, around.cycles),
        };
        if done { Ok(()) } else { Err(refused()) }
    }

    pub fn vector_table(&self) -> u32 {
        self.vtor
    }

    /// CCR.STKALIGN: exception frames start at multiples of eight.
    pub fn aligns_stack(&self) -> bool {
        self.ccr & CCR_STKALIGN != 0
    }

    pub fn sleeps_on_exit(&self) -> bool {
        self.scr & SCR_SLEEPONEXIT != 0
    }

    /// Whether sleep means Stop or Standby mode.
    pub fn sleeps_deeply(&self) -> bool {
        self.scr & SCR_SLEEPDEEP != 0
    }

    /// Whether unprivileged code may write there: only STIR, if CCR allows it (ARMv7-M ARM B3.2.26).
    pub fn may_be_written_unprivileged(&self, addr: u32) -> bool {
        addr == reg::STIR && self.ccr & CCR_USERSETMPEND != 0
    }

    /// SCR.SEVONPEND: a new pending interrupt is an event.
    pub fn pending_is_event(&self) -> bool {
        self.scr & SCR_SEVONPEND != 0
    }

    /// CPACR gives full access to coprocessors 10 and 11.
    pub fn fpu_on(&self) -> bool {
        self.cpacr & CPACR_FPU == CPACR_FPU
    }

    /// Whether SYSRESETREQ was set since the last call.
    pub fn take_reset_request(&mut self) -> bool {
        std::mem::take(&mut self.reset_requested)
    }

    /// Advances SysTick to `cycles`. Returns true if an exception became pending.
    pub fn run_due(&mut self, cycles: u64) -> bool {
        let due = self.systick.run_due(cycles);
        if due {
            self.nvic.pend(Exception::SYS_TICK);
        }
        due
    }

    /// Takes a halt for debugging out of the core's own counters.
    pub fn halted_for(&mut self, cycles: u64) {
        self.debug.halted_for(cycles);
        self.systick.halted_for(cycles);
    }

    pub fn deliverable(&self, masks: Masks) -> Option<Exception> {
        self.nvic.deliverable(masks)
    }
}

fn unmodelled(register: u32, what: &str) -> Unmodelled {
    Unmodelled {
        register: format!("{} 0x{register:08X}", block_of(register)),
        what: what.to_owned(),
    }
}

/// The private peripheral that an address belongs to: first and last address, and name.
#[rustfmt::skip]
const BLOCKS: [(u32, u32, &str); 12] = [
    (0xE000_0000, 0xE000_0FFF, "ITM"),
    (0xE000_1000, 0xE000_1FFF, "DWT"),
    (0xE000_2000, 0xE000_2FFF, "FPB"),
    (0xE000_E010, 0xE000_E0FF, "SysTick"),
    (0xE000_E100, 0xE000_E4FF, "NVIC"),
    (0xE000_ED90, 0xE000_EDB8, "MPU"),
    (0xE000_ED00, 0xE000_EDEF, "SCB"),
    (0xE000_EDF0, 0xE000_EDFF, "CoreDebug"),
    (0xE000_EF30, 0xE000_EF4F, "FPU"),
    (0xE004_0000, 0xE004_0FFF, "TPIU"),
    (0xE004_1000, 0xE004_1FFF, "ETM"),
    (0xE004_2000, 0xE004_2FFF, "DBGMCU"),
];

fn block_of(address: u32) -> &'static str {
    let holds = |(first, last, _): &&(u32, u32, &str)| (*first..=*last).contains(&address);
    let block = BLOCKS.iter().find(holds);
    block.map_or("private peripheral bus", |(_, _, name)| name)
}
