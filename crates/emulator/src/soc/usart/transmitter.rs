//! The transmit half: data register, shift register and TXD (RM0090 30.3.2).

use super::{SENT, Usart, cr1, sr};
use crate::{
    soc::{peripheral::Ctx, routing, scheduler::Target},
    time::Ps,
    wire::UartChar,
};

/// What waits and what is on its way out.
#[derive(Debug, Default)]
pub struct Transmitter {
    /// The transmit data register.
    waiting: Option<u16>,
    /// The transmit shift register.
    sending: Option<Sending>,
}

/// A character on its way out.
#[derive(Clone, Copy, Debug)]
struct Sending {
    character: UartChar,
    ends_at: Ps,
    /// Whether its pin carries it.
    heard: bool,
}

impl Usart {
    pub(super) fn write_dr(&mut self, data: u16, ctx: &mut Ctx<'_>) {
        if self.transmitter.waiting.is_some() {
            let message = format!(
                "USART{}: DR written while TXE is 0: the character waiting there is lost",
                self.number
            );
            ctx.errors.report(ctx.now, message);
        }
        self.sr &= !(sr::TXE | self.shown & sr::TC);
        self.shown &= !sr::TC;
        self.transmitter.waiting = Some(data);
        self.start_sending(ctx);
    }

    /// Moves the character that waits into the shift register if that is empty.
    pub(super) fn start_sending(&mut self, ctx: &mut Ctx<'_>) {
        let on = cr1::UE | cr1::TE;
        if self.transmitter.sending.is_some() || self.cr1 & on != on {
            return;
        }
        let Some(framing) = self.framing(ctx) else {
            return;
        };
        let Some(data) = self.transmitter.waiting.take() else {
            return;
        };
        self.sr |= sr::TXE;
        let signal = self.tx_signal();
        let sending = Sending {
            character: UartChar {
                start: ctx.now,
                byte: data as u8,
                format: framing.format(),
            },
            ends_at: ctx.now + framing.char_time(),
            heard: signal.is_some_and(|signal| routing::check(signal, ctx)),
        };
        self.transmitter.sending = Some(sending);
        let at = sending.ends_at;
        ctx.scheduler.at(at, Target::Usart(self.number), SENT);
    }

    /// Ends the character in the shift register if its time is over.
    pub(super) fn character_sent(&mut self, ctx: &mut Ctx<'_>) {
        let over = |sending: &mut Sending| sending.ends_at <= ctx.now;
        let Some(sent) = self.transmitter.sending.take_if(over) else {
            return;
        };
        if sent.heard {
            ctx.board.uart_sent(self.port(), sent.character, ctx.now);
        }
        self.start_sending(ctx);
        if self.transmitter.sending.is_none() {
            self.sr |= sr::TC;
        }
    }

    /// TE is cleared, which corrupts a character that is being sent.
    pub(super) fn stop_sending(&mut self, ctx: &mut Ctx<'_>) {
        if self.transmitter.sending.take().is_some() {
            let message = format!(
                "USART{}: TE cleared while a character is sent: it is lost",
                self.number
            );
            ctx.errors.report(ctx.now, message);
            self.sr |= sr::TC;
        }
    }
}
