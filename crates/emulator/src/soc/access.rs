//! Byte, half-word and word accesses to 32-bit registers.

/// The register and the bits of it that an access reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    pub register: u32,
    shift: u32,
    mask: u32,
}

impl Access {
    pub fn new(offset: u32, size: u8) -> Self {
        let shift = 8 * (offset & 3);
        let mask = match size {
            1 => 0xFF << shift,
            2 => 0xFFFF << shift,
            _ => u32::MAX,
        };
        Self {
            register: offset & !3,
            shift,
            mask,
        }
    }

    /// The accessed part of a register's value.
    pub fn read_of(self, value: u32) -> u32 {
        (value & self.mask) >> self.shift
    }

    /// The register's value with the accessed part replaced.
    pub fn written_over(self, old: u32, value: u32) -> u32 {
        old & !self.mask | value << self.shift & self.mask
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_access_touches_only_its_bytes() {
        let upper_half = Access::new(0x1A, 2);
        assert_eq!(upper_half.register, 0x18);
        assert_eq!(upper_half.read_of(0xABCD_1234), 0xABCD);
        assert_eq!(
            upper_half.written_over(0x1111_2222, 0xFFFF_BEEF),
            0xBEEF_2222
        );
        assert_eq!(
            Access::new(0x19, 1).written_over(0x1111_2222, 0x33),
            0x1111_3322
        );
    }
}
