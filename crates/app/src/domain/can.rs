//! CAN 2.0A data frames.

/// The two buses of the C board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum BusId {
    /// CAN1.
    Can1 = 0,
    /// CAN2.
    Can2 = 1,
}

impl BusId {
    /// Both buses, by number.
    pub const ALL: [Self; 2] = [Self::Can1, Self::Can2];
}

/// The bus of each motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotorBuses {
    /// Both wheels share a bus.
    pub wheels: BusId,
    /// The joints' buses, in the order of `ChassisCommand`.
    pub joints: [BusId; 4],
}

/// An 11-bit identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct StandardId(u16);

impl StandardId {
    /// Returns `None` above 0x7FF.
    pub const fn new(raw: u16) -> Option<Self> {
        if raw <= 0x7FF { Some(Self(raw)) } else { None }
    }

    /// The identifier as a number.
    pub const fn raw(self) -> u16 {
        self.0
    }
}

/// A data frame with an 11-bit identifier. It is aligned to words, as frames are copied often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C, align(4))]
pub struct CanFrame {
    data: [u8; 8],
    id: StandardId,
    len: u8,
}

impl CanFrame {
    /// A full frame of eight bytes.
    pub const fn new(id: StandardId, data: [u8; 8]) -> Self {
        Self { id, len: 8, data }
    }

    /// Returns `None` if `payload` is longer than eight bytes.
    pub fn from_payload(id: StandardId, payload: &[u8]) -> Option<Self> {
        let mut data = [0; 8];
        data.get_mut(..payload.len())?.copy_from_slice(payload);
        let len = u8::try_from(payload.len()).ok()?;
        Some(Self { id, len, data })
    }

    /// The identifier.
    pub const fn id(&self) -> StandardId {
        self.id
    }

    /// The bytes on the wire, 0 to 8 of them.
    pub fn payload(&self) -> &[u8] {
        self.data.get(..usize::from(self.len)).unwrap_or(&self.data)
    }

    /// The bytes on the wire, padded with zeros.
    pub const fn padded_payload(&self) -> [u8; 8] {
        self.data
    }

    /// All eight bytes, or `None` for a shorter frame.
    pub fn full_payload(&self) -> Option<[u8; 8]> {
        (self.len == 8).then_some(self.data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_have_eleven_bits() {
        assert_eq!(StandardId::new(0x7FF).map(StandardId::raw), Some(0x7FF));
        assert_eq!(StandardId::new(0x800), None);
    }

    #[test]
    fn a_payload_keeps_its_length() {
        let id = StandardId::new(1).unwrap();
        let frame = CanFrame::from_payload(id, &[1, 2, 3]).unwrap();
        assert_eq!(frame.payload(), [1, 2, 3]);
        assert_eq!(frame.full_payload(), None);
        assert_eq!(CanFrame::from_payload(id, &[0; 9]), None);
    }
}
