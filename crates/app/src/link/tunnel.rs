//! CAN frames of the tuning channel on the serial line.

use super::{
    TUNNEL_HEADER,
    fields::{FrameReader, FrameWriter},
    scanner::Shape,
};
use crate::domain::{CanFrame, StandardId};

/// Length of a frame with a CAN frame inside.
pub const TUNNEL_LEN: usize = 12;
pub(super) static TUNNEL_SHAPE: Shape = Shape::new(TUNNEL_LEN);
/// Identifiers of the tuning channel. No other frame goes through the link.
const TUNING_IDS: core::ops::RangeInclusive<u16> = 0x7A0..=0x7AF;

/// A CAN frame on its way through the link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tunnelled(CanFrame);

impl Tunnelled {
    /// Returns `None` if the frame does not belong to the tuning channel.
    pub fn new(frame: CanFrame) -> Option<Self> {
        TUNING_IDS
            .contains(&frame.id().raw())
            .then_some(Self(frame))
    }

    /// The CAN frame.
    pub const fn can_frame(&self) -> CanFrame {
        self.0
    }

    /// The frame on the line.
    pub fn encode(&self) -> [u8; TUNNEL_LEN] {
        let [id_low, id_high] = self.0.id().raw().to_le_bytes();
        let dlc = self.0.payload().len() as u8;
        let mut frame = FrameWriter::new(TUNNEL_HEADER);
        frame.put([id_low, id_high | dlc << 4]);
        frame.put(self.0.padded_payload());
        frame.finish()
    }

    /// Returns `None` if header or CRC is wrong, the identifier is not one of the tuning channel, the length is above
    /// 8 or the padding is not zero.
    pub fn decode(frame: &[u8; TUNNEL_LEN]) -> Option<Self> {
        let mut fields = FrameReader::new(TUNNEL_HEADER, frame)?;
        let [id_low, high] = fields.take();
        let data: [u8; 8] = fields.take();
        let (payload, padding) = data.split_at_checked(usize::from(high >> 4))?;
        if padding.iter().any(|byte| *byte != 0) {
            return None;
        }
        let id = StandardId::new(u16::from_le_bytes([id_low, high & 0x0F]))?;
        Self::new(CanFrame::from_payload(id, payload)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn can_frame(id: u16, payload: &[u8]) -> CanFrame {
        CanFrame::from_payload(StandardId::new(id).unwrap(), payload).unwrap()
    }

    #[test]
    fn only_the_tuning_channel_fits() {
        for id in 0..=0x7FF {
            let fits = Tunnelled::new(can_frame(id, &[])).is_some();
            assert_eq!(fits, (0x7A0..=0x7AF).contains(&id), "{id:#x}");
        }
    }

    #[test]
    fn every_length_survives_the_way_there_and_back() {
        for len in 0..=8 {
            let sent = Tunnelled::new(can_frame(0x7A2, &[0xFE; 8][..len])).unwrap();
            assert_eq!(Tunnelled::decode(&sent.encode()), Some(sent), "{len}");
        }
    }

    /// All values of the two bytes with identifier and length, with a correct CRC.
    #[test]
    fn only_frames_that_the_encoder_makes_are_accepted() {
        for head in 0..=u16::MAX {
            for last in [0, 1] {
                let mut frame = FrameWriter::new(TUNNEL_HEADER);
                frame.put(head.to_le_bytes());
                frame.put([7, 0, 0, 0, 0, 0, 0, last]);
                let frame = frame.finish();
                let (id, dlc) = (head & 0xFFF, head >> 12);
                let valid = (0x7A0..=0x7AF).contains(&id)
                    && dlc <= 8
                    && dlc >= if last == 1 { 8 } else { 1 };
                let decoded = Tunnelled::decode(&frame);
                assert_eq!(decoded.is_some(), valid, "{head:#06x} {last}");
                assert!(decoded.is_none_or(|sent| sent.encode() == frame));
            }
        }
    }
}
