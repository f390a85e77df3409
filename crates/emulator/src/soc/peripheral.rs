//! The interface of a register block, and what the block may access.

use crate::{
    soc::{
        board::Board, board_errors::BoardErrors, clocks::ClockTree, dma_request::DmaRequests,
        irq::IrqLines, pins::PinBank, scheduler::Scheduler,
    },
    time::Ps,
};

/// An access that the model does not implement. It stops the run with this text and the function at the PC.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{register}: {what} is not modelled")]
pub struct Unmodelled {
    /// The register, such as `"USART3.GTPR"`.
    pub register: String,
    /// The access, such as `"write of 0x00000100"` or `"bit SCEN"`.
    pub what: String,
}

/// Everything that a peripheral may access besides its own registers.
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
    /// Handles an event that this block has scheduled.
    fn event(&mut self, tag: u32, ctx: &mut Ctx<'_>);
    /// Sets registers and request lines to their reset values, after an RCC reset bit or a system reset. The scheduler
    /// keeps events scheduled before, which the block must ignore.
    fn reset(&mut self, ctx: &mut Ctx<'_>);
    /// Handles a change of frequency. `ctx.clocks` is the new tree; until `ctx.now` the old one was in force.
    fn clocks_changed(&mut self, _ctx: &mut Ctx<'_>) {}
    /// Called after the board has advanced to `ctx.now`. An input of this block may have changed.
    fn board_advanced(&mut self, _ctx: &mut Ctx<'_>) {}
}
