//! Which functions the instructions belong to.

use std::{borrow::Cow, collections::HashMap, fs, path::Path};

use addr2line::{
    Context,
    gimli::{DwarfSections, EndianSlice, RunTimeEndian, SectionId},
};
use object::{File, Object, ObjectSection};

use crate::program::Blocks;

type Slice<'d> = EndianSlice<'d, RunTimeEndian>;

/// Instructions by innermost function, inlined ones by their own name.
pub fn instructions(elf: &Path, blocks: &Blocks) -> anyhow::Result<Vec<(String, u64)>> {
    let bytes = fs::read(elf)?;
    let file = File::parse(&*bytes)?;
    let sections = DwarfSections::load(|id: SectionId| -> Result<Cow<'_, [u8]>, object::Error> {
        let section = file.section_by_name(id.name());
        Ok(section
            .map(|s| s.uncompressed_data())
            .transpose()?
            .unwrap_or_default())
    })?;
    let names =
        Context::from_dwarf(sections.borrow(|data| EndianSlice::new(data, RunTimeEndian::Little)))?;
    let mut sums: HashMap<String, u64> = HashMap::new();
    for (&(start, size), &runs) in blocks {
        for address in addresses(&file, start, size) {
            *sums.entry(function(&names, address)?).or_default() += runs;
        }
    }
    let mut list: Vec<_> = sums.into_iter().collect();
    list.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    Ok(list)
}

fn function(names: &Context<Slice<'_>>, address: u64) -> anyhow::Result<String> {
    let mut frames = names.find_frames(address).skip_all_loads()?;
    let mut path: Vec<String> = Vec::new();
    while let Some(frame) = frames.next()? {
        if let Some(name) = frame.function {
            path.push(short(&name.demangle()?));
        }
    }
    let own: Vec<_> = path
        .into_iter()
        .filter(|name| !name.starts_with("core::"))
        .take(2)
        .collect();
    Ok(own.join(" < "))
}

fn short(name: &str) -> String {
    let name = format!("{:#}", rustc_demangle::demangle(name));
    name.replace("robot_app::", "").replace("estimation::", "")
}

/// Of the block's instructions (Thumb: two bytes, or four if the upper five bits say so).
fn addresses(file: &File<'_>, start: u32, size: u32) -> Vec<u64> {
    let code = file
        .sections()
        .find_map(|s| s.data_range(start.into(), size.into()).ok().flatten());
    let code = code.unwrap_or_default();
    let mut list = Vec::new();
    let mut at = 0;
    while at + 2 <= code.len() {
        list.push(u64::from(start) + at as u64);
        let wide = code[at + 1] >> 3 >= 0b11101;
        at += if wide { 4 } else { 2 };
    }
    list
}
