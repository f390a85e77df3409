//! Deepest use of the stack, found by RAM that no longer holds its power-on noise.

use robot_emulator::core::{
    cpu::Cpu,
    image::Image,
    memory::{CCM, Region, SRAM, power_on_noise},
};

/// The stack's memory, from `_stack_end` up to `_stack_start`.
#[derive(Debug)]
pub struct StackWatch {
    region: Option<Region>,
}

impl StackWatch {
    /// An image without `_stack_end` may use its RAM down to the end of `.bss` and is not watched.
    pub fn of(image: &Image) -> Self {
        let bounds = image.symbol("_stack_end").zip(image.symbol("_stack_start"));
        let region = bounds.map(|(end, start)| Region {
            base: end,
            size: start.saturating_sub(end),
        });
        Self {
            region: region.filter(|r| holder(*r).is_some()),
        }
    }

    /// Bytes from the deepest changed byte to the top.
    pub fn peak(&self, cpu: &Cpu) -> u64 {
        let Some((stack, ram)) = self.region.and_then(|r| Some((r, holder(r)?))) else {
            return 0;
        };
        let mut now = vec![0; stack.size as usize];
        if !cpu.read_memory(stack.base, &mut now) {
            return 0;
        }
        let noise = power_on_noise(ram);
        let before = &noise[(stack.base - ram.base) as usize..];
        let untouched = now.iter().zip(before).take_while(|(a, b)| a == b).count();
        (now.len() - untouched) as u64
    }
}

fn holder(stack: Region) -> Option<Region> {
    [CCM, SRAM]
        .into_iter()
        .find(|ram| ram.contains(stack.base, stack.size))
}
