//! Runs a filter's program on a bare Cortex-M4F with the chip's memories and no peripherals.
//!
//! Every instruction that the processor issues counts, as in the control ticks of the emulated board. Instructions of
//! an IT block whose condition fails count too, because each takes its cycle.

use std::{collections::HashMap, fs, path::Path};

use anyhow::{Context, bail, ensure};
use robot_emulator::core::{
    cost::block_cost,
    image::Image,
    memory::{self, FLASH},
};
use robot_estimator_bench::mailbox::{COUNTED, INPUT_WORDS, Input, OUTPUT_WORDS, SYMBOL};
use unicorn_engine::{Arch, ArmCpuModel, Mode, Prot, RegisterARM, Unicorn};

/// System control space. It is plain memory, as start-up only writes to it.
const PRIVATE_PERIPHERALS: (u64, u64) = (0xE000_0000, 0x0010_0000);
/// Number of the engine's exception for BKPT (QEMU's `target/arm/cpu.h`).
const BREAKPOINT: u32 = 7;
const BREAKPOINT_BYTES: u32 = 2;

/// Blocks of code that ran inside the counted function: start and size in bytes, and how often.
pub type Blocks = HashMap<(u32, u32), u64>;

/// The cost and the result of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    pub instructions: u32,
    pub q_wxyz: [f32; OUTPUT_WORDS],
}

#[derive(Default)]
struct Counter {
    entry: u32,
    /// The counted function's return address while it runs, else `None`.
    returns_to: Option<u32>,
    instructions: u32,
    known: HashMap<(u32, u32), u16>,
    notes_blocks: bool,
    blocks: Blocks,
    at_breakpoint: bool,
}

pub struct Program {
    engine: Unicorn<'static, Counter>,
    mailbox: u32,
    resume_at: u32,
    /// Size of all that is programmed into flash.
    pub flash_bytes: usize,
}

impl Program {
    /// Boots the program up to its first wait for input.
    pub fn boot(elf: &Path) -> anyhow::Result<Self> {
        let bytes = fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
        let image = Image::parse(&bytes)?;
        let (mailbox, size) = image.static_item(SYMBOL).context("it has no mailbox")?;
        ensure!(
            size as usize == 4 * (INPUT_WORDS + OUTPUT_WORDS),
            "its mailbox has {size} bytes: built from other sources than this program?"
        );
        let entry = image.functions(COUNTED, "").next();
        let entry = entry.context("it has no function to count")?;
        let mut engine = engine(entry)?;
        for segment in &image.segments {
            engine.mem_write(segment.address.into(), &segment.data)?;
        }
        let flash_bytes = image.segments.iter().map(|s| s.data.len()).sum();
        let mut program = Self {
            engine,
            mailbox,
            resume_at: 0,
            flash_bytes,
        };
        let [stack, reset] = program.words::<2>(FLASH.base)?;
        program.engine.reg_write(RegisterARM::SP, stack.into())?;
        program.go_on(reset & !1)?;
        Ok(program)
    }

    /// Sets whether the program notes from now on which blocks the counted function runs.
    pub fn note_blocks(&mut self, yes: bool) {
        self.engine.get_data_mut().notes_blocks = yes;
    }

    /// Returns the blocks noted since the last call.
    pub fn take_blocks(&mut self) -> Blocks {
        std::mem::take(&mut self.engine.get_data_mut().blocks)
    }

    pub fn tick(&mut self, input: &Input) -> anyhow::Result<Tick> {
        let bytes: Vec<u8> = input
            .to_words()
            .into_iter()
            .flat_map(u32::to_le_bytes)
            .collect();
        self.engine.mem_write(self.mailbox.into(), &bytes)?;
        let counter = self.engine.get_data_mut();
        counter.instructions = 0;
        self.go_on(self.resume_at)?;
        let answer = self.mailbox + bytes.len() as u32;
        let q_wxyz = self.words::<OUTPUT_WORDS>(answer)?.map(f32::from_bits);
        let counter = self.engine.get_data();
        Ok(Tick {
            instructions: counter.instructions,
            q_wxyz,
        })
    }

    /// Runs to the next breakpoint.
    fn go_on(&mut self, from: u32) -> anyhow::Result<()> {
        self.engine.get_data_mut().at_breakpoint = false;
        let result = self.engine.emu_start(u64::from(from | 1), 0, 0, 0);
        let pc = self.engine.reg_read(RegisterARM::PC)? as u32;
        if !self.engine.get_data().at_breakpoint {
            bail!("the program failed at 0x{pc:08X}: {result:?}");
        }
        self.resume_at = pc + BREAKPOINT_BYTES;
        Ok(())
    }

    fn words<const N: usize>(&self, address: u32) -> anyhow::Result<[u32; N]> {
        let mut words = [0; N];
        for (place, word) in (u64::from(address)..).step_by(4).zip(&mut words) {
            let mut bytes = [0; 4];
            self.engine.mem_read(place, &mut bytes)?;
            *word = u32::from_le_bytes(bytes);
        }
        Ok(words)
    }
}

fn engine(entry: u32) -> anyhow::Result<Unicorn<'static, Counter>> {
    let counter = Counter {
        entry,
        ..Counter::default()
    };
    let mut engine = Unicorn::new_with_data(Arch::ARM, Mode::THUMB, counter)?;
    engine.ctl_set_cpu_model(ArmCpuModel::CORTEX_M4 as i32)?;
    memory::map(&mut engine)?;
    let (base, size) = PRIVATE_PERIPHERALS;
    engine.mem_map(base, size, Prot::READ | Prot::WRITE)?;
    engine.add_block_hook(1, 0, block_begins)?;
    engine.add_intr_hook(|engine, number| {
        engine.get_data_mut().at_breakpoint = number == BREAKPOINT;
        engine.emu_stop().ok();
    })?;
    Ok(engine)
}

/// Adds the block's instructions if it belongs to a run of the counted function.
fn block_begins(engine: &mut Unicorn<'_, Counter>, address: u64, size: u32) {
    let start = address as u32;
    let counter = engine.get_data();
    if counter.returns_to == Some(start) {
        engine.get_data_mut().returns_to = None;
        return;
    }
    if counter.returns_to.is_none() {
        if start != counter.entry {
            return;
        }
        let link = engine.reg_read(RegisterARM::LR).unwrap_or_default() as u32;
        engine.get_data_mut().returns_to = Some(link & !1);
    }
    let block = (start, size);
    let known = engine.get_data().known.get(&block).copied();
    let instructions = known.unwrap_or_else(|| {
        let code = engine.mem_read_as_vec(address, size as usize);
        let count = block_cost(&code.unwrap_or_default()).instructions;
        engine.get_data_mut().known.insert(block, count);
        count
    });
    let counter = engine.get_data_mut();
    counter.instructions += u32::from(instructions);
    if counter.notes_blocks {
        *counter.blocks.entry(block).or_default() += 1;
    }
}

#[cfg(test)]
mod tests;
