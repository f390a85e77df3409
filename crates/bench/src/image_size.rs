//! Memory of the shipped image.

use std::{fs, ops::Range, path::Path};

use anyhow::Context;
use object::{
    Object, ObjectSection,
    elf::{FileHeader32, PT_LOAD},
    read::elf::{ElfFile32, ProgramHeader},
};
use serde::Serialize;

/// Main SRAM (RM0090, section 2.3.1); the stack lies in CCM and does not count.
const SRAM: Range<u64> = 0x2000_0000..0x2002_0000;

#[derive(Clone, Copy, Debug, Serialize)]
pub struct ImageSize {
    pub flash_bytes: u64,
    /// Size of the statics.
    pub ram_bytes: u64,
}

impl ImageSize {
    pub fn read(elf: &Path) -> anyhow::Result<Self> {
        let bytes = fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
        let file = ElfFile32::<object::Endianness>::parse(&*bytes)?;
        let endian = file.endian();
        type Header =
            <FileHeader32<object::Endianness> as object::read::elf::FileHeader>::ProgramHeader;
        let loaded = |header: &&Header| header.p_type(endian) == PT_LOAD;
        let headers = file.elf_program_headers().iter().filter(loaded);
        let statics = file
            .sections()
            .filter(|section| SRAM.contains(&section.address()));
        Ok(Self {
            flash_bytes: headers
                .map(|header| u64::from(header.p_filesz(endian)))
                .sum(),
            ram_bytes: statics.map(|section| section.size()).sum(),
        })
    }
}
