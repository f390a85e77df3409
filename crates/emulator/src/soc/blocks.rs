//! Every modelled register block of the chip, and the wires between them that do not pass a bus.

use crate::soc::{
    absent::Absent,
    memory_map::{Block, Bus},
    peripheral::{Ctx, Peripheral},
    reset::ResetCause,
};

pub struct Blocks {
    pub rcc: RccPlaceholder,
    rest: Absent,
}

pub struct RccPlaceholder(Absent);
impl RccPlaceholder {
    pub fn note_reset(&mut self, _cause: ResetCause) {}
    pub fn take_frequencies_changed(&mut self) -> bool {
        false
    }
    pub fn take_resets(&mut self) -> Vec<(Bus, u32)> {
        Vec::new()
    }
}

impl Default for Blocks {
    fn default() -> Self {
        Self { rcc: RccPlaceholder(Absent("RCC")), rest: Absent("other") }
    }
}

impl Blocks {
    /// Blocks with a wire to the world that may change by itself.
    pub const WATCHING_THE_WORLD: [Block; 2] = [Block::Usart(3), Block::Can];

    pub fn get(&mut self, block: Block) -> &mut dyn Peripheral {
        match block {
            Block::Rcc => &mut self.rcc.0,
            _ => &mut self.rest,
        }
    }

    pub fn take_reset_request(&mut self) -> Option<ResetCause> {
        None
    }
    pub fn inputs_changed(&mut self, _ctx: &mut Ctx<'_>) {}
    pub fn outputs_changed(&mut self, _ctx: &mut Ctx<'_>) {}
    pub fn exti_sources_changed(&mut self, _ctx: &mut Ctx<'_>) {}
    pub fn check_flash_speed(&mut self, _ctx: &mut Ctx<'_>) {}
}
