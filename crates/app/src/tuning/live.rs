//! Live values over the tuning channel: pages of six bytes that anyone may read at any time, armed too.
//!
//! [`LIVE_PAGES`] lists them. A page is its fields packed one after the other from the lowest bit up, so what fills whole
//! bytes is little-endian; bits of no field are 0. The same table packs on the robot and unpacks on the PC.

mod packing;
mod pages;

pub use pages::{JOINTS, LIVE_PAGES, WHEELS};

use super::Refusal;
use crate::{diagnostics::DiagnosticsSnapshot, motor::layout::MotorLayout};

/// Bytes of a page.
pub const PAGE_BYTES: usize = 6;

/// What pages show.
#[derive(Clone, Copy, Debug)]
pub struct LiveSource<'a> {
    pub diagnostics: &'a DiagnosticsSnapshot,
    pub layout: &'static MotorLayout,
}

/// A page, or one for each of several equal parts of the robot.
#[derive(Debug)]
pub struct LivePage {
    /// Number of the first part's page; the others follow. Never changes.
    pub first: u8,
    pub name: &'static str,
    /// Names of the parts; one without a name if the page is about the whole robot.
    pub parts: &'static [&'static str],
    /// From the lowest bit up. Never changed once released; new ones take bits that were free.
    pub fields: &'static [LiveField],
}

/// One value of a page.
#[derive(Debug)]
pub struct LiveField {
    /// Inside its page.
    pub name: &'static str,
    /// Empty for a pure number, a choice or a set.
    pub unit: &'static str,
    /// 1 to 32.
    pub bits: u8,
    pub kind: LiveKind,
}

/// What a field is, and where the robot takes it from; the number is that of the part.
#[derive(Debug)]
pub enum LiveKind {
    /// A whole number from 0 up. The highest stands for itself and all beyond.
    Count(fn(&LiveSource<'_>, usize) -> u32),
    /// Two's complement, in so many steps a unit. Stays at the ends; the lowest number stands for "not known" (NaN).
    Measure {
        steps: u16,
        get: fn(&LiveSource<'_>, usize) -> f32,
    },
    /// One of these, by its place.
    Choice {
        names: &'static [&'static str],
        get: fn(&LiveSource<'_>, usize) -> u32,
    },
    /// Any of these: whether each bit is set.
    Set {
        name_of: fn(u8) -> Option<&'static str>,
        get: fn(&LiveSource<'_>, usize) -> u32,
    },
}

/// A field as the PC has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LiveValue {
    Count(u32),
    /// In the field's unit; `None`: the robot does not know it.
    Measure(Option<f64>),
    /// `Err`: a number this table has no name for.
    Choice(Result<&'static str, u32>),
    Set(u32),
}

/// The reply to a request for page `number`.
pub(super) fn read(number: u8, source: &LiveSource<'_>) -> Result<[u8; PAGE_BYTES], Refusal> {
    // The control tick pays for it: no search through the whole table.
    let after = LIVE_PAGES.partition_point(|page| page.first <= number);
    let page = after.checked_sub(1).and_then(|place| LIVE_PAGES.get(place));
    let found = page.and_then(|page| Some((page, page.part(number)?)));
    let (page, part) = found.ok_or(Refusal::UnknownParameter)?;
    Ok(page.pack(source, part))
}

impl LivePage {
    /// The number of a part's page.
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
