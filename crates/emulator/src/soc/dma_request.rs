//! Request lines from the peripherals to the DMA controllers (RM0090 tables 42 and 43).

/// A peripheral's request for one transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DmaRequest {
    Spi1Rx,
    Spi1Tx,
    Usart1Rx,
    Usart1Tx,
    Usart3Rx,
    Usart3Tx,
    Usart6Rx,
    Usart6Tx,
    I2c3Rx,
    I2c3Tx,
    Adc3,
}

/// Level of each request line. A DMA stream serves a line while it is high.
#[derive(Debug, Default)]
pub struct DmaRequests {
    level: u32,
    last: u32,
}

impl DmaRequests {
    pub fn set(&mut self, request: DmaRequest, high: bool) {
        let bit = 1u32 << request as u32;
        if high {
            self.level |= bit;
        } else {
            self.level &= !bit;
        }
    }

    pub fn get(&self, request: DmaRequest) -> bool {
        self.level >> (request as u32) & 1 == 1
    }

    /// The end-of-transfer signal to the peripheral (EOT_1): the stream that serves `request` has one item left.
    pub fn set_last(&mut self, request: DmaRequest, last: bool) {
        let bit = 1u32 << request as u32;
        if last {
            self.last |= bit;
        } else {
            self.last &= !bit;
        }
    }

    pub fn last(&self, request: DmaRequest) -> bool {
        self.last >> (request as u32) & 1 == 1
    }

    pub fn any(&self) -> bool {
        self.level != 0
    }
}
