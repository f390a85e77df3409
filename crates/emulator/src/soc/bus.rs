//! The chip's peripherals behind one address decoder, with their clocks gated, their events run and DMA served.

use std::any::Any;

use crate::{
    soc::{
        blocks::Blocks,
        board::Board,
        board_errors::BoardErrors,
        can::bus::CanBusStats,
        clocks::ClockTree,
        dma_request::DmaRequests,
        flash::Flash,
        guest_memory::GuestMemory,
        irq::IrqLines,
        memory_map::{self, Block, Bus},
        peripheral::{Ctx, Unmodelled},
        pins::PinBank,
        reset::ResetCause,
        scheduler::{Scheduler, Target},
    },
    time::Ps,
};

/// Replaces bits in every write of the image to one register. Tests use it in place of a wrong line of code.
#[derive(Clone, Copy, Debug)]
pub struct RegisterPatch {
    /// Address of the register.
    pub address: u32,
    /// Bits that are replaced.
    pub mask: u32,
    /// Their value after the replacement.
    pub value: u32,
}

/// Everything of the chip but the CPU, its private peripherals and the memories, with the board around it.
pub struct Soc {
    pub(crate) irq: IrqLines,
    pub(crate) clocks: ClockTree,
    /// Wrong settings and accesses so far.
    pub errors: BoardErrors,
    board: Box<dyn Board>,
    pub(crate) pins: PinBank,
    scheduler: Scheduler,
    dma_requests: DmaRequests,
    blocks: Blocks,
    patches: Vec<RegisterPatch>,
    /// No event is due before this time. It is 0 if the chip has been used since [`Self::next_event`].
    quiet_until: Ps,
}

/// Borrows the blocks and everything around them separately.
macro_rules! split {
    ($soc:expr, $now:expr) => {
        (
            &mut $soc.blocks,
            Ctx {
                now: $now,
                scheduler: &mut $soc.scheduler,
                irq: &mut $soc.irq,
                dma: &mut $soc.dma_requests,
                clocks: &mut $soc.clocks,
                pins: &mut $soc.pins,
                board: &mut *$soc.board,
                errors: &mut $soc.errors,
            },
        )
    };
}

mod dma_service;

impl Soc {
    /// The board at power-on, time 0.
    pub fn new(board: Box<dyn Board>) -> Self {
        let mut soc = Self {
            irq: IrqLines::default(),
            clocks: ClockTree::default(),
            errors: BoardErrors::default(),
            board,
            pins: PinBank::default(),
            scheduler: Scheduler::default(),
            dma_requests: DmaRequests::default(),
            blocks: Blocks::default(),
            patches: Vec::new(),
            quiet_until: 0,
        };
        soc.board.connect(&mut soc.pins);
        soc.reset(ResetCause::PowerOn, 0);
        soc
    }

    /// The board as its concrete type, or `None` if it has another type.
    pub fn board_as<B: Board>(&mut self) -> Option<&mut B> {
        self.quiet_until = 0;
        let board: &mut dyn Any = &mut *self.board;
        board.downcast_mut()
    }

    /// Replaces the masked bits in every later write of the image to the patch's address.
    pub fn add_patch(&mut self, patch: RegisterPatch) {
        self.patches.push(patch);
    }

    /// Sets every register to its reset value, and the flag of `cause` in RCC_CSR.
    pub fn reset(&mut self, cause: ResetCause, now: Ps) {
        self.quiet_until = 0;
        let (blocks, mut ctx) = split!(self, now);
        for block in Block::ALL {
            blocks.get(block).reset(&mut ctx);
        }
        blocks.rcc.note_reset(cause);
        self.irq = IrqLines::default();
        self.dma_requests = DmaRequests::default();
        self.clocks_changed(now);
        self.outputs_changed(now);
    }

    /// A reset that a peripheral requested, or the loss of power as `PowerOn`. The machine carries it out with `reset` and
    /// restarts the CPU.
    pub fn take_reset_request(&mut self) -> Option<ResetCause> {
        self.blocks.take_reset_request()
    }

    /// The flash interface.
    pub fn flash(&self) -> &Flash {
        &self.blocks.flash
    }

    /// The flash interface, to be set up for a test.
    pub fn flash_mut(&mut self) -> &mut Flash {
        &mut self.blocks.flash
    }

    /// Sets the chip's supply. The chip works from 1.8 V on.
    pub fn set_vdd_mv(&mut self, vdd_mv: u32) {
        self.blocks.pwr.set_vdd_mv(vdd_mv);
    }

    /// Loads from flash sectors 1–3 for the core.
    pub fn load_data_flash(
        &mut self,
        addr: u32,
        size: u8,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<u32, Unmodelled> {
        self.run_due(now, mem)?;
        let (blocks, mut ctx) = split!(self, now);
        Ok(blocks.flash.load(addr, size, &mut ctx))
    }

    /// Stores to flash sectors 1–3 for the core.
    pub fn store_data_flash(
        &mut self,
        addr: u32,
        size: u8,
        value: u32,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<(), Unmodelled> {
        self.run_due(now, mem)?;
        let (blocks, mut ctx) = split!(self, now);
        blocks.flash.store(addr, size, value, &mut ctx);
        Ok(())
    }

    /// Frames and load of CAN1 (0) or CAN2 (1).
    pub fn can_stats(&self, bus: usize) -> CanBusStats {
        self.blocks.can_stats(bus)
    }

    /// Loads 1, 2 or 4 bytes at `now`, for the core or a test.
    pub fn read(
        &mut self,
        addr: u32,
        size: u8,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<u32, Unmodelled> {
        self.run_due(now, mem)?;
        let (block, offset) = find(addr, "read")?;
        if !self.answers(block, offset, "read", now) {
            return Ok(0);
        }
        let (blocks, mut ctx) = split!(self, now);
        let value = blocks.get(block).read(offset, size, &mut ctx)?;
        self.after_access(block, now, mem)?;
        Ok(value)
    }

    /// Stores 1, 2 or 4 bytes at `now`, for the core or a test.
    pub fn write(
        &mut self,
        addr: u32,
        size: u8,
        value: u32,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<(), Unmodelled> {
        self.run_due(now, mem)?;
        let (block, offset) = find(addr, "write")?;
        if !self.answers(block, offset, "written", now) {
            return Ok(());
        }
        let value = self.patched(addr, value);
        let (blocks, mut ctx) = split!(self, now);
        blocks.get(block).write(offset, size, value, &mut ctx)?;
        self.after_access(block, now, mem)
    }

    /// Stops the watchdog by DBG_IWDG_STOP while a debugger halts the core.
    pub fn freeze_watchdog(&mut self, frozen: bool, now: Ps) {
        self.quiet_until = 0;
        let (blocks, mut ctx) = split!(self, now);
        blocks.freeze_watchdog(frozen, &mut ctx);
    }

    /// Time of the next event in chip or board that the CPU does not cause. The answer is valid until the chip is used
    /// again.
    pub fn next_event(&mut self) -> Ps {
        self.quiet_until = self.scheduler.next().min(self.board.next_event());
        self.quiet_until
    }

    /// Carries out everything due at or before `now`, in order of time.
    pub fn run_due(&mut self, now: Ps, mem: &mut dyn GuestMemory) -> Result<(), Unmodelled> {
        if now < std::mem::take(&mut self.quiet_until) {
            return Ok(());
        }
        loop {
            let board_at = self.board.next_event();
            if board_at <= now && board_at <= self.scheduler.next() {
                self.advance_board(board_at, mem)?;
            } else if let Some(event) = self.scheduler.pop_due(now) {
                self.route(event.target, event.tag, event.at, mem)?;
            } else {
                return Ok(());
            }
        }
    }

    fn advance_board(&mut self, now: Ps, mem: &mut dyn GuestMemory) -> Result<(), Unmodelled> {
        self.board.advance(now);
        let (blocks, mut ctx) = split!(self, now);
        blocks.inputs_changed(&mut ctx);
        for block in Blocks::WATCHING_THE_BOARD {
            blocks.get(block).board_advanced(&mut ctx);
        }
        self.serve_dma(now, mem)
    }

    fn route(
        &mut self,
        target: Target,
        tag: u32,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<(), Unmodelled> {
        let block = match target {
            Target::Rcc => Block::Rcc,
            Target::Timer(n) => Block::Timer(n),
            Target::Usart(n) => Block::Usart(n),
            Target::Spi1 => Block::Spi1,
            Target::I2c3 => Block::I2c3,
            Target::CanBus(_) => Block::Can,
            Target::Adc => Block::Adc,
            Target::Iwdg => Block::Iwdg,
            Target::Flash => Block::Flash,
        };
        let (blocks, mut ctx) = split!(self, now);
        blocks.get(block).event(tag, &mut ctx);
        self.after_access(block, now, mem)
    }

    /// Passes the effects of an access or event of one block to the others.
    fn after_access(
        &mut self,
        block: Block,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<(), Unmodelled> {
        match block {
            Block::Rcc => self.rcc_changed(now),
            Block::Gpio(_) | Block::Timer(4 | 5 | 10) => self.outputs_changed(now),
            Block::Pwr => {
                let (blocks, mut ctx) = split!(self, now);
                blocks.power_changed(&mut ctx);
            }
            Block::I2c3 => {
                let (blocks, mut ctx) = split!(self, now);
                blocks.inputs_changed(&mut ctx);
                self.board.file_errors(&mut self.errors, now);
            }
            Block::Spi1 | Block::Usart(_) => self.board.file_errors(&mut self.errors, now),
            Block::Exti => {
                let (blocks, mut ctx) = split!(self, now);
                blocks.exti_lines_changed(&mut ctx);
            }
            Block::Syscfg => {
                let (blocks, mut ctx) = split!(self, now);
                blocks.exti_sources_changed(&mut ctx);
            }
            _ => {}
        }
        self.serve_dma(now, mem)
    }

    fn rcc_changed(&mut self, now: Ps) {
        if self.blocks.rcc.take_frequencies_changed() {
            self.clocks_changed(now);
        }
        for (bus, bits) in self.blocks.rcc.take_resets() {
            self.reset_blocks(bus, bits, now);
        }
    }

    fn clocks_changed(&mut self, now: Ps) {
        let (blocks, mut ctx) = split!(self, now);
        for block in Block::ALL {
            blocks.get(block).clocks_changed(&mut ctx);
        }
        blocks.power_changed(&mut ctx);
    }

    /// Resets blocks at the rising edge of their reset bit, which the image lowers again at once.
    fn reset_blocks(&mut self, bus: Bus, bits: u32, now: Ps) {
        let rose = |reset: (Bus, u8)| reset.0 == bus && bits >> reset.1 & 1 == 1;
        let (blocks, mut ctx) = split!(self, now);
        for block in Block::ALL.into_iter().filter(|block| *block != Block::Can) {
            if memory_map::reset_bit(block, 0).is_some_and(rose) {
                blocks.get(block).reset(&mut ctx);
            }
        }
        for (index, bit) in memory_map::CAN_RESETS.into_iter().enumerate() {
            if rose(bit) {
                blocks.reset_can(index, &mut ctx);
            }
        }
        self.outputs_changed(now);
    }

    fn outputs_changed(&mut self, now: Ps) {
        let (blocks, mut ctx) = split!(self, now);
        blocks.outputs_changed(&mut ctx);
    }

    /// Whether the block responds, which means that it is clocked and not in reset. If not, a board error is reported.
    fn answers(&mut self, block: Block, offset: u32, access: &str, now: Ps) -> bool {
        let Some(gate) = memory_map::clock_gate(block, offset) else {
            return true;
        };
        let enables = match gate.bus {
            Bus::Ahb1 => self.clocks.ahb1enr,
            Bus::Apb1 => self.clocks.apb1enr,
            Bus::Apb2 => self.clocks.apb2enr,
        };
        let reset = memory_map::reset_bit(block, offset);
        let why = if enables >> gate.bit & 1 == 0 {
            format!("RCC {} is 0", gate.name)
        } else if gate.name == "APB1ENR.CAN2EN" && self.clocks.apb1enr >> 25 & 1 == 0 {
            // The message memory and the filters are CAN1's (RM0090 32.3).
            "RCC APB1ENR.CAN1EN is 0".to_owned()
        } else if reset.is_some_and(|bit| self.blocks.rcc.holds_in_reset(bit)) {
            "RCC holds it in reset".to_owned()
        } else {
            return true;
        };
        let name = gate.peripheral();
        self.errors
            .report(now, format!("{name}: registers {access} while {why}"));
        false
    }

    /// `value`, written to `addr`, with the patches applied.
    pub fn patched(&self, addr: u32, value: u32) -> u32 {
        self.patches
            .iter()
            .filter(|p| p.address == addr)
            .fold(value, |v, p| v & !p.mask | p.value & p.mask)
    }
}

fn find(addr: u32, access: &str) -> Result<(Block, u32), Unmodelled> {
    memory_map::locate(addr).ok_or_else(|| Unmodelled {
        register: memory_map::unmodelled_name(addr),
        what: access.to_owned(),
    })
}

#[cfg(test)]
mod tests;
