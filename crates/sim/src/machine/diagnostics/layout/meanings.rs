//! Names of values. For an enum these are its variants. For a set of flags, which is a newtype of an integer, the image has
//! them in a static of type `[(Flags, &str); N]`.

use std::collections::BTreeMap;

use gimli::{AttributeValue, DebuggingInformationEntry, EndianSlice, LittleEndian, constants};
use object::{Object, ObjectSection};

use super::{LayoutError, Place, Types};
use crate::machine::diagnostics::meaning::Meaning;

impl Types<'_> {
    pub(super) fn states(&self, enumeration: Place) -> Result<Meaning, LayoutError> {
        let variants = self.children(enumeration)?;
        let names = variants.iter().filter_map(|variant| {
            let value = variant.attr_value(constants::DW_AT_const_value)?;
            let name = self.text(enumeration.unit, variant, constants::DW_AT_name)?;
            Some((value.udata_value()?, name))
        });
        Ok(Meaning::States(names.collect()))
    }

    /// `None` for a newtype whose bits the image does not name.
    pub(super) fn flags(&self, newtype: Place) -> Result<Option<Meaning>, LayoutError> {
        let entry = self.entry(newtype)?;
        let Some(name) = self.text(newtype.unit, &entry, constants::DW_AT_name) else {
            return Ok(None);
        };
        let Some((table, address)) = self.table_of(&name)? else {
            return Ok(None);
        };
        Ok(self.read_table(table, address)?.map(Meaning::Flags))
    }

    /// Element type and address of the static array of `(…::flags, &str)`.
    fn table_of(&self, flags: &str) -> Result<Option<(Table, u32)>, LayoutError> {
        let ends = [format!("::{flags}, &str)"), format!("({flags}, &str)")];
        for (index, unit) in self.units.iter().enumerate() {
            let mut entries = unit.entries();
            while let Some(entry) = entries.next_dfs()? {
                if entry.tag() != constants::DW_TAG_variable {
                    continue;
                }
                let Some(address) = address(entry) else {
                    continue;
                };
                let Some(array) = self.type_of(index, entry) else {
                    continue;
                };
                let array_entry = self.entry(array)?;
                let Some(element) = self.type_of(array.unit, &array_entry) else {
                    continue;
                };
                let name = self.text(element.unit, &self.entry(element)?, constants::DW_AT_name);
                let is_array = array_entry.tag() == constants::DW_TAG_array_type;
                if is_array && name.is_some_and(|n| ends.iter().any(|end| n.ends_with(end))) {
                    let count = self.element_count(array)?;
                    return Ok(Some((Table { element, count }, address)));
                }
            }
        }
        Ok(None)
    }

    /// Single bits and their names. `None` if the file does not contain a valid table.
    fn read_table(
        &self,
        table: Table,
        address: u32,
    ) -> Result<Option<BTreeMap<u8, String>>, LayoutError> {
        let stride = self.size(table.element)?;
        let members = self.members(table.element)?;
        let at = |name: &str| members.iter().find(|m| m.name == name);
        let (Some(flag), Some(text)) = (at("__0"), at("__1")) else {
            return Ok(None);
        };
        let parts = self.members(text.place)?;
        let part = |name: &str| parts.iter().find(|p| p.name == name).map(|p| p.offset);
        let (Some(pointer), Some(length)) = (part("data_ptr"), part("length")) else {
            return Ok(None);
        };
        let row = |i: u32| {
            let row = address + i * stride;
            let bit = self.word(row + flag.offset)?;
            let start = self.word(row + text.offset + pointer)?;
            let size = self.word(row + text.offset + length)?;
            let name = String::from_utf8(self.bytes(start, size)?.to_vec()).ok()?;
            bit.is_power_of_two()
                .then(|| (bit.trailing_zeros() as u8, name))
        };
        Ok((0..table.count).map(row).collect())
    }

    fn word(&self, address: u32) -> Option<u32> {
        let bytes = self.bytes(address, 4)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?))
    }

    /// Constant data of the image.
    fn bytes(&self, address: u32, size: u32) -> Option<&[u8]> {
        self.file.sections().find_map(|section| {
            let range = section.data_range(address.into(), size.into()).ok()?;
            range.filter(|_| section.address() != 0)
        })
    }
}

/// An array in the image.
struct Table {
    element: Place,
    count: u32,
}

/// Fixed address of a static.
fn address(
    variable: &DebuggingInformationEntry<EndianSlice<'_, LittleEndian>, usize>,
) -> Option<u32> {
    const DW_OP_ADDR: u8 = 3;
    let AttributeValue::Exprloc(location) = variable.attr_value(constants::DW_AT_location)? else {
        return None;
    };
    match *location.0.slice() {
        [DW_OP_ADDR, a, b, c, d] => Some(u32::from_le_bytes([a, b, c, d])),
        _ => None,
    }
}
