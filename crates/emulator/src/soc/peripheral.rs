//! The interface of a register block, and what the block may access.

use crate::{
    soc::{
        board::Board, board_errors::BoardErrors, clocks::ClockTree, dma_request::DmaRequests,
        irq::IrqLines, pins::PinBank, scheduler::Scheduler,
    },
    time::Ps,
};

/// An access the model does not implement: it stops the run, with this text and the PC's function.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{register}: {what} is not modelled")]
pub struct Unmodelled {
    /// `"USART3.GTPR"`.
    pub register: String,
    /// `"write of 0x00000100"`, `"bit SCEN"`.
    pub what: String,
}

/// Everything a peripheral may touch besides its own registers.
pub(crate) struct Ctx<'a> {
    pub now: Ps,
    pub scheduler: &'a mut Scheduler,
    pub irq: &'a mut IrqLines,
    pub dma: &'a mut DmaRequests,
    pub clocks: &'a mut ClockTree,
    pub pins: &'a mut PinBank,
    pub board: &'a mut dyn Board,
    pub errors: &'a mut BoardErrors,
}

/// A register block. Offsets are from its base address; narrower accesses come with their size in bytes.
pub(crate) trait Peripheral {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled>;
    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled>;
    /// An event this block asked the scheduler for.
    fn event(&mut self, tag: u32, ctx: &mut Ctx<'_>);
    /// Registers and request lines back to their reset values (RCC reset bit or system reset). The scheduler keeps
    /// what was asked before: the block must ignore such events when they come.
    fn reset(&mut self, ctx: &mut Ctx<'_>);
    /// RCC changed a frequency; `ctx.clocks` is the new tree. What ran until `ctx.now` ran at the old one.
    fn clocks_changed(&mut self, _ctx: &mut Ctx<'_>) {}
    /// The board was brought up to `ctx.now`: a wire into this block may have changed.
    fn board_advanced(&mut self, _ctx: &mut Ctx<'_>) {}
}
