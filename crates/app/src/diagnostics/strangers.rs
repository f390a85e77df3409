//! What is heard on the CAN buses and meant for nobody here: a motor that does not answer may be talking under another
//! number.

use crate::domain::{BusId, StandardId};

/// Identifiers under which C620 report, number 1 to 8.
const ESC_REPORTS: core::ops::RangeInclusive<u16> = 0x201..=0x208;

/// Of one bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct BusStrangers {
    /// Frames since boot; wraps.
    pub frames: u32,
    /// Identifier of the last one; means nothing before the first.
    pub last_id: u16,
    /// The last one that a wheel's speed controller reports under, 0 = none yet.
    pub esc_id: u16,
}

/// Index = `BusId`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Strangers {
    pub buses: [BusStrangers; 2],
}

impl Strangers {
    pub fn note(&mut self, bus: BusId, id: StandardId) {
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
    fn each_bus_keeps_its_last_stranger_and_its_last_speed_controller() {
        let mut strangers = Strangers::default();
        for (bus, id) in [
            (BusId::Can1, 0x205),
            (BusId::Can1, 0x123),
            (BusId::Can2, 0x200),
            (BusId::Can2, 0x209),
        ] {
            strangers.note(bus, StandardId::new(id).unwrap());
        }
        let [can1, can2] = strangers.buses;
        assert_eq!((can1.frames, can1.last_id, can1.esc_id), (2, 0x123, 0x205));
        assert_eq!((can2.frames, can2.last_id, can2.esc_id), (2, 0x209, 0));
    }
}
