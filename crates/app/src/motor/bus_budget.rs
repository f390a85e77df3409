//! Worst-case load of each bus, checked when this crate is compiled.

use super::WHEEL_BUS;
use crate::domain::BusId;

/// Standard frame of eight bytes with every possible stuff bit and the pause after it.
const FRAME_BITS: u32 = 135;
/// 80 % of 1 Mb/s (design.md section 6).
const MAX_BITS_PER_SECOND: u32 = 800_000;

struct Traffic {
    bus: BusId,
    frames_per_second: u32,
}

const TRAFFIC: [Traffic; 3] = [
    // 0x200: wheel currents, once a tick.
    Traffic {
        bus: WHEEL_BUS,
        frames_per_second: 1_000,
    },
    // 0x201, 0x202: wheel feedback at the C620's own rate.
    Traffic {
        bus: WHEEL_BUS,
        frames_per_second: 1_000,
    },
    Traffic {
        bus: WHEEL_BUS,
        frames_per_second: 1_000,
    },
];

#[expect(
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    reason = "runs in the compiler, where overflow and bad indices are errors"
)]
const fn bits_per_second(bus: BusId) -> u32 {
    let mut sum = 0;
    let mut index = 0;
    while index < TRAFFIC.len() {
        if TRAFFIC[index].bus as u8 == bus as u8 {
            sum += TRAFFIC[index].frames_per_second * FRAME_BITS;
        }
        index += 1;
    }
    sum
}

const _: () = assert!(bits_per_second(BusId::Can1) <= MAX_BITS_PER_SECOND);
const _: () = assert!(bits_per_second(BusId::Can2) <= MAX_BITS_PER_SECOND);
