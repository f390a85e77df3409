//! USART1, USART3 and USART6 as asynchronous UARTs (RM0090 chapter 30).

use self::receiver::{Framing, Receiver};
use crate::{
    soc::{
        access::Access,
        clocks::cycles_to_ps,
        dma_request::DmaRequest,
        irq::Irq,
        peripheral::{Ctx, Peripheral, Unmodelled},
        routing,
        scheduler::Target,
        signals::Signal,
    },
    time::Ps,
    wire::{Parity, UartChar},
};

mod receiver;
mod registers;
mod waveform;

use registers::{cr1, cr3, reg, sr};

/// Tags of scheduled events. An event that is not due any more is ignored.
const RECEIVED: u32 = 0;
const IDLE: u32 = 1;
const SENT: u32 = 2;

/// One USART.
#[derive(Debug)]
pub struct Usart {
    number: u8,
    sr: u32,
    /// Flags that were set when SR was read. The next read of DR clears them.
    shown: u32,
    dr: u16,
    brr: u32,
    cr1: u32,
    cr2: u32,
    cr3: u32,
    receiver: Receiver,
    received_at: Option<Ps>,
    idle_at: Option<Ps>,
    /// A character waits in the transmit data register.
    waiting_to_send: bool,
    sent_at: Option<Ps>,
}

impl Usart {
    /// USART1, USART3 or USART6.
    pub fn new(number: u8) -> Self {
        Self {
            number,
            sr: sr::TXE | sr::TC,
            shown: 0,
            dr: 0,
            brr: 0,
            cr1: 0,
            cr2: 0,
            cr3: 0,
            receiver: Receiver::default(),
            received_at: None,
            idle_at: None,
            waiting_to_send: false,
            sent_at: None,
        }
    }

    fn irq(&self) -> Irq {
        match self.number {
            1 => 37,
            3 => 39,
            _ => 71,
        }
    }

    fn dma(&self) -> (DmaRequest, DmaRequest) {
        match self.number {
            1 => (DmaRequest::Usart1Rx, DmaRequest::Usart1Tx),
            3 => (DmaRequest::Usart3Rx, DmaRequest::Usart3Tx),
            _ => (DmaRequest::Usart6Rx, DmaRequest::Usart6Tx),
        }
    }

    /// USART3_TX is not modelled as a signal.
    fn tx_signal(&self) -> Option<Signal> {
        match self.number {
            1 => Some(Signal::Usart1Tx),
            3 => None,
            _ => Some(Signal::Usart6Tx),
        }
    }

    /// The framing in the registers; `None` while the baud generator is stopped.
    fn framing(&self, ctx: &Ctx<'_>) -> Option<Framing> {
        let clock_hz = if self.number == 3 {
            ctx.clocks.pclk1_hz
        } else {
            ctx.clocks.pclk2_hz
        };
        let oversampling_8 = self.cr1 & cr1::OVER8 != 0;
        let clocks_per_bit = if oversampling_8 {
            (self.brr >> 4) * 8 + (self.brr & 7)
        } else {
            self.brr
        };
        if clocks_per_bit == 0 {
            return None;
        }
        Some(Framing {
            bit: cycles_to_ps(u64::from(clocks_per_bit), clock_hz),
            word_bits: if self.cr1 & cr1::M != 0 { 9 } else { 8 },
            parity: match self.cr1 & (cr1::PCE | cr1::PS) {
                cr1::PCE => Parity::Even,
                both if both == cr1::PCE | cr1::PS => Parity::Odd,
                _ => Parity::None,
            },
            two_stop_bits: self.cr2 >> 12 & 3 >= 2,
            oversampling_8,
            one_sample: self.cr3 & cr3::ONEBIT != 0,
        })
    }

    fn receiving(&self) -> bool {
        let on = cr1::UE | cr1::RE;
        self.cr1 & on == on
    }

    fn plan_reception(&mut self, ctx: &mut Ctx<'_>) {
        if !self.receiving() || self.received_at.is_some() {
            return;
        }
        let Some(framing) = self.framing(ctx) else {
            return;
        };
        if let Some(at) = self.receiver.completes_at(&framing) {
            self.received_at = Some(at);
            self.idle_at = None;
            ctx.scheduler
                .at(at.max(ctx.now), Target::Usart(self.number), RECEIVED);
        }
    }

    fn plan_idle(&mut self, at: Ps, ctx: &mut Ctx<'_>) {
        self.idle_at = Some(at);
        ctx.scheduler.at(at, Target::Usart(self.number), IDLE);
    }

    fn character_ended(&mut self, ctx: &mut Ctx<'_>) {
        self.received_at = None;
        let Some(framing) = self.framing(ctx) else {
            return;
        };
        if let Some((start, got)) = self.receiver.finish(&framing) {
            self.sr |= if got.framing_error { sr::FE } else { 0 }
                | if got.parity_error { sr::PE } else { 0 }
                | if got.noise { sr::NE } else { 0 };
            if self.sr & sr::RXNE != 0 {
                self.sr |= sr::ORE;
            } else {
                self.dr = got.data;
                self.sr |= sr::RXNE;
            }
            self.report_mismatch(
                &framing,
                got.framing_error || got.parity_error || got.noise,
                ctx,
            );
            self.plan_idle(start + 2 * framing.char_time(), ctx);
        }
        self.plan_reception(ctx);
    }

    /// Reports the sender's format if the receiver is set to another one.
    fn report_mismatch(&mut self, framing: &Framing, flagged: bool, ctx: &mut Ctx<'_>) {
        let Some(sent) = self.receiver.last_char() else {
            return;
        };
        let baud = (crate::time::SECOND + framing.bit / 2) / framing.bit;
        let data_bits = framing.word_bits - u8::from(framing.parity != Parity::None);
        let same_word = data_bits == sent.format.data_bits && framing.parity == sent.format.parity;
        let off_by = baud.abs_diff(u64::from(sent.format.baud)) * 100;
        let wrong_rate = off_by > 3 * u64::from(sent.format.baud);
        // With equal settings an error flag is noise on the line, not a wrong setting.
        if !wrong_rate && (same_word || !flagged) {
            return;
        }
        let effect = if flagged {
            "framing, parity or noise errors"
        } else {
            "wrong data"
        };
        let stop = if framing.two_stop_bits { 2 } else { 1 };
        let message = format!(
            "USART{}: sender sends {} {}{}{}, receiver is set to {baud} {data_bits}{}{stop}: {effect}",
            self.number,
            sent.format.baud,
            sent.format.data_bits,
            parity_letter(sent.format.parity),
            sent.format.stop_bits,
            parity_letter(framing.parity),
        );
        ctx.errors.report(ctx.now, message);
    }

    fn start_sending(&mut self, ctx: &mut Ctx<'_>) {
        let on = cr1::UE | cr1::TE;
        if !self.waiting_to_send || self.sent_at.is_some() || self.cr1 & on != on {
            return;
        }
        let Some(framing) = self.framing(ctx) else {
            return;
        };
        if let Some(signal) = self.tx_signal() {
            routing::check(signal, ctx);
        }
        self.waiting_to_send = false;
        self.sr |= sr::TXE;
        let at = ctx.now + framing.char_time();
        self.sent_at = Some(at);
        ctx.scheduler.at(at, Target::Usart(self.number), SENT);
    }

    fn read_dr(&mut self) -> u16 {
        self.sr &= !(sr::RXNE | self.shown & sr::CLEARED_BY_DR_READ);
        self.shown = 0;
        self.dr
    }

    fn write_dr(&mut self, ctx: &mut Ctx<'_>) {
        if self.waiting_to_send {
            let message = format!(
                "USART{}: DR written while TXE is 0: the character waiting there is lost",
                self.number
            );
            ctx.errors.report(ctx.now, message);
        }
        self.sr &= !(sr::TXE | self.shown & sr::TC);
        self.shown &= !sr::TC;
        self.waiting_to_send = true;
        self.start_sending(ctx);
    }

    fn write_cr1(&mut self, value: u32, ctx: &mut Ctx<'_>) {
        let was_receiving = self.receiving();
        let was = std::mem::replace(&mut self.cr1, value);
        let framing_bits = cr1::M | cr1::PCE | cr1::PS | cr1::OVER8;
        if (was ^ value) & framing_bits != 0 || was_receiving != self.receiving() {
            self.receiver.restart(ctx.now);
            self.received_at = None;
        }
        if !was_receiving && self.receiving() {
            // From here on the enabled receiver times the idle line.
            if let Some(framing) = self.framing(ctx) {
                self.plan_idle(ctx.now + framing.char_time(), ctx);
            }
        }
        if !self.receiving() {
            self.idle_at = None;
        }
        self.start_sending(ctx);
    }

    fn update_lines(&self, ctx: &mut Ctx<'_>) {
        let has = |flags| self.sr & flags != 0;
        let wants = |bit| self.cr1 & bit != 0;
        let on = wants(cr1::UE);
        let dma_receives = self.cr3 & cr3::DMAR != 0;
        let irq = wants(cr1::PEIE) && has(sr::PE)
            || wants(cr1::TXEIE) && has(sr::TXE)
            || wants(cr1::TCIE) && has(sr::TC)
            || wants(cr1::RXNEIE) && has(sr::RXNE | sr::ORE)
            || wants(cr1::IDLEIE) && has(sr::IDLE)
            || self.cr3 & cr3::EIE != 0 && dma_receives && has(sr::FE | sr::NE | sr::ORE);
        ctx.irq.set(self.irq(), irq && on);
        let (rx, tx) = self.dma();
        ctx.dma.set(rx, on && dma_receives && has(sr::RXNE));
        ctx.dma.set(
            tx,
            on && wants(cr1::TE) && self.cr3 & cr3::DMAT != 0 && has(sr::TXE),
        );
    }
}

fn parity_letter(parity: Parity) -> char {
    match parity {
        Parity::None => 'N',
        Parity::Even => 'E',
        Parity::Odd => 'O',
    }
}

impl Peripheral for Usart {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        let value = match access.register {
            reg::SR => {
                self.shown = self.sr;
                self.sr
            }
            reg::DR => u32::from(self.read_dr()),
            reg::BRR => self.brr,
            reg::CR1 => self.cr1,
            reg::CR2 => self.cr2,
            reg::CR3 => self.cr3,
            reg::GTPR => 0,
            other => return Err(reg::MAP.unmodelled_read(registers::name(self.number), other)),
        };
        self.update_lines(ctx);
        Ok(access.read_of(value))
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        let over = |old| access.written_over(old, value);
        registers::check_write(self.number, access.register, over(0))?;
        match access.register {
            // Only RXNE and TC can be cleared by writing 0.
            reg::SR => self.sr &= over(u32::MAX) | !(sr::RXNE | sr::TC),
            reg::DR => self.write_dr(ctx),
            reg::BRR => {
                self.brr = over(self.brr) & 0xFFFF;
                self.received_at = None;
                self.receiver.restart(ctx.now);
            }
            reg::CR1 => self.write_cr1(over(self.cr1), ctx),
            reg::CR2 => self.cr2 = over(self.cr2),
            reg::CR3 => self.cr3 = over(self.cr3),
            _ => {}
        }
        self.plan_reception(ctx);
        self.update_lines(ctx);
        Ok(())
    }

    fn event(&mut self, tag: u32, ctx: &mut Ctx<'_>) {
        let due = |at: Option<Ps>| at.is_some_and(|at| at <= ctx.now);
        match tag {
            RECEIVED if due(self.received_at) => self.character_ended(ctx),
            IDLE if due(self.idle_at) => {
                self.idle_at = None;
                self.sr |= sr::IDLE;
            }
            SENT if due(self.sent_at) => {
                self.sent_at = None;
                if self.waiting_to_send {
                    self.start_sending(ctx);
                } else {
                    self.sr |= sr::TC;
                }
            }
            _ => {}
        }
        self.update_lines(ctx);
    }

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self::new(self.number);
        self.receiver.restart(ctx.now);
        self.update_lines(ctx);
    }

    fn clocks_changed(&mut self, ctx: &mut Ctx<'_>) {
        self.received_at = None;
        self.receiver.restart(ctx.now);
    }

    fn board_advanced(&mut self, ctx: &mut Ctx<'_>) {
        // Only USART3 is connected to a line.
        if self.number != 3 {
            return;
        }
        while let Some(c) = ctx.board.usart3_character(ctx.now) {
            self.line_character(c, ctx);
        }
        self.plan_reception(ctx);
        self.update_lines(ctx);
    }
}

impl Usart {
    fn line_character(&mut self, c: UartChar, ctx: &mut Ctx<'_>) {
        if self.receiving() && routing::check(Signal::Usart3Rx, ctx) {
            self.receiver.push(c);
        }
    }
}

#[cfg(test)]
mod tests;
