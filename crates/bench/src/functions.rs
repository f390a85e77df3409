//! The share that each function has of the instructions and of the flash.

use std::{borrow::Cow, collections::HashMap, fs, path::Path};

use addr2line::{
    Context,
    gimli::{DwarfSections, EndianSlice, RunTimeEndian, SectionId},
};
use anyhow::Context as _;
use object::{File, Object, ObjectSection};

use crate::{
    measure::{Costs, Measured, WorstTick},
    program::Blocks,
};

type Names<'d> = Context<EndianSlice<'d, RunTimeEndian>>;

/// What one function costs, without the functions that are inlined into it.
#[derive(Clone, Debug, Default)]
pub struct FunctionCost {
    /// An inlined function stands with the function it is inlined into: `function < caller`.
    pub name: String,
    /// Instructions in a mean update with magnetometer.
    pub update: f64,
    /// Instructions in a mean tick without a new sample.
    pub between: f64,
    /// Instructions in the most expensive tick.
    pub worst: u64,
    pub flash_bytes: u64,
}

/// Returns the share of each function, the largest first.
pub fn shares(elf: &Path, runs: &[Measured]) -> anyhow::Result<Vec<FunctionCost>> {
    let bytes = fs::read(elf)?;
    let file = File::parse(&*bytes)?;
    let sections = DwarfSections::load(|id: SectionId| -> Result<Cow<'_, [u8]>, object::Error> {
        let section = file.section_by_name(id.name());
        let data = section.map(|section| section.uncompressed_data());
        Ok(data.transpose()?.unwrap_or_default())
    })?;
    let names =
        Context::from_dwarf(sections.borrow(|data| EndianSlice::new(data, RunTimeEndian::Little)))?;
    let code = Code::of(&file)?;
    let mut shares: HashMap<String, FunctionCost> = HashMap::new();
    let count =
        |of: fn(&Costs) -> &Vec<u32>| runs.iter().map(|run| of(&run.costs).len()).sum::<usize>();
    let updates = count(|costs| &costs.update_with_mag) as f64;
    let ticks = count(|costs| &costs.extrapolation) as f64;
    for run in runs {
        for (address, count) in code.instructions(&run.profile.updates) {
            shares.entry(function(&names, address)?).or_default().update += count as f64 / updates;
        }
        for (address, count) in code.instructions(&run.profile.between) {
            shares
                .entry(function(&names, address)?)
                .or_default()
                .between += count as f64 / ticks;
        }
    }
    let worst = runs.iter().map(|run| &run.profile.worst);
    if let Some(WorstTick { blocks, .. }) = worst.max_by_key(|tick| tick.instructions) {
        for (address, count) in code.instructions(blocks) {
            shares.entry(function(&names, address)?).or_default().worst += count;
        }
    }
    for address in code.halfwords() {
        shares
            .entry(function(&names, address)?)
            .or_default()
            .flash_bytes += 2;
    }
    let named = shares
        .into_iter()
        .map(|(name, share)| FunctionCost { name, ..share });
    let mut list: Vec<_> = named.collect();
    list.sort_by(|a, b| {
        b.update
            .total_cmp(&a.update)
            .then_with(|| a.name.cmp(&b.name))
    });
    Ok(list)
}

fn function(names: &Names<'_>, address: u64) -> anyhow::Result<String> {
    let mut frames = names.find_frames(address).skip_all_loads()?;
    let mut path: Vec<String> = Vec::new();
    while let Some(frame) = frames.next()? {
        if let Some(name) = frame.function {
            path.push(short(&name.demangle()?));
        }
    }
    path.retain(|name| !name.starts_with("core::") && !name.starts_with('<'));
    path.truncate(2);
    Ok(path.join(" < "))
}

fn short(name: &str) -> String {
    let name = format!("{:#}", rustc_demangle::demangle(name));
    name.replace("robot_app::", "").replace("estimation::", "")
}

/// The program's machine code.
struct Code<'d> {
    start: u64,
    bytes: &'d [u8],
}

impl<'d> Code<'d> {
    fn of(file: &File<'d>) -> anyhow::Result<Self> {
        let text = file.section_by_name(".text").context("it has no .text")?;
        Ok(Self {
            start: text.address(),
            bytes: text.data()?,
        })
    }

    fn halfwords(&self) -> impl Iterator<Item = u64> {
        (self.start..self.start + self.bytes.len() as u64).step_by(2)
    }

    /// Returns the address of each instruction in the blocks, and how often it ran.
    fn instructions(&self, blocks: &Blocks) -> Vec<(u64, u64)> {
        let mut list = Vec::new();
        for (&(start, size), &runs) in blocks {
            let mut at = u64::from(start);
            let end = at + u64::from(size);
            while at < end {
                list.push((at, runs));
                at += self.instruction_bytes(at);
            }
        }
        list
    }

    /// Returns the length of a Thumb instruction: four bytes if its upper five bits say so, else two.
    fn instruction_bytes(&self, address: u64) -> u64 {
        let high = self.bytes.get((address - self.start) as usize + 1);
        if high.is_some_and(|byte| byte >> 3 >= 0b11101) {
            4
        } else {
            2
        }
    }
}
