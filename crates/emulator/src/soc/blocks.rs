//! Every modelled register block of the chip, and the wires between them that do not pass a bus.

use crate::{
    soc::{
        absent::Absent,
        exti::Exti,
        flash::Flash,
        gpio::Gpio,
        memory_map::Block,
        peripheral::{Ctx, Peripheral},
        pwr::Pwr,
        rcc::Rcc,
        reset::ResetCause,
        syscfg::Syscfg,
        timer::Timer,
    },
    wiring::{self, Outputs, PwmTimers},
};

pub struct Blocks {
    pub rcc: Rcc,
    pwr: Pwr,
    flash: Flash,
    gpio: [Gpio; 9],
    syscfg: Syscfg,
    exti: Exti,
    tim2: Timer,
    tim3: Timer,
    tim4: Timer,
    tim5: Timer,
    tim10: Timer,
    absent: Absent,
    outputs: Outputs,
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
            absent: Absent("other"),
            outputs: Outputs::default(),
        }
    }
}

impl Blocks {
    /// Blocks with a wire to the world that may change by itself.
    pub const WATCHING_THE_WORLD: [Block; 2] = [Block::Usart(3), Block::Can];

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
            _ => &mut self.absent,
        }
    }

    pub fn take_reset_request(&mut self) -> Option<ResetCause> {
        None
    }

    /// A device drives a pin differently, or may.
    pub fn inputs_changed(&mut self, ctx: &mut Ctx<'_>) {
        wiring::drive_inputs(ctx.pins, ctx.world);
        self.exti.pins_changed(&self.syscfg, ctx);
    }

    /// A port or a timer drives a pin differently, or may.
    pub fn outputs_changed(&mut self, ctx: &mut Ctx<'_>) {
        let timers = PwmTimers { tim4: &self.tim4, tim5: &self.tim5, tim10: &self.tim10 };
        self.outputs.update(ctx.pins, &timers, ctx.world, ctx.now);
        self.exti.pins_changed(&self.syscfg, ctx);
    }

    pub fn exti_sources_changed(&mut self, ctx: &mut Ctx<'_>) {
        self.exti.sources_changed(&self.syscfg, ctx);
    }

    /// Limits that join several blocks: wait states, regulator scale, the backup domain's lock.
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
