//! Records of the firmware other than its diagnostics, read from guest memory by the image's debug information.

use std::path::Path;

use robot_emulator::core::image::Image;

use super::{Machine, MachineError, diagnostics::record_of_static};
use crate::machine::diagnostics::{LayoutError, Record};

/// A record inside a static of an image. Arrays of it lie behind one another.
#[derive(Debug)]
pub struct StaticRecord {
    address: u32,
    record: Record,
}

impl StaticRecord {
    /// Finds the first record of a type inside the static whose full name, such as `robot_firmware::main::CONTROL`, ends so.
    ///
    /// # Errors
    /// There is no such static or record, or the image does not tell.
    pub fn find(elf: &Path, ends: &str, record: &str) -> Result<Self, MachineError> {
        let bytes = std::fs::read(elf).map_err(|source| MachineError::Read {
            path: elf.to_owned(),
            source,
        })?;
        let image = Image::parse(&bytes)?;
        let missing = || LayoutError::NoDebugInformation(ends.to_owned());
        let (base, _) = image.static_item(ends).ok_or_else(missing)?;
        let name = ends.rsplit("::").next().unwrap_or(ends);
        let record = record_of_static(&bytes, name, record)?;
        Ok(Self {
            address: base + record.offset,
            record,
        })
    }

    /// Place of a number in what [`Machine::read`] returns. Its name joins fields and indices by dots.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.record.leaves.iter().position(|leaf| leaf.name == name)
    }

    /// Names in the order of [`Machine::read`].
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.record.leaves.iter().map(|leaf| leaf.name.as_str())
    }
}

impl Machine {
    /// Numbers of element `index` of an array of records, as they stand in memory now.
    pub fn read(&self, record: &StaticRecord, index: u32) -> Vec<f64> {
        let StaticRecord { address, record } = record;
        let mut bytes = vec![0; record.size as usize];
        self.cpu
            .read_memory(address + index * record.size, &mut bytes);
        let numbers = record.leaves.iter().map(|leaf| leaf.read(&bytes));
        numbers.collect()
    }
}
