//! The 11-bit channel packing shared by SBUS and DBUS: least significant bit first, without padding.

/// Returns channel `index` of `packed`. Bits past the end of the slice read 0.
pub(super) fn channel(packed: &[u8], index: u8) -> u16 {
    let first_bit = u32::from(index).wrapping_mul(11);
    let first_byte = (first_bit / 8) as usize;
    let byte = |offset: usize| {
        u32::from(
            packed
                .get(first_byte.wrapping_add(offset))
                .copied()
                .unwrap_or(0),
        )
    };
    let window = byte(0) | byte(1) << 8 | byte(2) << 16;
    ((window >> (first_bit % 8)) & 0x7FF) as u16
}

/// Scales a raw count to −1…1 with `centre` at 0. The two halves may have different spans. The result is clamped and
/// never NaN.
pub(super) fn normalise(raw: u16, low: u16, centre: u16, high: u16) -> f32 {
    let offset = f32::from(raw) - f32::from(centre);
    let span = if offset < 0.0 {
        f32::from(centre) - f32::from(low)
    } else {
        f32::from(high) - f32::from(centre)
    };
    (offset / span).clamp(-1.0, 1.0)
}
