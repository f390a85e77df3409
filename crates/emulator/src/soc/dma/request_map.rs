//! The streams and channels that can serve a request (RM0090 tables 42 and 43).

use crate::soc::dma_request::DmaRequest;

/// One cell of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// 1 or 2.
    pub controller: u8,
    /// 0–7.
    pub stream: u8,
    /// CHSEL, 0–7.
    pub channel: u8,
}

/// A request line: its name in messages, the data register its transfers address, and where it can be served.
#[derive(Debug)]
pub struct RequestLine {
    pub request: DmaRequest,
    pub name: &'static str,
    pub data_register: u32,
    pub slots: &'static [Slot],
}

const fn dma1(stream: u8, channel: u8) -> Slot {
    Slot {
        controller: 1,
        stream,
        channel,
    }
}

const fn dma2(stream: u8, channel: u8) -> Slot {
    Slot {
        controller: 2,
        stream,
        channel,
    }
}

macro_rules! line {
    ($request:ident, $name:literal, $data_register:literal, [$($slot:expr),+]) => {
        RequestLine {
            request: DmaRequest::$request,
            name: $name,
            data_register: $data_register,
            slots: &[$($slot),+],
        }
    };
}

/// Request lines in the order of `DmaRequest`.
pub const LINES: [RequestLine; 11] = [
    line!(Spi1Rx, "SPI1_RX", 0x4001_300C, [dma2(0, 3), dma2(2, 3)]),
    line!(Spi1Tx, "SPI1_TX", 0x4001_300C, [dma2(3, 3), dma2(5, 3)]),
    line!(Usart1Rx, "USART1_RX", 0x4001_1004, [dma2(2, 4), dma2(5, 4)]),
    line!(Usart1Tx, "USART1_TX", 0x4001_1004, [dma2(7, 4)]),
    line!(Usart3Rx, "USART3_RX", 0x4000_4804, [dma1(1, 4)]),
    line!(Usart3Tx, "USART3_TX", 0x4000_4804, [dma1(3, 4), dma1(4, 7)]),
    line!(Usart6Rx, "USART6_RX", 0x4001_1404, [dma2(1, 5), dma2(2, 5)]),
    line!(Usart6Tx, "USART6_TX", 0x4001_1404, [dma2(6, 5), dma2(7, 5)]),
    line!(I2c3Rx, "I2C3_RX", 0x4000_5C10, [dma1(2, 3)]),
    line!(I2c3Tx, "I2C3_TX", 0x4000_5C10, [dma1(4, 3)]),
    line!(Adc3, "ADC3", 0x4001_224C, [dma2(0, 2), dma2(1, 2)]),
];

/// The request line that a stream serves when set to `channel`, if the board's firmware may use it.
pub fn line_of(slot: Slot) -> Option<&'static RequestLine> {
    LINES.iter().find(|line| line.slots.contains(&slot))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_stand_in_the_order_of_the_requests() {
        for (index, line) in LINES.iter().enumerate() {
            assert_eq!(line.request as usize, index, "{}", line.name);
        }
    }

    #[test]
    fn no_cell_of_the_table_is_given_twice() {
        let mut cells: Vec<_> = LINES
            .iter()
            .flat_map(|line| line.slots)
            .map(|s| (s.controller, s.stream, s.channel))
            .collect();
        let all = cells.len();
        cells.sort_unstable();
        cells.dedup();
        assert_eq!(cells.len(), all);
    }

    #[test]
    fn the_c_boards_assignment_is_possible() {
        // Hardware sheet 2.2.
        let name = |slot| line_of(slot).map(|line| line.name);
        assert_eq!(name(dma1(1, 4)), Some("USART3_RX"));
        assert_eq!(name(dma2(2, 3)), Some("SPI1_RX"));
        assert_eq!(name(dma2(3, 3)), Some("SPI1_TX"));
        assert_eq!(name(dma2(7, 4)), Some("USART1_TX"));
        assert_eq!(name(dma1(2, 3)), Some("I2C3_RX"));
        assert_eq!(name(dma1(1, 5)), None);
    }
}
