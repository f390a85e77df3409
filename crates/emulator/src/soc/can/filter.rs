//! The 28 acceptance filter banks shared by both controllers (RM0090 32.7.4, 32.9.4).

use std::ops::Range;

use super::reg;
use crate::{soc::peripheral::Ctx, wire::CanFrame};

const BANKS: usize = 28;
const FMR_RESERVED: u32 = 0x2A1C_0000;
const ALL_BANKS: u32 = 0x0FFF_FFFF;

/// Destination of an accepted frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Accepted {
    pub fifo: usize,
    /// Filter match index, numbered per FIFO over all of the controller's banks, whether active or not.
    pub index: u8,
}

/// The filter registers, FMR to FxRx.
#[derive(Debug)]
pub struct Filters {
    initialising: bool,
    /// First bank of CAN2.
    split: usize,
    list_mode: u32,
    scale_32: u32,
    to_fifo_1: u32,
    active: u32,
    banks: [[u32; 2]; BANKS],
}

/// One filter of a bank: identifier bits and the mask of those that count, both laid out like CAN_RIxR.
#[derive(Clone, Copy, Debug)]
struct Filter {
    id: u32,
    mask: u32,
}

impl Default for Filters {
    fn default() -> Self {
        Self::new()
    }
}

impl Filters {
    pub fn new() -> Self {
        Self {
            initialising: true,
            split: 14,
            list_mode: 0,
            scale_32: 0,
            to_fifo_1: 0,
            active: 0,
            banks: [[0; 2]; BANKS],
        }
    }

    /// A filter register by its offset from CAN1's base.
    pub fn read(&self, offset: u32) -> Option<u32> {
        Some(match offset {
            reg::FMR => FMR_RESERVED | (self.split as u32) << 8 | u32::from(self.initialising),
            reg::FM1R => self.list_mode,
            reg::FS1R => self.scale_32,
            reg::FFA1R => self.to_fifo_1,
            reg::FA1R => self.active,
            _ => {
                let (bank, word) = bank_word(offset)?;
                self.banks[bank][word]
            }
        })
    }

    pub fn write(&mut self, offset: u32, value: u32, ctx: &mut Ctx<'_>) -> Option<()> {
        match offset {
            reg::FMR => {
                self.initialising = value & 1 == 1;
                self.split = (value >> 8 & 0x3F) as usize;
            }
            reg::FM1R | reg::FS1R | reg::FFA1R if !self.initialising => {
                ctx.errors.report(
                    ctx.now,
                    "CAN1: FM1R, FS1R or FFA1R written while FINIT is 0: ignored",
                );
            }
            reg::FM1R => self.list_mode = value & ALL_BANKS,
            reg::FS1R => self.scale_32 = value & ALL_BANKS,
            reg::FFA1R => self.to_fifo_1 = value & ALL_BANKS,
            reg::FA1R => self.active = value & ALL_BANKS,
            _ => {
                let (bank, word) = bank_word(offset)?;
                if self.initialising || self.active >> bank & 1 == 0 {
                    self.banks[bank][word] = value;
                } else {
                    let message =
                        format!("CAN1: filter bank {bank} written while it is active: ignored");
                    ctx.errors.report(ctx.now, message);
                }
            }
        }
        Some(())
    }

    /// The FIFO for `frame` at controller 0 (CAN1) or 1 (CAN2); `None` if no filter accepts the frame.
    pub fn accept(&self, controller: usize, frame: &CanFrame) -> Option<Accepted> {
        if self.initialising {
            return None;
        }
        let id = register_layout(frame);
        let mut next_index = [0u8; 2];
        let mut best: Option<((bool, bool, usize), Accepted)> = None;
        for bank in self.banks_of(controller) {
            let fifo = (self.to_fifo_1 >> bank & 1) as usize;
            for filter in self.filters_of(bank) {
                let index = next_index[fifo];
                next_index[fifo] += 1;
                let matches = (id ^ filter.id) & filter.mask == 0;
                if self.active >> bank & 1 == 0 || !matches {
                    continue;
                }
                // 32-bit before 16-bit, list before mask, then the lower number.
                let rank = (
                    self.scale_32 >> bank & 1 == 0,
                    self.list_mode >> bank & 1 == 0,
                    bank,
                );
                if best.is_none_or(|(other, _)| rank < other) {
                    best = Some((rank, Accepted { fifo, index }));
                }
            }
        }
        best.map(|(_, accepted)| accepted)
    }

    fn banks_of(&self, controller: usize) -> Range<usize> {
        let split = self.split.min(BANKS);
        if controller == 0 {
            0..split
        } else {
            split..BANKS
        }
    }

    fn filters_of(&self, bank: usize) -> Vec<Filter> {
        let [first, second] = self.banks[bank];
        let list = self.list_mode >> bank & 1 == 1;
        let halves = |word: u32| (word as u16, (word >> 16) as u16);
        match (self.scale_32 >> bank & 1 == 1, list) {
            (true, true) => vec![exact_32(first), exact_32(second)],
            (true, false) => vec![Filter {
                id: first,
                mask: second & !1,
            }],
            (false, true) => [first, second]
                .into_iter()
                .flat_map(|word| [halves(word).0, halves(word).1])
                .map(|id| Filter {
                    id: spread_16(id),
                    mask: spread_16(u16::MAX),
                })
                .collect(),
            (false, false) => [first, second]
                .into_iter()
                .map(halves)
                .map(|(id, mask)| Filter {
                    id: spread_16(id),
                    mask: spread_16(mask),
                })
                .collect(),
        }
    }
}

fn exact_32(id: u32) -> Filter {
    Filter { id, mask: !1 }
}

/// Converts a 16-bit filter to the 32-bit layout: STDID, RTR, IDE and EXID bits 17 to 15.
fn spread_16(half: u16) -> u32 {
    let half = u32::from(half);
    half >> 5 << 21 | (half >> 4 & 1) << 1 | (half >> 3 & 1) << 2 | (half & 7) << 18
}

/// The identifier in the layout of CAN_RIxR.
pub fn register_layout(frame: &CanFrame) -> u32 {
    let identifier = if frame.extended {
        frame.id << 3 | 4
    } else {
        frame.id << 21
    };
    identifier | u32::from(frame.remote) << 1
}

fn bank_word(offset: u32) -> Option<(usize, usize)> {
    let word = offset.checked_sub(reg::F0R1)? as usize / 4;
    (word < 2 * BANKS).then_some((word / 2, word % 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standard(id: u32) -> CanFrame {
        CanFrame {
            id,
            extended: false,
            remote: false,
            dlc: 0,
            data: [0; 8],
        }
    }

    #[test]
    fn even_and_odd_identifiers_part_into_two_fifos() {
        // Bank 0: identifier bit 0 = 0 → FIFO 0; bank 1: bit 0 = 1 → FIFO 1; IDE must be 0.
        let mut filters = Filters::new();
        filters.initialising = false;
        filters.scale_32 = 0b11;
        filters.to_fifo_1 = 0b10;
        filters.active = 0b11;
        filters.banks[0] = [0, 1 << 21 | 4];
        filters.banks[1] = [1 << 21, 1 << 21 | 4];
        assert_eq!(
            filters.accept(0, &standard(0x202)),
            Some(Accepted { fifo: 0, index: 0 })
        );
        assert_eq!(
            filters.accept(0, &standard(0x201)),
            Some(Accepted { fifo: 1, index: 0 })
        );
        assert_eq!(filters.accept(1, &standard(0x201)), None);
        let extended = CanFrame {
            extended: true,
            ..standard(0x201)
        };
        assert_eq!(filters.accept(0, &extended), None);
    }

    #[test]
    fn numbering_and_priority_follow_the_manual() {
        // RM0090 figure 343: bank 0 as two 32-bit identifiers holds numbers 0 and 1, bank 1 as one 32-bit mask
        // number 2, bank 3 as four 16-bit identifiers 3 to 6; inactive banks count.
        let mut filters = Filters::new();
        filters.initialising = false;
        filters.scale_32 = 0b0011;
        filters.list_mode = 0b1001;
        filters.to_fifo_1 = 0b0100;
        filters.active = 0b1010;
        filters.banks[1] = [0x100 << 21, 0x700 << 21];
        filters.banks[3] = [0x111 << 5 | 0x222 << 21, 0x333 << 5 | 0x444 << 21];
        assert_eq!(
            filters.accept(0, &standard(0x333)),
            Some(Accepted { fifo: 0, index: 5 })
        );
        // Both match: the 32-bit mask beats the 16-bit list.
        assert_eq!(
            filters.accept(0, &standard(0x111)),
            Some(Accepted { fifo: 0, index: 2 })
        );
        assert_eq!(
            filters.accept(0, &standard(0x222)),
            Some(Accepted { fifo: 0, index: 4 })
        );
        assert_eq!(filters.accept(0, &standard(0x555)), None);
    }
}
