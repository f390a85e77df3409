//! Moves the items of the DMA streams between peripherals and memory.

use std::ops::Range;

use super::Soc;
use crate::{
    soc::{
        dma::{
            Beat,
            stream::{Direction, Item},
        },
        guest_memory::GuestMemory,
        peripheral::{Ctx, Unmodelled},
    },
    time::Ps,
};

/// Memories as the DMA controllers see them (RM0090 2.3).
const SRAM: Range<u32> = 0x2000_0000..0x2002_0000;
const FLASH: Range<u32> = 0x0800_0000..0x0810_0000;
const CCM: Range<u32> = 0x1000_0000..0x1001_0000;

/// More items than any peripheral takes at one instant. Beyond this the request line must be stuck.
const STUCK: usize = 1000;

impl Soc {
    /// Serves every high request line that has a ready stream.
    pub(super) fn serve_dma(
        &mut self,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<(), Unmodelled> {
        for _ in 0..STUCK {
            if !self.dma_requests.any() {
                return Ok(());
            }
            let Some((controller, beat)) = self.blocks.next_dma_beat(&self.dma_requests) else {
                self.blocks
                    .check_unserved(&self.dma_requests, now, &mut self.errors);
                return Ok(());
            };
            self.carry_out(controller, &beat, now, mem)?;
        }
        Err(Unmodelled {
            register: "DMA".to_owned(),
            what: "a request that never falls".to_owned(),
        })
    }

    fn carry_out(
        &mut self,
        controller: u8,
        beat: &Beat,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<(), Unmodelled> {
        let problem = match problem(beat) {
            Some(problem) => Some(problem),
            None => self.move_item(&beat.item, now, mem)?,
        };
        let (blocks, mut ctx) = split!(self, now);
        match problem {
            None => blocks.dma(controller).beat_done(beat.stream, &mut ctx),
            Some(problem) => {
                let place = format!(
                    "DMA{controller} stream {} ({})",
                    beat.stream, beat.line.name
                );
                ctx.errors
                    .report(now, format!("{place}: {problem}: transfer error"));
                blocks.dma(controller).beat_failed(beat.stream, &mut ctx);
            }
        }
        blocks.note_dma_served(beat.line);
        Ok(())
    }

    /// Moves one item. If memory does not answer, the error is returned.
    fn move_item(
        &mut self,
        item: &Item,
        now: Ps,
        mem: &mut dyn GuestMemory,
    ) -> Result<Option<String>, Unmodelled> {
        let size = usize::from(item.size);
        let mut bytes = [0; 4];
        let answered = match item.direction {
            Direction::PeripheralToMemory => {
                bytes = self.dma_peripheral(item, None, now)?.to_le_bytes();
                mem.write(item.memory_addr, &bytes[..size])
            }
            Direction::MemoryToPeripheral => {
                let answered = mem.read(item.memory_addr, &mut bytes[..size]);
                if answered {
                    self.dma_peripheral(item, Some(u32::from_le_bytes(bytes)), now)?;
                }
                answered
            }
        };
        Ok((!answered).then(|| format!("no memory at {:#010x}", item.memory_addr)))
    }

    /// Reads the data register, or writes `value` to it.
    fn dma_peripheral(
        &mut self,
        item: &Item,
        value: Option<u32>,
        now: Ps,
    ) -> Result<u32, Unmodelled> {
        let (block, offset) = super::find(item.peripheral_addr, "DMA access")?;
        if !self.answers(block, offset, "moved by DMA", now) {
            return Ok(0);
        }
        let (blocks, mut ctx) = split!(self, now);
        let peripheral = blocks.get(block);
        match value {
            None => peripheral.read(offset, item.size, &mut ctx),
            Some(value) => peripheral
                .write(offset, item.size, value, &mut ctx)
                .map(|()| 0),
        }
    }
}

/// Why silicon would not move this item.
fn problem(beat: &Beat) -> Option<String> {
    let Item {
        peripheral_addr,
        memory_addr,
        size,
        ..
    } = beat.item;
    if peripheral_addr != beat.line.data_register {
        return Some(format!(
            "PAR is {peripheral_addr:#010x}, the data register is {:#010x}",
            beat.line.data_register
        ));
    }
    if memory_addr % u32::from(size) != 0 {
        return Some(format!(
            "memory address {memory_addr:#010x} is not aligned to {size} bytes"
        ));
    }
    let reads = beat.item.direction == Direction::MemoryToPeripheral;
    match memory_addr {
        _ if SRAM.contains(&memory_addr) => None,
        // Flash is read-only for DMA.
        _ if FLASH.contains(&memory_addr) && reads => None,
        _ if CCM.contains(&memory_addr) => Some(format!(
            "memory address {memory_addr:#010x} is in CCM, which DMA cannot reach"
        )),
        _ => Some(format!(
            "memory address {memory_addr:#010x} is no memory DMA can reach"
        )),
    }
}
