//! Live values: pages of six bytes that can be read at any time, even while armed.
//!
//! [`LIVE_PAGES`] lists them. The fields of a page are packed one after the other from the lowest bit up, so fields
//! of whole bytes are little-endian. Unused bits are 0. The same table packs on the robot and unpacks on the PC.

mod packing;
mod pages;

pub use pages::{JOINTS, LIVE_PAGES, WHEELS};

use super::Refusal;
use crate::{diagnostics::DiagnosticsSnapshot, motor::layout::MotorLayout};

/// Size of a page in bytes.
pub const PAGE_BYTES: usize = 6;

/// The data that pages show.
#[derive(Clone, Copy, Debug)]
pub struct LiveSource<'a> {
    /// The report of the last tick.
    pub diagnostics: &'a DiagnosticsSnapshot,
    /// The motors of the robot.
    pub layout: &'static MotorLayout,
}

/// A page, or one for each of several equal parts of the robot.
#[derive(Debug)]
pub struct LivePage {
    /// Number of the first part's page; the others follow. It never changes.
    pub first: u8,
    /// Name of the page.
    pub name: &'static str,
    /// Names of the parts; a single empty name if the page is about the whole robot.
    pub parts: &'static [&'static str],
    /// The fields from the lowest bit up. Released fields never change; new ones use free bits.
    pub fields: &'static [LiveField],
}

/// One value of a page.
#[derive(Debug)]
pub struct LiveField {
    /// Name within its page.
    pub name: &'static str,
    /// Unit, empty for a pure number, a choice or a set.
    pub unit: &'static str,
    /// Width in bits, 1…32.
    pub bits: u8,
    /// Type and source of the value.
    pub kind: LiveKind,
}

/// Type of a field, and its source on the robot. The second argument of a source is the number of the part.
#[derive(Debug)]
pub enum LiveKind {
    /// A whole number from 0. Larger values saturate.
    Count(fn(&LiveSource<'_>, usize) -> u32),
    /// A two's complement number. Values saturate, and the lowest number means "unknown" (NaN).
    Measure {
        /// Steps per unit.
        steps: u16,
        /// Source of the value.
        get: fn(&LiveSource<'_>, usize) -> f32,
    },
    /// One of several names, by its index.
    Choice {
        /// The names.
        names: &'static [&'static str],
        /// Source of the index.
        get: fn(&LiveSource<'_>, usize) -> u32,
    },
    /// A set of bits.
    Set {
        /// Name of a bit.
        name_of: fn(u8) -> Option<&'static str>,
        /// Source of the bits.
        get: fn(&LiveSource<'_>, usize) -> u32,
    },
}

/// A field's value on the PC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LiveValue {
    /// A whole number.
    Count(u32),
    /// A value in the field's unit; `None` if the robot does not know it.
    Measure(Option<f64>),
    /// A name, or `Err` with a number that this table does not name.
    Choice(Result<&'static str, u32>),
    /// The bits of a set.
    Set(u32),
}

/// Returns the bytes of page `number`.
pub(super) fn read(number: u8, source: &LiveSource<'_>) -> Result<[u8; PAGE_BYTES], Refusal> {
    // The control tick pays for this, so it does not search the whole table.
    let after = LIVE_PAGES.partition_point(|page| page.first <= number);
    let page = after.checked_sub(1).and_then(|place| LIVE_PAGES.get(place));
    let found = page.and_then(|page| Some((page, page.part(number)?)));
    let (page, part) = found.ok_or(Refusal::UnknownParameter)?;
    Ok(page.pack(source, part))
}

impl LivePage {
    /// Number of a part's page.
    pub fn number(&self, part: usize) -> Option<u8> {
        let part = u8::try_from(part).ok()?;
        (usize::from(part) < self.parts.len()).then(|| self.first.wrapping_add(part))
    }

    fn part(&self, number: u8) -> Option<usize> {
        let part = usize::from(number.checked_sub(self.first)?);
        (part < self.parts.len()).then_some(part)
    }
}

#[cfg(test)]
mod tests;
