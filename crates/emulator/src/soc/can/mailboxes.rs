//! The three transmit mailboxes and CAN_TSR (RM0090 32.7.1, 32.9.2).

use crate::{soc::can::frame_bits, wire::CanFrame};

pub const COUNT: usize = 3;

mod tsr {
    pub const RQCP: u32 = 1;
    pub const TXOK: u32 = 1 << 1;
    pub const ALST: u32 = 1 << 2;
    pub const TERR: u32 = 1 << 3;
    pub const ABRQ: u32 = 1 << 7;
    pub const RESULT: u32 = RQCP | TXOK | ALST | TERR;
}

/// How one attempt to send ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attempt {
    Sent,
    ArbitrationLost,
    Error,
}

#[derive(Clone, Copy, Debug, Default)]
struct Mailbox {
    /// TIxR, TDTxR, TDLxR, TDHxR.
    registers: [u32; 4],
    /// RQCP, TXOK, ALST and TERR of the last request.
    result: u32,
    abort_requested: bool,
    /// Order of the requests, for TXFP.
    asked: u64,
}

impl Mailbox {
    fn pending(&self) -> bool {
        self.registers[0] & 1 == 1
    }

    fn frame(&self) -> CanFrame {
        let [id, control, low, high] = self.registers;
        let extended = id & 4 != 0;
        let mut data = [0; 8];
        data[..4].copy_from_slice(&low.to_le_bytes());
        data[4..].copy_from_slice(&high.to_le_bytes());
        CanFrame {
            id: if extended { id >> 3 } else { id >> 21 },
            extended,
            remote: id & 2 != 0,
            dlc: (control & 0xF).min(8) as u8,
            data,
        }
    }

    fn finish(&mut self, result: u32) {
        self.registers[0] &= !1;
        self.abort_requested = false;
        self.result = tsr::RQCP | result;
    }
}

/// The mailboxes; one of them may be on the bus.
#[derive(Debug, Default)]
pub struct Mailboxes {
    boxes: [Mailbox; COUNT],
    on_bus: Option<usize>,
    requests: u64,
}

impl Mailboxes {
    /// Index of the mailbox to send next, with its frame.
    pub fn next(&self, by_request_order: bool) -> Option<(usize, CanFrame)> {
        let pending = || (0..COUNT).filter(|i| self.boxes[*i].pending());
        let index = if by_request_order {
            pending().min_by_key(|i| self.boxes[*i].asked)
        } else {
            pending().min_by_key(|i| frame_bits::arbitration_key(&self.boxes[*i].frame()))
        }?;
        Some((index, self.boxes[index].frame()))
    }

    /// Notes that mailbox `index` won the bus. From here on only the bus can end its transmission.
    pub fn started(&mut self, index: usize) {
        self.on_bus = Some(index);
    }

    pub fn ended(&mut self, index: usize, attempt: Attempt, retransmit: bool) {
        self.on_bus = None;
        let mailbox = &mut self.boxes[index];
        let result = match attempt {
            Attempt::Sent => tsr::TXOK,
            Attempt::ArbitrationLost => tsr::ALST,
            Attempt::Error => tsr::TERR,
        };
        if attempt == Attempt::Sent || !retransmit || mailbox.abort_requested {
            mailbox.finish(result);
        }
    }

    pub fn any_request_completed(&self) -> bool {
        self.boxes.iter().any(|b| b.result & tsr::RQCP != 0)
    }

    /// CAN_TSR.
    pub fn status(&self, by_request_order: bool) -> u32 {
        let per_box = (0..COUNT).fold(0, |all, i| {
            let b = &self.boxes[i];
            let abort = if b.abort_requested { tsr::ABRQ } else { 0 };
            all | (b.result | abort) << (8 * i) | u32::from(!b.pending()) << (26 + i)
        });
        let lowest = self.lowest_priority(by_request_order);
        let free = (0..COUNT).find(|i| !self.boxes[*i].pending());
        let code = free.or(lowest).unwrap_or(0);
        let several = self.boxes.iter().filter(|b| b.pending()).count() > 1;
        let low = if several {
            lowest.map_or(0, |i| 1 << (29 + i))
        } else {
            0
        };
        per_box | (code as u32) << 24 | low
    }

    fn lowest_priority(&self, by_request_order: bool) -> Option<usize> {
        let pending = (0..COUNT).filter(|i| self.boxes[*i].pending());
        if by_request_order {
            pending.max_by_key(|i| self.boxes[*i].asked)
        } else {
            pending.max_by_key(|i| frame_bits::arbitration_key(&self.boxes[*i].frame()))
        }
    }

    /// Writes CAN_TSR: RQCP clears its mailbox's results, and ABRQ aborts a pending request.
    pub fn write_status(&mut self, value: u32) {
        for (i, mailbox) in self.boxes.iter_mut().enumerate() {
            let bits = value >> (8 * i);
            if bits & tsr::RQCP != 0 {
                mailbox.result = 0;
            }
            mailbox.result &= !(bits & tsr::RESULT);
            if bits & tsr::ABRQ != 0 && mailbox.pending() {
                if self.on_bus == Some(i) {
                    mailbox.abort_requested = true;
                } else {
                    mailbox.finish(0);
                }
            }
        }
    }

    pub fn read(&self, index: usize, word: usize) -> u32 {
        self.boxes[index].registers[word]
    }

    /// Returns false if the mailbox is not empty, in which case silicon ignores the write.
    pub fn write(&mut self, index: usize, word: usize, value: u32) -> bool {
        let mailbox = &mut self.boxes[index];
        if mailbox.pending() {
            return false;
        }
        mailbox.registers[word] = value;
        if mailbox.pending() {
            self.requests += 1;
            mailbox.asked = self.requests;
            mailbox.result = 0;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(boxes: &mut Mailboxes, index: usize, id: u32) {
        assert!(boxes.write(index, 0, id << 21 | 1));
    }

    #[test]
    fn the_lowest_identifier_goes_first_unless_order_counts() {
        let mut boxes = Mailboxes::default();
        request(&mut boxes, 0, 0x300);
        request(&mut boxes, 1, 0x200);
        assert_eq!(boxes.next(false).map(|(i, f)| (i, f.id)), Some((1, 0x200)));
        assert_eq!(boxes.next(true).map(|(i, f)| (i, f.id)), Some((0, 0x300)));
    }

    #[test]
    fn status_after_reset_and_with_pending_mailboxes() {
        let mut boxes = Mailboxes::default();
        // RM0090 32.9.2: reset value 0x1C00_0000.
        assert_eq!(boxes.status(false), 0x1C00_0000);
        request(&mut boxes, 0, 0x300);
        request(&mut boxes, 1, 0x200);
        // TME2, CODE = 2 (the free one), LOW0 (0x300 is the lowest priority).
        assert_eq!(boxes.status(false), 1 << 28 | 2 << 24 | 1 << 29);
        boxes.started(1);
        boxes.ended(1, Attempt::Sent, true);
        assert_eq!(boxes.status(false), 1 << 27 | 1 << 28 | 1 << 24 | 0x300);
        boxes.write_status(1 << 8);
        assert_eq!(boxes.status(false), 1 << 27 | 1 << 28 | 1 << 24);
    }

    #[test]
    fn an_abort_ends_a_waiting_request_at_once_and_a_running_one_with_its_frame() {
        let mut boxes = Mailboxes::default();
        request(&mut boxes, 0, 0x200);
        boxes.write_status(1 << 7);
        assert_eq!(boxes.status(false) & 0xFF, 1);
        request(&mut boxes, 0, 0x200);
        boxes.started(0);
        boxes.write_status(1 << 7);
        assert_eq!(boxes.status(false) & 0xFF, 0x80);
        assert!(!boxes.write(0, 2, 1));
        boxes.ended(0, Attempt::Error, true);
        assert_eq!(boxes.status(false) & 0xFF, 0b1001);
    }
}
