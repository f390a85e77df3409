//! The transfer sequence of a master (RM0090 figures 242 and 243), one bus action after another.

use super::registers::{cr1, cr2, sr1};
use crate::{
    soc::{
        clocks::cycles_to_ps, dma_request::DmaRequest, peripheral::Ctx, routing, scheduler::Target,
        signals::Signal,
    },
    time::Ps,
};

/// Bits of one byte with its acknowledge.
const BYTE_BITS: u64 = 9;
/// Interval at which a held bus is checked again, in bit times.
const HELD_BUS_LOOKS: u64 = 50;

/// State of the bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// No transfer of this master is under way.
    #[default]
    Idle,
    /// START is in progress, or waits for a held bus.
    Starting {
        repeated: bool,
    },
    /// SB is set: the address byte is awaited with SCL low.
    Started,
    Addressing(u8),
    /// ADDR is set and must be cleared; SCL is low.
    Addressed,
    Transmitting,
    Receiving,
    /// One side has sent a NACK, and only STOP or START can follow.
    Ended,
    Stopping,
}

/// The bus side of I2C3, with the registers it works on.
#[derive(Debug, Default)]
pub struct Master {
    pub cr1: u32,
    pub cr2: u32,
    pub sr1: u32,
    pub ccr: u32,
    pub trise: u32,
    pub phase: Phase,
    pub transmitter: bool,
    dr: u8,
    /// DR holds a byte not yet moved to the shift register.
    dr_waits: bool,
    /// The byte being sent, or a received byte that found DR full.
    shift: u8,
    /// Time at which the current bus action ends.
    ends_at: Option<Ps>,
    /// Whether a STOP cuts off the next START before SB. The peripheral then waits until it is reset.
    pub start_cut_off: bool,
}

impl Master {
    /// The state after reset.
    pub fn new() -> Self {
        Self {
            trise: 2,
            ..Self::default()
        }
    }

    pub fn owns_bus(&self) -> bool {
        !matches!(
            self.phase,
            Phase::Idle | Phase::Starting { repeated: false }
        )
    }

    /// Handles a write to CR1. START and STOP act as soon as no byte is in transfer.
    pub fn requests_changed(&mut self, ctx: &mut Ctx<'_>) {
        if self.cr1 & cr1::PE == 0 {
            self.cr1 &= !(cr1::START | cr1::STOP);
            return;
        }
        self.act_on_requests(ctx);
    }

    /// Begins STOP or else START. Returns true if one of them took the bus.
    fn act_on_requests(&mut self, ctx: &mut Ctx<'_>) -> bool {
        let between_bytes = matches!(
            self.phase,
            Phase::Transmitting | Phase::Receiving | Phase::Ended
        );
        if self.ends_at.is_some() {
            return false;
        }
        if self.cr1 & cr1::STOP != 0 && (between_bytes || self.phase == Phase::Started) {
            self.phase = Phase::Stopping;
        } else if self.cr1 & cr1::START != 0 && (between_bytes || self.phase == Phase::Idle) {
            self.check_timing(ctx);
            self.phase = Phase::Starting {
                repeated: between_bytes,
            };
        } else {
            return false;
        }
        // BTF of a reception stays with the byte still waiting in the shift register.
        self.sr1 &= !sr1::TXE;
        if self.transmitter {
            self.sr1 &= !sr1::BTF;
        }
        self.dr_waits = false;
        self.wait_bits(1, ctx);
        true
    }

    pub fn send_address(&mut self, byte: u8, ctx: &mut Ctx<'_>) {
        self.sr1 &= !sr1::SB;
        self.transmitter = byte & 1 == 0;
        self.phase = Phase::Addressing(byte);
        self.wait_bits(BYTE_BITS, ctx);
    }

    /// Handles the end of the clear sequence of ADDR.
    pub fn address_acknowledged_seen(&mut self, ctx: &mut Ctx<'_>) {
        if self.phase != Phase::Addressed {
            return;
        }
        self.sr1 &= !sr1::ADDR;
        if self.transmitter {
            self.phase = Phase::Transmitting;
            self.sr1 |= sr1::TXE;
            self.act_on_requests(ctx);
        } else {
            self.phase = Phase::Receiving;
            self.wait_bits(BYTE_BITS, ctx);
        }
    }

    /// Handles a write of data to DR.
    pub fn write(&mut self, byte: u8, ctx: &mut Ctx<'_>) {
        self.dr = byte;
        self.dr_waits = true;
        self.sr1 &= !(sr1::BTF | sr1::TXE);
        self.send_next(ctx);
    }

    fn send_next(&mut self, ctx: &mut Ctx<'_>) {
        if self.phase == Phase::Transmitting && self.ends_at.is_none() && self.dr_waits {
            self.shift = self.dr;
            self.dr_waits = false;
            self.sr1 |= sr1::TXE;
            self.wait_bits(BYTE_BITS, ctx);
        }
    }

    /// Handles a read of DR.
    pub fn read(&mut self, ctx: &mut Ctx<'_>) -> u8 {
        let value = self.dr;
        if self.transmitter {
            return value;
        }
        self.sr1 &= !sr1::RXNE;
        if self.sr1 & sr1::BTF != 0 {
            self.sr1 &= !sr1::BTF;
            self.dr = self.shift;
            self.sr1 |= sr1::RXNE;
            if self.phase == Phase::Receiving && self.ends_at.is_none() {
                self.wait_bits(BYTE_BITS, ctx);
            }
        }
        value
    }

    /// Handles the end of the current bus action, if its time has come.
    pub fn event(&mut self, ctx: &mut Ctx<'_>) {
        if self.ends_at.is_none_or(|at| at > ctx.now) {
            return;
        }
        if ctx.board.i2c_bus_held() {
            self.wait_bits(HELD_BUS_LOOKS, ctx);
            return;
        }
        self.ends_at = None;
        match self.phase {
            Phase::Starting { .. } if self.start_cut_off => {}
            Phase::Starting { .. } => {
                self.cr1 &= !cr1::START;
                self.sr1 |= sr1::SB;
                self.phase = Phase::Started;
                self.act_on_requests(ctx);
            }
            Phase::Addressing(byte) => self.address_sent(byte, ctx),
            Phase::Transmitting => self.byte_sent(ctx),
            Phase::Receiving => self.byte_received(ctx),
            Phase::Stopping => {
                ctx.board.i2c_stop(ctx.now);
                self.phase = Phase::Idle;
                self.cr1 &= !cr1::STOP;
                self.act_on_requests(ctx);
            }
            Phase::Idle | Phase::Started | Phase::Addressed | Phase::Ended => {}
        }
    }

    fn address_sent(&mut self, byte: u8, ctx: &mut Ctx<'_>) {
        ctx.board.i2c_started(ctx.pins, ctx.errors, ctx.now);
        let scl = routing::check(Signal::I2c3Scl, ctx);
        let sda = routing::check(Signal::I2c3Sda, ctx);
        let scl_hz = self.scl_hz(ctx);
        if scl
            && sda
            && ctx
                .board
                .i2c_address(byte >> 1, byte & 1 == 1, scl_hz, ctx.now)
        {
            self.sr1 |= sr1::ADDR;
            self.phase = Phase::Addressed;
        } else {
            self.not_acknowledged(ctx);
        }
    }

    fn not_acknowledged(&mut self, ctx: &mut Ctx<'_>) {
        self.sr1 |= sr1::AF;
        self.phase = Phase::Ended;
        self.act_on_requests(ctx);
    }

    fn byte_sent(&mut self, ctx: &mut Ctx<'_>) {
        if !ctx.board.i2c_write(self.shift, ctx.now) {
            self.not_acknowledged(ctx);
        } else if !self.act_on_requests(ctx) {
            if self.dr_waits {
                self.send_next(ctx);
            } else {
                self.sr1 |= sr1::BTF;
            }
        }
    }

    fn byte_received(&mut self, ctx: &mut Ctx<'_>) {
        let last_of_dma = cr2::LAST | cr2::DMAEN;
        let acknowledge = self.cr1 & cr1::ACK != 0
            && !(self.cr2 & last_of_dma == last_of_dma && ctx.dma.last(DmaRequest::I2c3Rx));
        let byte = ctx.board.i2c_read(acknowledge, ctx.now);
        if self.sr1 & sr1::RXNE != 0 {
            self.shift = byte;
            self.sr1 |= sr1::BTF;
        } else {
            self.dr = byte;
            self.sr1 |= sr1::RXNE;
        }
        if !acknowledge {
            self.phase = Phase::Ended;
        }
        if !self.act_on_requests(ctx) && acknowledge && self.sr1 & sr1::BTF == 0 {
            self.wait_bits(BYTE_BITS, ctx);
        }
    }

    /// Releases both lines. To a device, SCL and then SDA rising look like a STOP.
    pub fn release_bus(&mut self, ctx: &mut Ctx<'_>) {
        if self.owns_bus() {
            ctx.board.i2c_stop(ctx.now);
        }
        self.phase = Phase::Idle;
        self.sr1 = 0;
        self.ends_at = None;
        self.dr_waits = false;
        self.start_cut_off = false;
    }

    fn wait_bits(&mut self, bits: u64, ctx: &mut Ctx<'_>) {
        let clocks = self.clocks_per_bit() * bits;
        let at = ctx.now + cycles_to_ps(clocks, ctx.clocks.pclk1_hz);
        self.ends_at = Some(at);
        ctx.scheduler.at(at, Target::I2c3, 0);
    }

    /// SCL period in pclk1 cycles (RM0090 27.6.8).
    fn clocks_per_bit(&self) -> u64 {
        let ccr = u64::from(self.ccr & 0xFFF).max(1);
        match (self.ccr >> 15 & 1, self.ccr >> 14 & 1) {
            (0, _) => 2 * ccr,
            (_, 0) => 3 * ccr,
            _ => 25 * ccr,
        }
    }

    fn scl_hz(&self, ctx: &Ctx<'_>) -> u32 {
        (u64::from(ctx.clocks.pclk1_hz) / self.clocks_per_bit()) as u32
    }

    /// Checks FREQ, CCR and TRISE against RM0090 27.6.2, 27.6.8 and 27.6.9.
    fn check_timing(&self, ctx: &mut Ctx<'_>) {
        let told_mhz = self.cr2 & cr2::FREQ;
        let pclk1_mhz = ctx.clocks.pclk1_hz / 1_000_000;
        if told_mhz != pclk1_mhz {
            let message =
                format!("I2C3: CR2.FREQ says {told_mhz} MHz, pclk1 runs at {pclk1_mhz} MHz");
            ctx.errors.report(ctx.now, message);
        }
        let fast = self.ccr >> 15 & 1 == 1;
        let (mode, max_hz, rise_ns) = if fast {
            ("fast", 400_000, 300)
        } else {
            ("standard", 100_000, 1000)
        };
        let scl_hz = self.scl_hz(ctx);
        if scl_hz > max_hz {
            let message = format!("I2C3: SCL at {scl_hz} Hz, {mode} mode ends at {max_hz} Hz");
            ctx.errors.report(ctx.now, message);
        }
        let rise_cycles = told_mhz * rise_ns / 1000 + 1;
        if self.trise != rise_cycles {
            let message = format!(
                "I2C3: TRISE is {}, {mode} mode needs {rise_cycles} for {rise_ns} ns",
                self.trise
            );
            ctx.errors.suspect(ctx.now, message);
        }
    }
}
