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
    time::{MS, Ps},
    wire::{LineEvent, Parity, UartPort},
};

mod mismatch;
mod receiver;
mod registers;
mod transmitter;
mod waveform;

use registers::{cr1, cr3, reg, sr};
use transmitter::Transmitter;

/// Tags of scheduled events. An event that is not due any more is ignored.
const RECEIVED: u32 = 0;
const IDLE: u32 = 1;
const SENT: u32 = 2;
const LISTENING: u32 = 3;

/// Drivers may enable the receiver shortly before they set its pin up.
const PIN_DUE: Ps = MS;

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
    /// An edge has interrupted the wait for an idle line.
    idle_awaited: bool,
    transmitter: Transmitter,
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
            idle_awaited: false,
            transmitter: Transmitter::default(),
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

    fn port(&self) -> UartPort {
        match self.number {
            1 => UartPort::Usart1,
            3 => UartPort::Usart3,
            _ => UartPort::Usart6,
        }
    }

    fn rx_signal(&self) -> Signal {
        match self.number {
            1 => Signal::Usart1Rx,
            3 => Signal::Usart3Rx,
            _ => Signal::Usart6Rx,
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
            self.idle_awaited |= self.idle_at.take().is_some();
            ctx.scheduler
                .at(at.max(ctx.now), Target::Usart(self.number), RECEIVED);
        }
    }

    fn plan_idle(&mut self, at: Ps, ctx: &mut Ctx<'_>) {
        self.idle_at = Some(at);
        self.idle_awaited = false;
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
            if let Some(sent) = self.receiver.last_character() {
                mismatch::report(self.number, sent.format, &framing, &got, ctx);
            }
            self.plan_idle(start + 2 * framing.char_time(), ctx);
        } else if self.idle_awaited {
            // It was a glitch.
            let idle_at = self.receiver.searching_from() + framing.char_time();
            self.plan_idle(idle_at.max(ctx.now), ctx);
        }
        self.plan_reception(ctx);
    }

    fn read_dr(&mut self) -> u16 {
        self.sr &= !(sr::RXNE | self.shown & sr::CLEARED_BY_DR_READ);
        self.shown = 0;
        self.dr
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
            let by = ctx.now + PIN_DUE;
            ctx.scheduler.at(by, Target::Usart(self.number), LISTENING);
            // From here on the enabled receiver times the idle line.
            if let Some(framing) = self.framing(ctx) {
                self.plan_idle(ctx.now + framing.char_time(), ctx);
            }
        }
        if !self.receiving() {
            self.idle_at = None;
        }
        if was & !value & cr1::TE != 0 {
            self.stop_sending(ctx);
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
            reg::DR => self.write_dr(over(0) as u16, ctx),
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
            IDLE if due(self.idle_at) => self.line_idles(ctx),
            LISTENING if self.receiving() => self.check_input(ctx),
            SENT => self.character_sent(ctx),
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
        self.plan_reception(ctx);
    }

    fn board_advanced(&mut self, ctx: &mut Ctx<'_>) {
        let mut anything = false;
        while let Some(event) = ctx.board.uart_event(self.port(), ctx.now) {
            self.line_event(event, ctx);
            anything = true;
        }
        if anything {
            self.plan_reception(ctx);
        }
    }
}

impl Usart {
    fn line_event(&mut self, event: LineEvent, ctx: &mut Ctx<'_>) {
        if self.receiving() && routing::check(self.rx_signal(), ctx) {
            self.receiver.push(event);
        }
    }

    /// The line has been high for a character's time, unless a device still holds it low or has just released it.
    fn line_idles(&mut self, ctx: &mut Ctx<'_>) {
        self.idle_at = None;
        let Some(framing) = self.framing(ctx) else {
            return;
        };
        match self.receiver.released_at(ctx.now) {
            Some(released) if released + framing.char_time() > ctx.now => {
                self.plan_idle(released + framing.char_time(), ctx);
            }
            _ => self.sr |= sr::IDLE,
        }
    }

    /// The receiver has been on for some time, whether or not anything was sent to it.
    fn check_input(&self, ctx: &mut Ctx<'_>) {
        let signal = self.rx_signal();
        if !routing::check(signal, ctx) {
            return;
        }
        let Some(route) = ctx.board.route(signal) else {
            return;
        };
        if ctx.pins.level(route.pin).is_none() {
            let message = format!(
                "{}: {} floats while nothing is plugged in, needs a pull-up: noise is received",
                signal.name(),
                route.pin
            );
            ctx.errors.suspect(ctx.now, message);
        }
    }
}

#[cfg(test)]
mod tests;
