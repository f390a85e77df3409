//! The bits of a CAN 2.0 data frame on the wire: fields, CRC-15, stuffing (Bosch CAN 2.0, part B).

use robot_plant::wire::CanFrame;

/// CRC delimiter, ACK slot, ACK delimiter and the seven bits of end of frame: never stuffed.
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

/// Lower wins the bus: the arbitration field as it appears bit by bit, dominant = 0.
pub fn arbitration_key(frame: &CanFrame) -> u32 {
    if frame.extended {
        // Base identifier, recessive SRR and IDE, identifier extension.
        frame.id >> 18 << 20 | 0b11 << 18 | frame.id & 0x3_FFFF
    } else {
        frame.id << 20
    }
}

fn for_each_field(frame: &CanFrame, mut field: impl FnMut(u32, u32)) {
    field(0, 1);
    if frame.extended {
        field(frame.id >> 18, 11);
        field(0b11, 2);
        field(frame.id, 18);
        // RTR, r1, r0
        field(0, 3);
    } else {
        field(frame.id, 11);
        // RTR, IDE, r0
        field(0, 3);
    }
    field(u32::from(frame.dlc), 4);
    for byte in frame.data.iter().take(usize::from(frame.dlc)) {
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
