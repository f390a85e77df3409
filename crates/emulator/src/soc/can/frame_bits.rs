//! The bits of a CAN 2.0 frame on the wire: fields, CRC-15, stuffing (Bosch CAN 2.0, part B).

use crate::wire::CanFrame;

/// CRC delimiter, ACK slot, ACK delimiter and the seven bits of end of frame, which are never stuffed.
const TAIL_BITS: u32 = 10;
/// x¹⁵ + x¹⁴ + x¹⁰ + x⁸ + x⁷ + x⁴ + x³ + 1
const CRC15: u16 = 0x4599;

/// Bits from start of frame to end of frame, stuff bits included.
pub fn length(frame: &CanFrame) -> u32 {
    let mut stuffer = Stuffer::default();
    for_each_field(frame, |value, bits| stuffer.field(value, bits));
    let crc = stuffer.crc;
    stuffer.field(u32::from(crc), 15);
    stuffer.bits + TAIL_BITS
}

/// The arbitration field as it appears bit by bit, dominant = 0. The lower value wins the bus.
pub fn arbitration_key(frame: &CanFrame) -> u32 {
    let rtr = u32::from(frame.remote);
    if frame.extended {
        // Base identifier, recessive SRR and IDE, identifier extension, RTR.
        frame.id >> 18 << 21 | 0b11 << 19 | (frame.id & 0x3_FFFF) << 1 | rtr
    } else {
        // Identifier, RTR, dominant IDE.
        frame.id << 21 | rtr << 20
    }
}

fn for_each_field(frame: &CanFrame, mut field: impl FnMut(u32, u32)) {
    let rtr = u32::from(frame.remote);
    field(0, 1);
    if frame.extended {
        field(frame.id >> 18, 11);
        field(0b11, 2);
        field(frame.id, 18);
        // RTR, r1, r0
        field(rtr << 2, 3);
    } else {
        field(frame.id, 11);
        // RTR, IDE, r0
        field(rtr << 2, 3);
    }
    field(u32::from(frame.dlc), 4);
    let carried = if frame.remote { 0 } else { frame.dlc };
    for byte in frame.data.iter().take(usize::from(carried)) {
        field(u32::from(*byte), 8);
    }
}

#[derive(Default)]
struct Stuffer {
    bits: u32,
    crc: u16,
    run_of: bool,
    run: u32,
}

impl Stuffer {
    /// The low `bits` of `value`, most significant first.
    fn field(&mut self, value: u32, bits: u32) {
        for shift in (0..bits).rev() {
            let bit = value >> shift & 1 == 1;
            self.crc = crc_next(self.crc, bit);
            self.put(bit);
        }
    }

    fn put(&mut self, bit: bool) {
        self.bits += 1;
        self.run = if bit == self.run_of { self.run + 1 } else { 1 };
        self.run_of = bit;
        if self.run == 5 {
            self.bits += 1;
            self.run_of = !bit;
            self.run = 1;
        }
    }
}

fn crc_next(crc: u16, bit: bool) -> u16 {
    let feedback = bit != (crc >> 14 & 1 == 1);
    let shifted = crc << 1 & 0x7FFF;
    if feedback { shifted ^ CRC15 } else { shifted }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(id: u32, extended: bool, data: &[u8]) -> CanFrame {
        let mut bytes = [0; 8];
        bytes[..data.len()].copy_from_slice(data);
        CanFrame {
            id,
            extended,
            remote: false,
            dlc: data.len() as u8,
            data: bytes,
        }
    }

    #[test]
    fn stuff_bits_counted_by_hand() {
        // 34 dominant bits from start of frame to the CRC (the CRC of zeros is zero): one stuff bit after each five.
        assert_eq!(length(&frame(0, false, &[])), 34 + 6 + 10);
        // 0 11111111111 000 1000 1…1 (64) 100110010001001: two stuff bits in the identifier, twelve in the data, and
        // one where the last four data bits meet the CRC's first.
        assert_eq!(length(&frame(0x7FF, false, &[0xFF; 8])), 98 + 15 + 10);
    }

    #[test]
    fn lengths_agree_with_a_polynomial_division_done_elsewhere() {
        let command = [0x12, 0x34, 0xFE, 0xDC, 0, 0, 0, 0];
        assert_eq!(length(&frame(0x200, false, &command)), 119);
        assert_eq!(length(&frame(0x555, false, &[0x55; 8])), 109);
        assert_eq!(length(&frame(0x18DA_F110, true, &[2, 0x10, 3])), 93);
    }

    #[test]
    fn lower_identifiers_and_standard_frames_win() {
        let key = |id, extended| arbitration_key(&frame(id, extended, &[]));
        assert!(key(0x200, false) < key(0x201, false));
        // The same eleven bits first: the standard frame's RTR and IDE are dominant.
        assert!(key(0x200, false) < key(0x200 << 18, true));
        assert!(key(0x1FF << 18 | 0x3_FFFF, true) < key(0x200, false));
    }

    #[test]
    fn a_remote_frame_carries_no_data_and_yields_to_the_data_frame_it_asks_for() {
        for extended in [false, true] {
            let data = frame(0x123, extended, &[0xFF; 8]);
            let remote = CanFrame {
                remote: true,
                ..data
            };
            assert!(arbitration_key(&data) < arbitration_key(&remote));
            // 34 or 54 bits up to the CRC's last and 10 after it; at most one stuff bit for four of them (Bosch CAN 2.0).
            let (least, stuffed) = if extended { (64, 13) } else { (44, 8) };
            assert!((least..=least + stuffed).contains(&length(&remote)));
            assert!(arbitration_key(&remote) < arbitration_key(&frame(0x124, extended, &[])));
        }
    }
}
