//! Baud rate and word of a UART. All have eight data bits.

use embassy_stm32::pac::usart::{Usart, regs, vals};

/// The format of a line.
#[derive(Clone, Copy)]
pub struct UartFormat {
    pub baud: u32,
    pub parity: Parity,
    pub stop_bits: StopBits,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Parity {
    None,
    Even,
}

#[derive(Clone, Copy)]
pub enum StopBits {
    One,
    Two,
}

impl UartFormat {
    /// Sets up and enables `uart`, both halves of which are still off. Its clock must run at `clock_hz`.
    pub fn apply(self, uart: Usart, clock_hz: u32) {
        // With 16-fold oversampling BRR is the divider in sixteenths: clock / baud (RM0090 30.3.4).
        let rounded = clock_hz
            .saturating_add(self.baud / 2)
            .checked_div(self.baud);
        uart.brr().write_value(regs::Brr(rounded.unwrap_or(0)));
        uart.cr2().write(|w| {
            w.set_stop(match self.stop_bits {
                StopBits::One => vals::Stop::STOP1,
                StopBits::Two => vals::Stop::STOP2,
            });
        });
        uart.cr1().write(|w| {
            if self.parity == Parity::Even {
                // The word counts the parity bit: nine bits with eight of data.
                w.set_m0(vals::M0::BIT9);
                w.set_pce(true);
                w.set_ps(vals::Ps::EVEN);
            }
            w.set_ue(true);
        });
    }
}
