//! Layout of the record inside a static, from the image's DWARF.

use std::borrow::Cow;

use gimli::{
    AttributeValue, DebuggingInformationEntry, Dwarf, EndianSlice, LittleEndian, Unit, UnitOffset,
    constants,
};
use object::{Object, ObjectSection};

use super::meaning::Meaning;

mod meanings;

type Slice<'d> = EndianSlice<'d, LittleEndian>;
type Die<'d> = DebuggingInformationEntry<Slice<'d>, usize>;

/// Why the layout of the record cannot be read from the image's debug information.
#[derive(Debug, thiserror::Error)]
pub enum LayoutError {
    #[error("{0}")]
    Object(#[from] object::Error),
    #[error("{0}")]
    Dwarf(#[from] gimli::Error),
    #[error("`{0}` has no debug information")]
    NoDebugInformation(String),
    #[error("`{name}` holds no `{record}`")]
    NoRecord { name: String, record: String },
    #[error("a type has no size")]
    NoSize,
    #[error("{field}: {found} cannot be read as numbers")]
    NoNumber { field: String, found: String },
}

impl LayoutError {
    fn no_number(field: &str, found: impl std::fmt::Display) -> Self {
        Self::NoNumber {
            field: field.to_owned(),
            found: found.to_string(),
        }
    }
}

/// One number of the record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Fields and array indices joined by dots.
    pub name: String,
    offset: u32,
    kind: Kind,
    /// Meaning of its values, if the image contains it.
    pub meaning: Option<Meaning>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Unsigned(u8),
    Signed(u8),
    Float(u8),
}

/// The record: its offset in its static, its length and its numbers.
#[derive(Debug)]
pub struct Record {
    pub offset: u32,
    pub size: u32,
    pub leaves: Vec<Leaf>,
}

impl Leaf {
    /// Reads the number from a copy of the whole record.
    pub fn read(&self, record: &[u8]) -> f64 {
        let at = self.offset as usize;
        let bytes = |len: u8| {
            let mut word = [0; 8];
            word[..usize::from(len)].copy_from_slice(&record[at..at + usize::from(len)]);
            u64::from_le_bytes(word)
        };
        match self.kind {
            Kind::Unsigned(len) => bytes(len) as f64,
            Kind::Signed(len) => {
                let unused = 64 - 8 * u32::from(len);
                ((bytes(len) << unused) as i64 >> unused) as f64
            }
            Kind::Float(4) => f64::from(f32::from_bits(bytes(4) as u32)),
            Kind::Float(_) => f64::from_bits(bytes(8)),
        }
    }
}

/// Finds the first record of type `record` inside the static `name`, through any cells and arrays that wrap it. Of statics with the
/// same name it is the first that holds one.
pub fn of_static(elf: &[u8], name: &str, record: &str) -> Result<Record, LayoutError> {
    let file = object::File::parse(elf)?;
    let section = |id: gimli::SectionId| -> Result<Cow<'_, [u8]>, gimli::Error> {
        let data = file
            .section_by_name(id.name())
            .and_then(|s| s.uncompressed_data().ok());
        Ok(data.unwrap_or_default())
    };
    let sections = gimli::DwarfSections::load(section)?;
    let dwarf = sections.borrow(|bytes| EndianSlice::new(bytes, LittleEndian));
    let types = Types::load(&file, &dwarf)?;
    let variables = types.variables(name)?;
    if variables.is_empty() {
        return Err(LayoutError::NoDebugInformation(name.to_owned()));
    }
    let mut found = None;
    for variable in variables {
        found = found.or(types.find(variable, record, 0)?);
    }
    let (place, offset) = found.ok_or_else(|| LayoutError::NoRecord {
        name: name.to_owned(),
        record: record.to_owned(),
    })?;
    let mut leaves = Vec::new();
    types.flatten(place, 0, "", &mut leaves)?;
    Ok(Record {
        offset,
        size: types.size(place)?,
        leaves,
    })
}

/// A type: its compilation unit and its entry there.
#[derive(Clone, Copy)]
struct Place {
    unit: usize,
    entry: UnitOffset,
}

struct Types<'d> {
    file: &'d object::File<'d>,
    dwarf: &'d Dwarf<Slice<'d>>,
    units: Vec<Unit<Slice<'d>>>,
}

struct Member {
    name: String,
    offset: u32,
    place: Place,
}

impl<'d> Types<'d> {
    fn load(file: &'d object::File<'d>, dwarf: &'d Dwarf<Slice<'d>>) -> gimli::Result<Self> {
        let mut units = Vec::new();
        let mut headers = dwarf.units();
        while let Some(header) = headers.next()? {
            units.push(dwarf.unit(header)?);
        }
        Ok(Self { file, dwarf, units })
    }

    /// Types of the statics `name`.
    fn variables(&self, name: &str) -> gimli::Result<Vec<Place>> {
        let mut found = Vec::new();
        for (index, unit) in self.units.iter().enumerate() {
            let mut entries = unit.entries();
            while let Some(entry) = entries.next_dfs()? {
                let is_it = entry.tag() == constants::DW_TAG_variable
                    && [constants::DW_AT_linkage_name, constants::DW_AT_name]
                        .iter()
                        .any(|&at| self.text(index, entry, at).is_some_and(|text| text == name));
                if is_it {
                    found.extend(self.type_of(index, entry));
                }
            }
        }
        Ok(found)
    }

    fn text(&self, unit: usize, entry: &Die<'d>, at: constants::DwAt) -> Option<String> {
        let text = self
            .dwarf
            .attr_string(&self.units[unit], entry.attr_value(at)?)
            .ok()?;
        Some(text.to_string_lossy().into_owned())
    }

    fn type_of(&self, unit: usize, entry: &Die<'d>) -> Option<Place> {
        match entry.attr_value(constants::DW_AT_type)? {
            AttributeValue::UnitRef(entry) => Some(Place { unit, entry }),
            AttributeValue::DebugInfoRef(offset) => (0..).zip(&self.units).find_map(|(unit, u)| {
                let entry = offset.to_unit_offset(&u.header)?;
                Some(Place { unit, entry })
            }),
            _ => None,
        }
    }

    fn entry(&self, place: Place) -> Result<Die<'d>, LayoutError> {
        Ok(self.units[place.unit].entry(place.entry)?)
    }

    fn size(&self, place: Place) -> Result<u32, LayoutError> {
        number(&self.entry(place)?, constants::DW_AT_byte_size).ok_or(LayoutError::NoSize)
    }

    fn children(&self, place: Place) -> Result<Vec<Die<'d>>, LayoutError> {
        let unit = &self.units[place.unit];
        let mut tree = unit.entries_tree(Some(place.entry))?;
        let mut children = tree.root()?.children();
        let mut all = Vec::new();
        while let Some(child) = children.next()? {
            all.push(child.entry().clone());
        }
        Ok(all)
    }

    fn members(&self, place: Place) -> Result<Vec<Member>, LayoutError> {
        let children = self.children(place)?;
        let members = children
            .iter()
            .filter(|c| c.tag() == constants::DW_TAG_member)
            .filter_map(|c| {
                Some(Member {
                    name: self.text(place.unit, c, constants::DW_AT_name)?,
                    offset: number(c, constants::DW_AT_data_member_location).unwrap_or(0),
                    place: self.type_of(place.unit, c)?,
                })
            });
        Ok(members.collect())
    }

    /// The struct named `record` at or below `place`, with its offset.
    fn find(
        &self,
        place: Place,
        record: &str,
        offset: u32,
    ) -> Result<Option<(Place, u32)>, LayoutError> {
        let entry = self.entry(place)?;
        match entry.tag() {
            constants::DW_TAG_structure_type | constants::DW_TAG_union_type => {}
            constants::DW_TAG_array_type => {
                let element = self.type_of(place.unit, &entry);
                return element.map_or(Ok(None), |it| self.find(it, record, offset));
            }
            _ => return Ok(None),
        }
        if self
            .text(place.unit, &entry, constants::DW_AT_name)
            .is_some_and(|name| name == record)
        {
            return Ok(Some((place, offset)));
        }
        for member in self.members(place)? {
            if let Some(found) = self.find(member.place, record, offset + member.offset)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    fn flatten(
        &self,
        place: Place,
        offset: u32,
        name: &str,
        leaves: &mut Vec<Leaf>,
    ) -> Result<(), LayoutError> {
        let entry = self.entry(place)?;
        match entry.tag() {
            constants::DW_TAG_structure_type => self.flatten_struct(place, offset, name, leaves),
            constants::DW_TAG_array_type => self.flatten_array(place, &entry, offset, name, leaves),
            constants::DW_TAG_base_type | constants::DW_TAG_enumeration_type => {
                let kind = scalar(&entry)
                    .ok_or_else(|| LayoutError::no_number(name, "what is no plain number"))?;
                leaves.push(Leaf {
                    name: name.to_owned(),
                    offset,
                    kind,
                    meaning: match entry.tag() {
                        constants::DW_TAG_enumeration_type => Some(self.states(place)?),
                        _ => None,
                    },
                });
                Ok(())
            }
            tag => Err(LayoutError::no_number(name, tag)),
        }
    }

    fn flatten_struct(
        &self,
        place: Place,
        offset: u32,
        name: &str,
        leaves: &mut Vec<Leaf>,
    ) -> Result<(), LayoutError> {
        if self
            .children(place)?
            .iter()
            .any(|c| c.tag() == constants::DW_TAG_variant_part)
        {
            return Err(LayoutError::no_number(name, "an enum with fields"));
        }
        let members = self.members(place)?;
        let is_newtype = members.len() == 1 && members[0].name == "__0";
        for member in members {
            let full = if is_newtype {
                name.to_owned()
            } else {
                join(name, member.name.strip_prefix("__").unwrap_or(&member.name))
            };
            self.flatten(member.place, offset + member.offset, &full, leaves)?;
        }
        if is_newtype && let Some(leaf) = leaves.last_mut().filter(|leaf| leaf.name == name) {
            leaf.meaning = self.flags(place)?;
        }
        Ok(())
    }

    fn flatten_array(
        &self,
        place: Place,
        entry: &Die<'d>,
        offset: u32,
        name: &str,
        leaves: &mut Vec<Leaf>,
    ) -> Result<(), LayoutError> {
        let element = self
            .type_of(place.unit, entry)
            .ok_or_else(|| LayoutError::no_number(name, "an array of nothing"))?;
        let stride = self.size(element)?;
        for i in 0..self.element_count(place)? {
            self.flatten(
                element,
                offset + i * stride,
                &join(name, &i.to_string()),
                leaves,
            )?;
        }
        Ok(())
    }
}

impl Types<'_> {
    fn element_count(&self, array: Place) -> Result<u32, LayoutError> {
        let ranges = self.children(array)?;
        let count = ranges.iter().find_map(|range| {
            number(range, constants::DW_AT_count)
                .or_else(|| number(range, constants::DW_AT_upper_bound).map(|last| last + 1))
        });
        Ok(count.unwrap_or(0))
    }
}

fn join(prefix: &str, name: &str) -> String {
    if prefix.is_empty() {
        name.to_owned()
    } else {
        format!("{prefix}.{name}")
    }
}

fn number(entry: &Die<'_>, at: constants::DwAt) -> Option<u32> {
    u32::try_from(entry.attr_value(at)?.udata_value()?).ok()
}

fn scalar(entry: &Die<'_>) -> Option<Kind> {
    let size = number(entry, constants::DW_AT_byte_size)? as u8;
    if entry.tag() == constants::DW_TAG_enumeration_type {
        return Some(Kind::Unsigned(size));
    }
    let Some(AttributeValue::Encoding(encoding)) = entry.attr_value(constants::DW_AT_encoding)
    else {
        return None;
    };
    match encoding {
        constants::DW_ATE_float => Some(Kind::Float(size)),
        constants::DW_ATE_signed | constants::DW_ATE_signed_char => Some(Kind::Signed(size)),
        constants::DW_ATE_unsigned
        | constants::DW_ATE_unsigned_char
        | constants::DW_ATE_boolean => Some(Kind::Unsigned(size)),
        _ => None,
    }
    .filter(|_| size <= 8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaf(offset: u32, kind: Kind) -> Leaf {
        Leaf {
            name: String::new(),
            offset,
            kind,
            meaning: None,
        }
    }

    #[test]
    fn numbers_of_every_kind_are_read_at_their_offsets() {
        // u16 500, i8 -2, bool true, f32 1.5, i32 -70000, little-endian.
        let record = [
            0xF4, 0x01, 0xFE, 0x01, 0x00, 0x00, 0xC0, 0x3F, 0x90, 0xEE, 0xFE, 0xFF,
        ];
        let read = |offset, kind| leaf(offset, kind).read(&record);
        assert_eq!(read(0, Kind::Unsigned(2)), 500.0);
        assert_eq!(read(2, Kind::Signed(1)), -2.0);
        assert_eq!(read(3, Kind::Unsigned(1)), 1.0);
        assert_eq!(read(4, Kind::Float(4)), 1.5);
        assert_eq!(read(8, Kind::Signed(4)), -70_000.0);
    }
}
