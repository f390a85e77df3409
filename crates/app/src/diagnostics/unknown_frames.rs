//! Counts frames with unknown identifiers. A motor that does not answer may be sending under another number.

use crate::domain::{BusId, StandardId};

/// Identifiers of C620 reports, number 1 to 8.
const ESC_REPORTS: core::ops::RangeInclusive<u16> = 0x201..=0x208;

/// Unknown frames on one bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct BusUnknownFrames {
    /// Number of frames since boot; it wraps.
    pub frames: u32,
    /// Identifier of the last one, meaningless before the first.
    pub last_id: u16,
    /// The last identifier of a wheel's speed controller, 0 = none yet.
    pub esc_id: u16,
}

/// Unknown frames on both buses. Index = `BusId`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct UnknownFrames {
    /// One entry for each bus.
    pub buses: [BusUnknownFrames; 2],
}

impl UnknownFrames {
    /// Counts a frame.
    pub fn count(&mut self, bus: BusId, id: StandardId) {
        let [can1, can2] = &mut self.buses;
        let noted = match bus {
            BusId::Can1 => can1,
            BusId::Can2 => can2,
        };
        noted.frames = noted.frames.wrapping_add(1);
        noted.last_id = id.raw();
        if ESC_REPORTS.contains(&id.raw()) {
            noted.esc_id = id.raw();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bus_records_its_last_unknown_frame_and_speed_controller() {
        let mut strangers = UnknownFrames::default();
        for (bus, id) in [
            (BusId::Can1, 0x205),
            (BusId::Can1, 0x123),
            (BusId::Can2, 0x200),
            (BusId::Can2, 0x209),
        ] {
            strangers.count(bus, StandardId::new(id).unwrap());
        }
        let [can1, can2] = strangers.buses;
        assert_eq!((can1.frames, can1.last_id, can1.esc_id), (2, 0x123, 0x205));
        assert_eq!((can2.frames, can2.last_id, can2.esc_id), (2, 0x209, 0));
    }
}
