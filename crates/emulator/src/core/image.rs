//! The firmware image: its segments in flash and its symbols.

use std::collections::BTreeMap;

use object::{
    Object, ObjectSymbol, SymbolKind,
    elf::FileHeader32,
    read::elf::{ElfFile, FileHeader, ProgramHeader},
};

use crate::core::memory::{DATA_FLASH, FLASH, FLASH_ALIAS};

/// Bytes at their load addresses in flash.
#[derive(Debug)]
pub struct Segment {
    /// Load address in flash.
    pub address: u32,
    /// Bytes that are loaded there.
    pub data: Vec<u8>,
}

/// A function or a static, by its demangled name.
#[derive(Debug)]
struct Item {
    start: u32,
    size: u32,
    name: String,
}

/// A parsed ELF file.
#[derive(Debug)]
pub struct Image {
    /// Loadable segments, in the order of the file.
    pub segments: Vec<Segment>,
    symbols: BTreeMap<String, u32>,
    functions: Vec<Item>,
    statics: Vec<Item>,
}

/// Why an image cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The file is not an ELF file for this chip.
    #[error("not a 32-bit little-endian ELF file: {0}")]
    Elf(#[from] object::Error),
    #[error("segment of {size} bytes at 0x{address:08X} is not in the 1 MiB flash")]
    /// A segment lies outside main memory.
    OutsideFlash {
        /// Load address.
        address: u32,
        /// Bytes.
        size: usize,
    },
    #[error("segment of {size} bytes at 0x{address:08X} reaches into sectors 1-3, which hold data")]
    /// A segment reaches into [`DATA_FLASH`].
    IntoDataFlash {
        /// Load address.
        address: u32,
        /// Bytes.
        size: usize,
    },
}

impl Image {
    /// Reads an ELF file for this chip.
    pub fn parse(elf: &[u8]) -> Result<Self, ImageError> {
        let file = ElfFile::<FileHeader32<object::Endianness>>::parse(elf)?;
        let mut segments = Vec::new();
        let endian = file.endian();
        for header in file.elf_header().program_headers(endian, elf)? {
            let data = header.data(endian, elf).unwrap_or_default();
            if header.p_type(endian) != object::elf::PT_LOAD || data.is_empty() {
                continue;
            }
            let address = header.p_paddr(endian);
            if !FLASH.contains(address, data.len() as u32) {
                return Err(ImageError::OutsideFlash {
                    address,
                    size: data.len(),
                });
            }
            if DATA_FLASH.overlaps(address, data.len() as u32) {
                return Err(ImageError::IntoDataFlash {
                    address,
                    size: data.len(),
                });
            }
            segments.push(Segment {
                address,
                data: data.to_vec(),
            });
        }
        Ok(Self {
            segments,
            symbols: symbols(&file),
            functions: items(&file, SymbolKind::Text),
            statics: items(&file, SymbolKind::Data),
        })
    }

    /// Address of a symbol, without the Thumb bit.
    pub fn symbol(&self, name: &str) -> Option<u32> {
        self.symbols.get(name).copied()
    }

    /// Addresses of all functions whose demangled name contains `part` and has the given end.
    pub fn functions(&self, part: &str, ends: &str) -> impl Iterator<Item = u32> {
        let fits = move |f: &&Item| f.name.contains(part) && f.name.ends_with(ends);
        self.functions.iter().filter(fits).map(|f| f.start)
    }

    /// Address and size of the first static whose demangled name ends so.
    pub fn static_item(&self, ends: &str) -> Option<(u32, u32)> {
        let item = self.statics.iter().find(|s| s.name.ends_with(ends))?;
        Some((item.start, item.size))
    }

    /// The function that contains `pc` and the offset in it, such as `main+0x12`, or the bare address if there is none.
    pub fn describe(&self, pc: u32) -> String {
        let pc = if FLASH_ALIAS.contains(pc, 1) {
            pc + FLASH.base
        } else {
            pc
        };
        let after = self.functions.partition_point(|f| f.start <= pc);
        match after.checked_sub(1).map(|i| &self.functions[i]) {
            Some(f) if pc - f.start < f.size.max(1) => {
                format!("{}+0x{:x} (0x{pc:08X})", f.name, pc - f.start)
            }
            _ => format!("0x{pc:08X}"),
        }
    }
}

type Elf<'d> = ElfFile<'d, FileHeader32<object::Endianness>>;

fn symbols(file: &Elf<'_>) -> BTreeMap<String, u32> {
    file.symbols()
        .filter(|s| s.is_definition() || s.kind() == SymbolKind::Unknown)
        .filter_map(|s| {
            Some((
                s.name().ok()?.to_owned(),
                s.address() as u32 & !u32::from(s.kind() == SymbolKind::Text),
            ))
        })
        .collect()
}

fn items(file: &Elf<'_>, kind: SymbolKind) -> Vec<Item> {
    let mut list: Vec<Item> = file
        .symbols()
        .filter(|s| s.kind() == kind)
        .filter_map(|s| {
            let name = format!("{:#}", rustc_demangle::demangle(s.name().ok()?));
            Some(Item {
                start: s.address() as u32 & !u32::from(kind == SymbolKind::Text),
                size: s.size() as u32,
                name,
            })
        })
        .collect();
    list.sort_by_key(|f| f.start);
    list
}
