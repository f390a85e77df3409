//! Fault confinement: error counters and CAN_ESR (RM0090 32.7.6, ISO 11898-1).

/// Last error code, as ESR.LEC gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorCode {
    Stuff = 1,
    Acknowledgement = 3,
    /// Sent recessive, saw dominant.
    BitRecessive = 4,
    /// Sent dominant, saw recessive.
    BitDominant = 5,
}

/// Transmit and receive error counters and the states they lead to.
#[derive(Clone, Copy, Debug, Default)]
pub struct ErrorCounters {
    /// Above 255 = bus-off.
    tec: u16,
    rec: u16,
    lec: u8,
    bus_off: bool,
}

impl ErrorCounters {
    pub fn is_bus_off(&self) -> bool {
        self.bus_off
    }

    pub fn is_passive(&self) -> bool {
        self.tec > 127 || self.rec > 127
    }

    /// CAN_ESR.
    pub fn register(&self) -> u32 {
        let warning = self.tec >= 96 || self.rec >= 96;
        u32::from(warning)
            | u32::from(self.is_passive()) << 1
            | u32::from(self.bus_off) << 2
            | u32::from(self.lec) << 4
            | u32::from(self.tec.min(255)) << 16
            | u32::from(self.rec.min(255)) << 24
    }

    /// EWGF, EPVF and BOFF as bits 0–2, as ESR and IER order them.
    pub fn states(&self) -> u32 {
        self.register() & 7
    }

    /// Software may set LEC to 7 to see the next update.
    pub fn write_lec(&mut self, value: u8) {
        self.lec = value & 7;
    }

    pub fn transmitted(&mut self) {
        self.tec = self.tec.saturating_sub(1);
        self.lec = 0;
    }

    pub fn received(&mut self) {
        // A passive receiver returns to a value between 119 and 127.
        self.rec = if self.rec > 127 {
            127
        } else {
            self.rec.saturating_sub(1)
        };
        self.lec = 0;
    }

    pub fn transmit_error(&mut self, code: ErrorCode) {
        self.lec = code as u8;
        // Alone on the bus: a passive transmitter's counter stands still on missing acknowledges.
        if code == ErrorCode::Acknowledgement && self.is_passive() {
            return;
        }
        self.tec += 8;
        self.bus_off |= self.tec > 255;
    }

    /// An error this receiver is the first to flag: one for the error, eight for the dominant bit that the others'
    /// flags leave after its own.
    pub fn receive_error(&mut self) {
        self.lec = ErrorCode::Stuff as u8;
        self.rec = (self.rec + 9).min(255);
    }

    /// 128 times eleven recessive bits have passed.
    pub fn recovered(&mut self) {
        *self = Self {
            lec: self.lec,
            ..Self::default()
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_two_bit_errors_lead_to_bus_off() {
        let mut errors = ErrorCounters::default();
        let mut states = Vec::new();
        for n in 1..=32 {
            errors.transmit_error(ErrorCode::BitDominant);
            if states.last().is_none_or(|(_, s)| *s != errors.states()) {
                states.push((n, errors.states()));
            }
        }
        // ISO 11898-1: warning at 96 = 12 × 8, passive at 128 = 16 × 8, bus-off above 255 = 32 × 8.
        assert_eq!(states, [(1, 0), (12, 1), (16, 3), (32, 7)]);
        assert_eq!(errors.register() >> 4 & 7, 5);
    }

    #[test]
    fn missing_acknowledges_stop_at_error_passive() {
        let mut errors = ErrorCounters::default();
        for _ in 0..100 {
            errors.transmit_error(ErrorCode::Acknowledgement);
        }
        assert_eq!(errors.register(), 128 << 16 | 3 << 4 | 3);
        for _ in 0..128 {
            errors.transmitted();
        }
        assert_eq!(errors.register(), 0);
    }
}
