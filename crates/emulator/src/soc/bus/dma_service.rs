//! Moves what the DMA streams ask for between peripherals and memory.

use robot_plant::time::Ps;

use super::Soc;
use crate::soc::{guest_memory::GuestMemory, peripheral::Unmodelled};

impl Soc {
    pub(super) fn serve_dma(&mut self, _now: Ps, _mem: &mut dyn GuestMemory) -> Result<(), Unmodelled> {
        Ok(())
    }
}
