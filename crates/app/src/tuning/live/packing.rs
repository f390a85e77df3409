//! Packs fields into the bits of a page and unpacks them.

use super::{LiveField, LiveKind, LivePage, LiveSource, LiveValue, PAGE_BYTES};

impl LivePage {
    #[inline(never)]
    pub(super) fn pack(&self, source: &LiveSource<'_>, part: usize) -> [u8; PAGE_BYTES] {
        let mut page: u64 = 0;
        let mut place: u32 = 0;
        for field in self.fields {
            page |= u64::from(field.raw(source, part)).wrapping_shl(place);
            place = place.wrapping_add(field.bits.into());
        }
        let [a, b, c, d, e, f, ..] = page.to_le_bytes();
        [a, b, c, d, e, f]
    }

    /// Returns each field with its value, in order.
    pub fn unpack(
        &self,
        bytes: [u8; PAGE_BYTES],
    ) -> impl Iterator<Item = (&'static LiveField, LiveValue)> {
        let [a, b, c, d, e, f] = bytes;
        let mut rest = u64::from_le_bytes([a, b, c, d, e, f, 0, 0]);
        self.fields.iter().map(move |field| {
            let value = field.value(rest as u32 & field.mask());
            rest = rest.checked_shr(field.bits.into()).unwrap_or(0);
            (field, value)
        })
    }
}

impl LiveField {
    /// All ones in the field's width.
    fn mask(&self) -> u32 {
        u32::MAX.wrapping_shr(self.unused_bits())
    }

    /// Fields have 1 to 32 bits, so the shift is valid.
    fn unused_bits(&self) -> u32 {
        32_u32.wrapping_sub(self.bits.into())
    }

    /// The lowest number of a measured value, which means "unknown".
    fn unknown(&self) -> u32 {
        (self.mask() >> 1).wrapping_add(1)
    }

    fn raw(&self, source: &LiveSource<'_>, part: usize) -> u32 {
        let mask = self.mask();
        match self.kind {
            LiveKind::Count(get) => get(source, part).min(mask),
            LiveKind::Measure { steps, get } => {
                self.rounded(get(source, part) * f32::from(steps)) & mask
            }
            LiveKind::Choice { get, .. } | LiveKind::Set { get, .. } => get(source, part) & mask,
        }
    }

    fn rounded(&self, value: f32) -> u32 {
        if value.is_nan() {
            return self.unknown();
        }
        let highest = (self.mask() >> 1).cast_signed();
        let half = if value < 0.0 { -0.5 } else { 0.5 };
        let whole = (value + half) as i32;
        whole.clamp(highest.wrapping_neg(), highest).cast_unsigned()
    }

    fn value(&self, raw: u32) -> LiveValue {
        match self.kind {
            LiveKind::Count(_) => LiveValue::Count(raw),
            LiveKind::Measure { steps, .. } => {
                let unused = self.unused_bits();
                let shifted = raw.wrapping_shl(unused).cast_signed();
                let value = f64::from(shifted.wrapping_shr(unused)) / f64::from(steps);
                LiveValue::Measure((raw != self.unknown()).then_some(value))
            }
            LiveKind::Choice { names, .. } => {
                LiveValue::Choice(names.get(raw as usize).copied().ok_or(raw))
            }
            LiveKind::Set { .. } => LiveValue::Set(raw),
        }
    }
}
