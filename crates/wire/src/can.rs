/// One CAN 2.0 frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanFrame {
    /// 11 bits, or 29 where `extended`.
    pub id: u32,
    /// The identifier has 29 bits (IDE).
    pub extended: bool,
    /// A remote frame (RTR): it asks for data and carries none.
    pub remote: bool,
    /// Number of data bytes, 0 to 8.
    pub dlc: u8,
    /// The first `dlc` bytes are sent; none of a remote frame.
    pub data: [u8; 8],
}

impl CanFrame {
    /// A data frame with a standard identifier and eight bytes.
    pub const fn with_data(id: u32, data: [u8; 8]) -> Self {
        Self {
            id,
            extended: false,
            remote: false,
            dlc: 8,
            data,
        }
    }
}
