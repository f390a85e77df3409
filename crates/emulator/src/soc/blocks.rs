//! Every modelled register block of the chip, and the signals between blocks that do not use a bus.

use crate::{
    soc::{
        adc::Adc,
        board::{Outputs, Waves},
        board_errors::BoardErrors,
        can::Can,
        can::bus::CanBusStats,
        dma::{Beat, Dma, request_map::RequestLine, unserved::Unserved},
        dma_request::DmaRequests,
        exti::Exti,
        flash::Flash,
        gpio::Gpio,
        i2c::I2c,
        iwdg::Iwdg,
        memory_map::Block,
        peripheral::{Ctx, Peripheral},
        pwr::Pwr,
        rcc::Rcc,
        reset::ResetCause,
        spi::Spi,
        syscfg::Syscfg,
        timer::Timer,
        usart::Usart,
        wave::Wave,
    },
    time::Ps,
};

pub struct Blocks {
    pub rcc: Rcc,
    pub pwr: Pwr,
    pub flash: Flash,
    gpio: [Gpio; 9],
    syscfg: Syscfg,
    exti: Exti,
    tim2: Timer,
    tim3: Timer,
    tim4: Timer,
    tim5: Timer,
    tim10: Timer,
    dma1: Dma,
    dma2: Dma,
    unserved: Unserved,
    usart1: Usart,
    usart3: Usart,
    usart6: Usart,
    spi1: Spi,
    i2c3: I2c,
    can: Can,
    adc: Adc,
    iwdg: Iwdg,
}

impl Default for Blocks {
    fn default() -> Self {
        Self {
            rcc: Rcc::default(),
            pwr: Pwr::default(),
            flash: Flash::default(),
            gpio: std::array::from_fn(|port| Gpio::new(port as u8)),
            syscfg: Syscfg::default(),
            exti: Exti::default(),
            tim2: Timer::new(2),
            tim3: Timer::new(3),
            tim4: Timer::new(4),
            tim5: Timer::new(5),
            tim10: Timer::new(10),
            dma1: Dma::new(1),
            dma2: Dma::new(2),
            unserved: Unserved::default(),
            usart1: Usart::new(1),
            usart3: Usart::new(3),
            usart6: Usart::new(6),
            spi1: Spi::new(),
            i2c3: I2c::new(),
            can: Can::new(),
            adc: Adc::new(),
            iwdg: Iwdg::new(),
        }
    }
}

impl Blocks {
    /// Blocks with an input from the board that may change by itself.
    pub const WATCHING_THE_BOARD: [Block; 4] = [
        Block::Usart(1),
        Block::Usart(3),
        Block::Usart(6),
        Block::Can,
    ];

    pub fn get(&mut self, block: Block) -> &mut dyn Peripheral {
        match block {
            Block::Rcc => &mut self.rcc,
            Block::Pwr => &mut self.pwr,
            Block::Flash => &mut self.flash,
            Block::Gpio(port) => &mut self.gpio[usize::from(port)],
            Block::Syscfg => &mut self.syscfg,
            Block::Exti => &mut self.exti,
            Block::Timer(2) => &mut self.tim2,
            Block::Timer(3) => &mut self.tim3,
            Block::Timer(4) => &mut self.tim4,
            Block::Timer(5) => &mut self.tim5,
            Block::Timer(_) => &mut self.tim10,
            Block::Dma(n) => self.dma(n),
            Block::Usart(1) => &mut self.usart1,
            Block::Usart(3) => &mut self.usart3,
            Block::Usart(_) => &mut self.usart6,
            Block::Spi1 => &mut self.spi1,
            Block::I2c3 => &mut self.i2c3,
            Block::Can => &mut self.can,
            Block::Adc => &mut self.adc,
            Block::Iwdg => &mut self.iwdg,
        }
    }

    /// The two CAN controllers share a block, but each has its own RCC reset bit.
    pub fn reset_can(&mut self, index: usize, ctx: &mut Ctx<'_>) {
        self.can.reset_controller(index, ctx);
    }

    /// 1 or 2.
    pub fn dma(&mut self, number: u8) -> &mut Dma {
        if number == 1 {
            &mut self.dma1
        } else {
            &mut self.dma2
        }
    }

    /// The next item to move, and the controller whose stream moves it.
    pub fn next_dma_beat(&self, requests: &DmaRequests) -> Option<(u8, Beat)> {
        let first = self.dma1.next_beat(requests).map(|beat| (1, beat));
        first.or_else(|| self.dma2.next_beat(requests).map(|beat| (2, beat)))
    }

    pub fn note_dma_served(&mut self, line: &RequestLine) {
        self.unserved.note_served(line);
    }

    pub fn check_unserved(&mut self, requests: &DmaRequests, now: Ps, errors: &mut BoardErrors) {
        self.unserved
            .check(requests, [&self.dma1, &self.dma2], now, errors);
    }

    pub fn take_reset_request(&mut self) -> Option<ResetCause> {
        if self.flash.take_power_failure() {
            return Some(ResetCause::PowerOn);
        }
        self.iwdg
            .take_reset_request()
            .then_some(ResetCause::IndependentWatchdog)
    }

    /// Stops the watchdog by DBG_IWDG_STOP while the core is halted.
    pub fn freeze_watchdog(&mut self, frozen: bool, ctx: &mut Ctx<'_>) {
        self.iwdg.freeze(frozen, ctx);
    }

    /// Frames and load of CAN1 (0) or CAN2 (1).
    pub fn can_stats(&self, bus: usize) -> CanBusStats {
        self.can.stats(bus)
    }

    /// Call this when a device may drive a pin differently.
    pub fn inputs_changed(&mut self, ctx: &mut Ctx<'_>) {
        ctx.board.drive_pins(ctx.pins);
        self.exti.pins_changed(&self.syscfg, ctx);
    }

    /// Call this when a port or a timer may drive a pin differently.
    pub fn outputs_changed(&mut self, ctx: &mut Ctx<'_>) {
        let outputs = Outputs {
            pins: ctx.pins,
            waves: &*self,
        };
        ctx.board.outputs_changed(&outputs, ctx.errors, ctx.now);
        self.exti.pins_changed(&self.syscfg, ctx);
    }

    pub fn exti_sources_changed(&mut self, ctx: &mut Ctx<'_>) {
        self.exti.sources_changed(&self.syscfg, ctx);
    }

    pub fn exti_lines_changed(&mut self, ctx: &mut Ctx<'_>) {
        self.exti.check_sources(&self.syscfg, ctx);
    }

    /// Checks limits that involve several blocks: wait states, regulator scale and the backup domain's lock.
    pub fn power_changed(&mut self, ctx: &mut Ctx<'_>) {
        self.rcc.set_backup_unlocked(self.pwr.backup_unlocked());
        self.flash.check_speed(ctx);
        let (hclk_hz, max_hz) = (ctx.clocks.hclk_hz, self.pwr.max_hclk_hz());
        if hclk_hz > max_hz && max_hz < 168_000_000 {
            ctx.errors.report(
                ctx.now,
                format!("PWR: HCLK {hclk_hz} Hz at regulator scale 2 (VOS = 0), which allows {max_hz} Hz"),
            );
        }
    }
}

impl Waves for Blocks {
    fn wave(&self, timer: u8, channel: u8) -> Option<Wave> {
        let timer = match timer {
            4 => &self.tim4,
            5 => &self.tim5,
            _ => &self.tim10,
        };
        timer.wave(usize::from(channel) - 1)
    }
}
