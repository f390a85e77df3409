//! Checks the linked image without running it.

use std::{fs, ops::Range, path::Path};

use anyhow::{Context, bail, ensure};
use object::{
    Object, ObjectSection, ObjectSegment, ObjectSymbol,
    elf::{FileHeader32, PT_LOAD},
    read::elf::{ElfFile32, ProgramHeader},
};

/// Limit from docs/figures.md#the-image.
const FLASH_BUDGET_BYTES: u64 = 256 * 1024;
const RAM_BUDGET_BYTES: u64 = 64 * 1024;

/// Main SRAM (RM0090, section 2.3.1); statics live here, the stack in CCM.
const SRAM: Range<u64> = 0x2000_0000..0x2002_0000;
const CCM: Range<u64> = 0x1000_0000..0x1001_0000;
/// Flash sectors (RM0090, table 5): 0 holds the vector table, 1–3 the parameters, 4 on the code.
const SECTOR_0: Range<u64> = 0x0800_0000..0x0800_4000;
const PARAMETERS: Range<u64> = 0x0800_4000..0x0801_0000;
const CODE_START: u64 = 0x0801_0000;

/// Helpers of the ARM run-time ABI and of compiler-rt that compute in double precision: the
/// Cortex-M4F does it in software, at hundreds of instructions each.
const SOFT_DOUBLE_PREFIXES: [&str; 8] = [
    "__aeabi_d",
    "__aeabi_cd",
    "__aeabi_f2d",
    "__aeabi_i2d",
    "__aeabi_ui2d",
    "__aeabi_l2d",
    "__aeabi_ul2d",
    "__extendsfdf2",
];

/// The parts of an image that the checks look at.
#[derive(Debug, Default, Clone)]
pub struct Image {
    /// Address ranges that are programmed into flash.
    programmed: Vec<Range<u64>>,
    sections: Vec<Section>,
    /// Demangled names.
    symbols: Vec<String>,
    /// First two words of the vector table: stack pointer and reset handler.
    reset_words: Option<[u32; 2]>,
}

#[derive(Debug, Clone)]
struct Section {
    name: String,
    range: Range<u64>,
}

/// The result of one check of the image.
pub struct Check {
    pub name: &'static str,
    /// What was found, or what is wrong.
    pub outcome: anyhow::Result<String>,
}

impl Image {
    pub fn read(elf: &Path) -> anyhow::Result<Self> {
        let bytes = fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
        Self::parse(&bytes).with_context(|| format!("{} is no usable ELF", elf.display()))
    }

    fn parse(bytes: &[u8]) -> anyhow::Result<Self> {
        let file = ElfFile32::<object::Endianness>::parse(bytes)?;
        Ok(Self {
            programmed: programmed(&file),
            sections: file
                .sections()
                .filter(|section| section.size() > 0)
                .map(|section| Section {
                    name: section.name().unwrap_or_default().to_owned(),
                    range: section.address()..section.address().saturating_add(section.size()),
                })
                .collect(),
            symbols: file
                .symbols()
                .filter_map(|symbol| symbol.name().ok())
                .map(|name| format!("{:#}", rustc_demangle::demangle(name)))
                .collect(),
            reset_words: file
                .segments()
                .find_map(|segment| segment.data_range(SECTOR_0.start, 8).ok().flatten())
                .and_then(two_words),
        })
    }

    pub fn checks(&self) -> Vec<Check> {
        let check = |name, outcome| Check { name, outcome };
        vec![
            check("flash budget", self.flash_budget()),
            check("static RAM budget", self.ram_budget()),
            check("vector table in sector 0", self.vector_table()),
            check("code from sector 4", self.code_start()),
            check("parameter sectors left free", self.parameters_free()),
            check("no allocator", self.absent("allocator", is_allocator)),
            check(
                "no double precision",
                self.absent("soft-double", is_soft_double),
            ),
        ]
    }

    fn flash_budget(&self) -> anyhow::Result<String> {
        let used = self.programmed.iter().map(length).sum();
        within(used, FLASH_BUDGET_BYTES)
    }

    fn ram_budget(&self) -> anyhow::Result<String> {
        let in_sram = |section: &&Section| SRAM.contains(&section.range.start);
        let sections = self.sections.iter().filter(in_sram);
        within(
            sections.map(|section| length(&section.range)).sum(),
            RAM_BUDGET_BYTES,
        )
    }

    fn vector_table(&self) -> anyhow::Result<String> {
        let table = self.section(".vector_table")?;
        if table.start != SECTOR_0.start || table.end > SECTOR_0.end {
            bail!("it lies at {}", shown(table));
        }
        let [stack, reset] = self.reset_words.context("it has no contents")?;
        if u64::from(stack) != CCM.end {
            bail!("the stack starts at {stack:#010x}, not at the top of CCM");
        }
        let text = self.section(".text")?;
        let is_thumb = reset % 2 == 1;
        if !is_thumb || !text.contains(&u64::from(reset)) {
            bail!("reset goes to {reset:#010x}, which is not in .text");
        }
        Ok(shown(table))
    }

    fn code_start(&self) -> anyhow::Result<String> {
        let text = self.section(".text")?;
        ensure!(text.start == CODE_START, ".text lies at {}", shown(text));
        Ok(shown(text))
    }

    fn parameters_free(&self) -> anyhow::Result<String> {
        let overlaps =
            |range: &&Range<u64>| range.start < PARAMETERS.end && PARAMETERS.start < range.end;
        match self.programmed.iter().find(overlaps) {
            None => Ok(shown(&PARAMETERS)),
            Some(range) => bail!("the image programs {}", shown(range)),
        }
    }

    fn absent(&self, what: &str, is_unwanted: fn(&str) -> bool) -> anyhow::Result<String> {
        let found: Vec<_> = self
            .symbols
            .iter()
            .map(String::as_str)
            .filter(|name| is_unwanted(name))
            .collect();
        let count = self.symbols.len();
        ensure!(count > 0, "the image has no symbols to look at");
        ensure!(found.is_empty(), "{what} symbols: {}", found.join(", "));
        Ok(format!("none of {count} symbols"))
    }

    fn section(&self, name: &str) -> anyhow::Result<&Range<u64>> {
        let found = self.sections.iter().find(|section| section.name == name);
        found
            .map(|section| &section.range)
            .with_context(|| format!("there is no section {name}"))
    }
}

/// Returns where the load segments go in flash. Initialised data counts where it is stored (its physical address), not
/// where start-up copies it.
fn programmed(file: &ElfFile32<'_, object::Endianness>) -> Vec<Range<u64>> {
    let endian = file.endian();
    file.elf_program_headers()
        .iter()
        .filter(
            |header: &&<FileHeader32<_> as object::read::elf::FileHeader>::ProgramHeader| {
                header.p_type(endian) == PT_LOAD && header.p_filesz(endian) > 0
            },
        )
        .map(|header| {
            let start = u64::from(header.p_paddr(endian));
            start..start + u64::from(header.p_filesz(endian))
        })
        .collect()
}

fn two_words(bytes: &[u8]) -> Option<[u32; 2]> {
    let (words, _) = bytes.as_chunks::<4>();
    match words {
        [stack, reset, ..] => Some([u32::from_le_bytes(*stack), u32::from_le_bytes(*reset)]),
        _ => None,
    }
}

/// True for a name from the `alloc` crate or from the allocator interface that it calls.
fn is_allocator(name: &str) -> bool {
    const INTERFACE: [&str; 5] = [
        "__rust_alloc",
        "__rust_realloc",
        "__rdl_",
        "__rg_",
        "malloc",
    ];
    let starts_a_path = |at: usize| {
        let before = name.get(..at).and_then(|text| text.chars().next_back());
        !before.is_some_and(|last| last == ':' || last == '_' || last.is_alphanumeric())
    };
    INTERFACE.iter().any(|prefix| name.starts_with(prefix))
        || name
            .match_indices("alloc::")
            .any(|(at, _)| starts_a_path(at))
}

fn is_soft_double(name: &str) -> bool {
    let compiler_rt = name.starts_with("__") && (name.ends_with("df3") || name.ends_with("df2"));
    compiler_rt
        || SOFT_DOUBLE_PREFIXES
            .iter()
            .any(|prefix| name.starts_with(prefix))
}

fn within(used: u64, budget: u64) -> anyhow::Result<String> {
    let text = format!("{used} of {budget} bytes");
    ensure!(used <= budget, text);
    Ok(text)
}

fn length(range: &Range<u64>) -> u64 {
    range.end.saturating_sub(range.start)
}

fn shown(range: &Range<u64>) -> String {
    format!("{:#010x}..{:#010x}", range.start, range.end)
}

#[cfg(test)]
mod tests;
