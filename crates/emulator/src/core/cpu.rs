//! The processor: runs the image until something asks for attention, takes exceptions, sleeps.
//!
//! Time stands still inside a block of code: a register access sees the instant its block began, and an interrupt is
//! taken at the first block boundary after its request, even one the block itself pends (barriers end a block).
//! Exceptions do not clear the exclusive monitor, which the engine keeps to itself: a STREX across a handler fails only
//! if the handler changed the word.

use unicorn_engine::{Arch, ArmCpuModel, Mode, RegisterARM, Unicorn, uc_error};

use crate::{
    core::{
        clock::CycleClock,
        exception::Exception,
        faults::{Fault, HFSR_FORCED},
        image::Segment,
        memory::{self, EngineMemory, FLASH, SRAM},
        stats::Execution,
        system::System,
    },
    soc::{bus::Soc, guest_memory::GuestMemory, peripheral::Unmodelled, reset::ResetCause},
    time::Ps,
};

mod alignment;
mod block_costs;
mod context;
mod debug_halt;
mod fault_injection;
mod hooks;
mod it_state;
mod sleep;
mod standstill;
#[cfg(test)]
mod tests;

use block_costs::BlockCosts;
use fault_injection::Injector;
pub use fault_injection::{Effect, Injection};
use hooks::with_soc;
use sleep::SleepKind;
use standstill::Standstill;
/// An error of the CPU engine.
pub use unicorn_engine::uc_error as EngineError;

/// Why `Cpu::run` returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pause {
    /// The requested time is reached.
    Limit,
    /// WFE or WFI found nothing to do; `thread` when no handler is active.
    Asleep {
        /// No handler is active.
        thread: bool,
    },
    /// The chip must be reset, then `Cpu::reset` called; after `PowerOn`, which is the loss of power, `power_off`.
    Reset(ResetCause),
    /// The power cut is over: `Cpu::power_up` must be called.
    PowerReturns,
}

/// The run cannot continue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Halt {
    /// Why, with the register or the fault.
    pub what: String,
    /// Address of the instruction, or of its block.
    pub pc: u32,
}

/// Why the engine was asked to leave translated code.
#[derive(Clone, Debug)]
enum Stop {
    Interrupt,
    Limit,
    Standstill,
    ExceptionReturn(u32),
    SupervisorCall,
    Fault(Fault),
    Reset(ResetCause),
    Unmodelled(Unmodelled),
    Engine(String),
    Injected(Injection),
    /// A BKPT instruction or a breakpoint while a debugger is attached.
    Breakpoint,
    /// The function that hung at this address may continue.
    Released(u32),
}

/// The block of code being run.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    start: u32,
    end: u32,
    /// Instructions and cycles that are not yet added to the counters.
    instructions: u16,
    cycles: u16,
    /// Registers that must be multiples of four after the block, one bit each.
    aligned_after: u16,
}

/// State that the engine's hooks share with the run loop.
pub(crate) struct State {
    clock: CycleClock,
    /// `None` only while the chip accesses the memories through the engine.
    soc: Option<Box<Soc>>,
    system: System,
    stats: Execution,
    costs: BlockCosts,
    block: Block,
    /// `Soc::next_event` as last seen, and the cycle at which it or anything else is due.
    soc_event: Ps,
    due_cycle: u64,
    limit_cycle: u64,
    /// An interrupt may be deliverable, which the next block boundary checks.
    attention: bool,
    standstill: Standstill,
    /// The event register of WFE.
    event: bool,
    stop: Option<Stop>,
    /// Address of the function whose entries are recorded.
    watched_entry: Option<u32>,
    injector: Injector,
    /// When an injected fault last took effect.
    struck_at: Option<Ps>,
}

/// CPU, memories and chip.
pub struct Cpu {
    engine: Unicorn<'static, State>,
    asleep: Option<SleepKind>,
}

/// An end address past every address. The engine takes its end address for a WFI.
const NOWHERE: u64 = 1 << 32;
const ENTRY_CYCLES: u64 = 12;
const RETURN_CYCLES: u64 = 12;
const TAIL_CHAIN_CYCLES: u64 = 6;
/// S0–S15 and FPSCR; lazy stacking would defer them, not save them when the handler uses the FPU.
const FP_FRAME_CYCLES: u64 = 17;

impl Cpu {
    /// The chip powered on with `segments` in flash, out of reset. Entries of the function at `watched_entry` are
    /// recorded in [`Self::stats`].
    pub fn new(
        segments: &[Segment],
        watched_entry: Option<u32>,
        soc: Soc,
    ) -> Result<Self, uc_error> {
        let state = State {
            clock: CycleClock::new(soc.clocks.hclk_hz),
            soc: Some(Box::new(soc)),
            system: System::default(),
            stats: Execution::default(),
            costs: BlockCosts::default(),
            block: Block::default(),
            soc_event: 0,
            due_cycle: 0,
            limit_cycle: 0,
            attention: false,
            standstill: Standstill::default(),
            event: false,
            stop: None,
            watched_entry,
            injector: Injector::default(),
            struck_at: None,
        };
        let mut engine = Unicorn::new_with_data(Arch::ARM, Mode::THUMB, state)?;
        // Mode::MCLASS would override the model with a Cortex-M33.
        engine.ctl_set_cpu_model(ArmCpuModel::CORTEX_M4 as i32)?;
        memory::map(&mut engine)?;
        hooks::install(&mut engine)?;
        let mut cpu = Self {
            engine,
            asleep: None,
        };
        for segment in segments {
            let offset = segment.address - FLASH.base;
            for base in [FLASH, memory::FLASH_ALIAS] {
                cpu.engine
                    .mem_write(u64::from(base.base + offset), &segment.data)?;
            }
        }
        cpu.boot();
        Ok(cpu)
    }

    /// Performs the core's part of a system reset: it restarts from its vector table and keeps the memories.
    pub fn reset(&mut self) {
        self.engine.get_data_mut().stats.rebooted();
        self.boot();
    }

    fn boot(&mut self) {
        self.asleep = None;
        let state = self.engine.get_data_mut();
        state.system.reset();
        state.attention = false;
        state.event = false;
        state.stop = None;
        state.injector = Injector::default();
        // A reset clears C_HALT.
        state.standstill.halted_until(None);
        let caught = state.system.debug.catches_reset();
        self.reset_registers();
        self.soc_changed();
        if caught {
            self.enter_debug_state("the reset vector (VC_CORERESET)");
        }
    }

    /// Simulated time since power-on, ps.
    pub fn now(&self) -> Ps {
        self.state().clock.now()
    }

    /// The chip without its core.
    pub fn soc(&self) -> &Soc {
        self.state()
            .soc
            .as_ref()
            .expect("the chip is away only inside a register access")
    }

    /// The chip, to be changed from outside between two runs.
    pub fn with_soc<R>(&mut self, change: impl FnOnce(&mut Soc, Ps) -> R) -> R {
        with_soc(&mut self.engine, |soc, now, _| change(soc, now))
    }

    /// When an injected fault last took effect.
    pub fn struck_at(&self) -> Option<Ps> {
        self.state().struck_at
    }

    /// Measurements of the run so far.
    pub fn stats(&self) -> &Execution {
        &self.state().stats
    }

    /// Returns false if no memory answers.
    pub fn read_memory(&self, addr: u32, out: &mut [u8]) -> bool {
        self.engine.mem_read(addr.into(), out).is_ok()
    }

    /// The memories as DMA reaches them.
    pub fn memory(&mut self) -> impl GuestMemory {
        EngineMemory(&mut self.engine)
    }

    fn state(&self) -> &State {
        self.engine.get_data()
    }

    fn state_mut(&mut self) -> &mut State {
        self.engine.get_data_mut()
    }

    fn soc_changed(&mut self) {
        self.with_soc(|_, _| ());
    }

    /// Runs until `until`, sleep or a reset. Blocks are not split, so the run may end up to one block later.
    pub fn run(&mut self, until: Ps) -> Result<Pause, Halt> {
        let state = self.state_mut();
        state.limit_cycle = state.clock.cycle_at(until);
        state.refresh_due();
        loop {
            if !self.state().standstill.is_over()
                && let Some(pause) = self.stand_still()?
            {
                return Ok(pause);
            }
            if let Some(kind) = self.asleep {
                if let Some(pause) = self.sleep(kind)? {
                    return Ok(pause);
                }
                self.asleep = None;
            }
            if self.state().clock.cycles >= self.state().limit_cycle {
                return Ok(Pause::Limit);
            }
            self.take_deliverable()?;
            if let Some(pause) = self.execute()? {
                return Ok(pause);
            }
        }
    }

    /// Runs translated code once, then handles the reason why it stopped.
    fn execute(&mut self) -> Result<Option<Pause>, Halt> {
        let pc = self.pc();
        let result = self.engine.emu_start(u64::from(pc | 1), NOWHERE, 0, 0);
        let aligned = alignment::held_after(&mut self.engine);
        let state = self.state_mut();
        state.settle();
        let stop = match state.stop.take() {
            stop @ Some(Stop::Reset(_) | Stop::Unmodelled(_)) => stop,
            _ if !aligned => Some(Stop::Fault(Fault::Unaligned)),
            stop => stop,
        };
        match (stop, result) {
            (Some(Stop::Interrupt | Stop::Limit | Stop::Standstill), _) => Ok(None),
            (Some(Stop::ExceptionReturn(code)), _) => {
                self.return_from_exception(code).map(|()| None)
            }
            (Some(Stop::SupervisorCall), _) => {
                self.state_mut().system.nvic.pend(Exception::SV_CALL);
                Ok(None)
            }
            (Some(Stop::Fault(fault)), _) => self.raise(fault).map(|()| None),
            (Some(Stop::Injected(injection)), _) => self.take_effect(injection).map(|()| None),
            (Some(Stop::Breakpoint), _) => {
                self.enter_debug_state("a breakpoint");
                Ok(None)
            }
            (Some(Stop::Released(entry)), _) => {
                self.set_register(RegisterARM::PC, entry | 1);
                Ok(None)
            }
            (Some(Stop::Reset(cause)), _) => Ok(Some(Pause::Reset(cause))),
            (Some(Stop::Unmodelled(access)), _) => Err(self.halt_in_block(access.to_string())),
            (Some(Stop::Engine(what)), _) => Err(self.halt(what)),
            (None, Ok(())) => self.wait_for_interrupt(),
            (None, Err(uc_error::INSN_INVALID)) => self.hint_or_undefined(),
            (None, Err(uc_error::EXCEPTION)) => self.raise(Fault::InvalidState).map(|()| None),
            (None, Err(uc_error::FETCH_PROT)) => self.fetch_forbidden().map(|()| None),
            (None, Err(error)) => Err(self.halt(format!("the engine stopped: {error:?}"))),
        }
    }

    fn fetch_forbidden(&mut self) -> Result<(), Halt> {
        if SRAM.contains(self.pc(), 2) {
            return Err(self.halt("code in SRAM is not modelled".to_owned()));
        }
        self.raise(Fault::FetchForbidden)
    }

    /// WFE and YIELD end their block and leave the PC past it; an undefined instruction leaves the PC on itself.
    fn hint_or_undefined(&mut self) -> Result<Option<Pause>, Halt> {
        const WFE: u16 = 0xBF20;
        const WFE_W: u16 = 0x8002;
        const YIELD: u16 = 0xBF10;
        const YIELD_W: u16 = 0x8001;
        let pc = self.pc();
        let mut before = [0; 2];
        let at_block_end = pc == self.state().block.end && self.read_memory(pc - 2, &mut before);
        match u16::from_le_bytes(before) {
            WFE | WFE_W if at_block_end => Ok(self.wait_for_event()),
            YIELD | YIELD_W if at_block_end => Ok(None),
            _ if !self.is_thumb() => self.raise(Fault::InvalidState).map(|()| None),
            _ => self.raise(Fault::UndefinedInstruction).map(|()| None),
        }
    }

    /// Takes the exception that preempts the running code, if there is one.
    fn take_deliverable(&mut self) -> Result<(), Halt> {
        while let Some(exception) = {
            let masks = context::masks(&self.engine);
            self.state().system.deliverable(masks)
        } {
            self.enter(exception)?;
        }
        Ok(())
    }

    /// Takes a synchronous fault: its own exception if that may run now, else HardFault, else lock-up.
    fn raise(&mut self, fault: Fault) -> Result<(), Halt> {
        let masks = context::masks(&self.engine);
        let state = self.state_mut();
        state.system.faults.record(fault);
        let direct = fault
            .exception()
            .filter(|&e| state.system.nvic.can_take(e, masks));
        let exception = match direct {
            Some(exception) => exception,
            None if state.system.nvic.execution_priority(masks) <= -1 => {
                return Err(self.halt(format!("lock-up: {fault:?} inside HardFault or NMI")));
            }
            None => {
                if fault.exception().is_some() {
                    state.system.faults.hfsr |= HFSR_FORCED;
                }
                Exception::HARD_FAULT
            }
        };
        self.enter(exception)
    }

    fn pc(&self) -> u32 {
        self.register(RegisterARM::PC)
    }

    fn halt(&self, what: String) -> Halt {
        Halt {
            what,
            pc: self.pc(),
        }
    }

    /// After a register access the engine reports the PC of that access; inside an IT block it reports the PC of the block's
    /// end.
    fn halt_in_block(&self, what: String) -> Halt {
        let Block { start, end, .. } = self.state().block;
        let pc = self.pc();
        Halt {
            what,
            pc: if (start..end).contains(&pc) {
                pc
            } else {
                start
            },
        }
    }
}

impl State {
    /// Adds the cost of the block that has run.
    fn settle(&mut self) {
        let Block {
            instructions,
            cycles,
            ..
        } = self.block;
        self.clock.cycles += u64::from(cycles);
        self.stats
            .ran(self.system.nvic.current(), instructions, cycles);
        self.block.instructions = 0;
        self.block.cycles = 0;
    }

    fn spend(&mut self, cycles: u64) {
        self.clock.cycles += cycles;
        self.stats.busy_cycles += cycles;
    }

    fn refresh_due(&mut self) {
        self.due_cycle = self
            .clock
            .cycle_at(self.soc_event)
            .min(self.system.systick.next_cycle())
            .min(self.limit_cycle);
    }
}
