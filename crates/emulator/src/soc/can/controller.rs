//! One bxCAN controller: modes, interrupts, and its reaction to the bus (RM0090 32.4 to 32.9).

use super::{
    bit_timing::BitTiming,
    errors::{ErrorCode, ErrorCounters},
    fifo::Fifo,
    filter::{self, Filters},
    mailboxes::{Attempt, Mailboxes},
};
use crate::{
    soc::{irq::Irq, peripheral::Ctx, routing, signals::Signal},
    time::Ps,
    wire::CanFrame,
};

pub mod mcr {
    pub const INRQ: u32 = 1;
    pub const SLEEP: u32 = 1 << 1;
    pub const TXFP: u32 = 1 << 2;
    pub const RFLM: u32 = 1 << 3;
    pub const NART: u32 = 1 << 4;
    pub const AWUM: u32 = 1 << 5;
    pub const ABOM: u32 = 1 << 6;
    pub const TTCM: u32 = 1 << 7;
    pub const RESET: u32 = 1 << 15;
    pub const DBF: u32 = 1 << 16;
    pub const KEPT: u32 = 0xFF | DBF;
}

pub mod msr {
    pub const INAK: u32 = 1;
    pub const SLAK: u32 = 1 << 1;
    pub const ERRI: u32 = 1 << 2;
    pub const WKUI: u32 = 1 << 3;
    pub const SLAKI: u32 = 1 << 4;
    pub const CLEARED_BY_1: u32 = ERRI | WKUI | SLAKI;
    /// SAMP and RX: the recessive bus.
    pub const RECESSIVE: u32 = 0b11 << 10;
}

pub mod ier {
    pub const TMEIE: u32 = 1;
    /// FMPIE0, FFIE0, FOVIE0 at 1–3 and the same of FIFO 1 at 4–6.
    pub const FIFO_SHIFT: [u32; 2] = [1, 4];
    /// EWGIE, EPVIE, BOFIE.
    pub const STATES_SHIFT: u32 = 8;
    pub const LECIE: u32 = 1 << 11;
    pub const ERRIE: u32 = 1 << 15;
    pub const WKUIE: u32 = 1 << 16;
    pub const SLKIE: u32 = 1 << 17;
    pub const ALL: u32 = 0x0003_8F7F;
}

/// Operating mode of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    Sleep,
    Initialization,
    /// Waiting for eleven recessive bits.
    Synchronising(Ps),
    Normal,
}

/// Registers of CAN1 or CAN2, filters aside.
#[derive(Debug)]
pub struct Controller {
    /// 0 = CAN1, 1 = CAN2.
    pub index: usize,
    pub mcr: u32,
    pub msr_flags: u32,
    pub ier: u32,
    pub timing: BitTiming,
    pub mode: Mode,
    pub errors: ErrorCounters,
    pub mailboxes: Mailboxes,
    pub fifos: [Fifo; 2],
    /// Time at which 128 times eleven recessive bits will have passed; `None` while not recovering.
    pub recovers_at: Option<Ps>,
}

impl Controller {
    /// After reset: asleep.
    pub fn new(index: usize) -> Self {
        Self {
            index,
            mcr: mcr::SLEEP | mcr::DBF,
            msr_flags: 0,
            ier: 0,
            timing: BitTiming::RESET,
            mode: Mode::Sleep,
            errors: ErrorCounters::default(),
            mailboxes: Mailboxes::default(),
            fifos: Default::default(),
            recovers_at: None,
        }
    }

    pub fn name(&self) -> &'static str {
        ["CAN1", "CAN2"][self.index]
    }

    pub fn bit(&self, ctx: &Ctx<'_>) -> Ps {
        self.timing.bit(ctx.clocks.pclk1_hz)
    }

    /// CAN_MSR.
    pub fn status(&self) -> u32 {
        let mode = match self.mode {
            Mode::Sleep => msr::SLAK,
            Mode::Initialization => msr::INAK,
            // The acknowledge of the mode being left stays until the bus was quiet for eleven bits.
            Mode::Synchronising(_) => self.msr_flags & (msr::SLAK | msr::INAK),
            Mode::Normal => 0,
        };
        msr::RECESSIVE | mode | self.msr_flags & msr::CLEARED_BY_1
    }

    pub fn by_request_order(&self) -> bool {
        self.mcr & mcr::TXFP != 0
    }

    /// Whether it receives every frame of the bus, and sends unless silent.
    pub fn on_bus(&self) -> bool {
        self.mode == Mode::Normal && !self.errors.is_bus_off()
    }

    /// The frame that it would send on an idle bus now.
    pub fn pending(&self) -> Option<(usize, CanFrame)> {
        if !self.on_bus() || self.timing.silent() {
            return None;
        }
        self.mailboxes.next(self.by_request_order())
    }

    /// Whether its dominant bits reach the bus.
    pub fn drives_bus(&self, ctx: &mut Ctx<'_>) -> bool {
        let signal = [Signal::Can1Tx, Signal::Can2Tx][self.index];
        !self.timing.silent() && routing::check(signal, ctx)
    }

    fn receives_bus(&self, ctx: &mut Ctx<'_>) -> bool {
        routing::check([Signal::Can1Rx, Signal::Can2Rx][self.index], ctx)
    }

    /// Changes towards the mode that INRQ and SLEEP request, after the end of a frame in which it takes part. Returns
    /// true if it now begins to wait for a quiet bus.
    pub fn follow_requests(&mut self, in_frame: bool, ctx: &mut Ctx<'_>) -> bool {
        if in_frame && self.mode == Mode::Normal {
            return false;
        }
        let asleep = self.mode == Mode::Sleep;
        let sleep = self.mcr & mcr::SLEEP != 0;
        let init = self.mcr & mcr::INRQ != 0;
        if init && !(asleep && sleep) {
            self.mode = Mode::Initialization;
            self.recovers_at = None;
        } else if sleep {
            if !asleep {
                self.msr_flags |= msr::SLAKI;
            }
            self.mode = Mode::Sleep;
        } else if matches!(self.mode, Mode::Sleep | Mode::Initialization) {
            self.synchronise(ctx);
            return true;
        }
        false
    }

    fn synchronise(&mut self, ctx: &mut Ctx<'_>) {
        self.msr_flags &= !(msr::SLAK | msr::INAK);
        self.msr_flags |= if self.mode == Mode::Sleep {
            msr::SLAK
        } else {
            msr::INAK
        };
        // Without its RX pin the controller sees a dominant line forever.
        let until = if self.receives_bus(ctx) {
            ctx.now + 11 * self.bit(ctx)
        } else {
            Ps::MAX
        };
        self.mode = Mode::Synchronising(until);
    }

    /// Handles the end of eleven recessive bits.
    pub fn synchronised(&mut self, ctx: &mut Ctx<'_>) {
        self.mode = Mode::Normal;
        if self.errors.is_bus_off() {
            self.start_recovery(ctx);
        }
    }

    fn start_recovery(&mut self, ctx: &mut Ctx<'_>) {
        self.recovers_at
            .get_or_insert(ctx.now + 128 * 11 * self.bit(ctx));
    }

    /// Handles the end of an attempt to send mailbox `index`.
    pub fn attempt_ended(
        &mut self,
        index: usize,
        result: Result<(), ErrorCode>,
        ctx: &mut Ctx<'_>,
    ) {
        let retransmit = self.mcr & mcr::NART == 0;
        let before = self.errors.states();
        let attempt = match result {
            Ok(()) => {
                self.errors.transmitted();
                Attempt::Sent
            }
            Err(code) => {
                self.errors.transmit_error(code);
                Attempt::Error
            }
        };
        self.mailboxes.ended(index, attempt, retransmit);
        self.errors_changed(before, result.is_err(), ctx);
    }

    pub fn arbitration_lost(&mut self, index: usize) {
        self.mailboxes
            .ended(index, Attempt::ArbitrationLost, self.mcr & mcr::NART == 0);
    }

    pub fn reception_failed(&mut self, ctx: &mut Ctx<'_>) {
        let before = self.errors.states();
        self.errors.receive_error();
        self.errors_changed(before, true, ctx);
    }

    /// Receives a complete frame of another node. `started` is the time of its start of frame.
    pub fn receive(&mut self, frame: &CanFrame, started: Ps, filters: &Filters, ctx: &mut Ctx<'_>) {
        self.errors.received();
        let Some(accepted) = filters.accept(self.index, frame) else {
            return;
        };
        let time = if self.mcr & mcr::TTCM != 0 {
            (started / self.bit(ctx)) & 0xFFFF
        } else {
            0
        };
        let [a, b, c, d, e, f, g, h] = if frame.remote { [0; 8] } else { frame.data };
        let received = [
            filter::register_layout(frame),
            (time as u32) << 16 | u32::from(accepted.index) << 8 | u32::from(frame.dlc),
            u32::from_le_bytes([a, b, c, d]),
            u32::from_le_bytes([e, f, g, h]),
        ];
        self.fifos[accepted.fifo].push(received, self.mcr & mcr::RFLM != 0);
    }

    fn errors_changed(&mut self, before: u32, error: bool, ctx: &mut Ctx<'_>) {
        let risen = self.errors.states() & !before;
        if risen & self.ier >> ier::STATES_SHIFT & 7 != 0 || error && self.ier & ier::LECIE != 0 {
            self.msr_flags |= msr::ERRI;
        }
        if self.errors.is_bus_off() && self.mcr & mcr::ABOM != 0 {
            self.start_recovery(ctx);
        }
    }

    /// Ends bus-off when the recovery time is over.
    pub fn recover_if_due(&mut self, now: Ps) {
        if self.recovers_at.is_some_and(|at| at <= now) {
            self.recovers_at = None;
            self.errors.recovered();
        }
    }

    pub fn update_lines(&self, ctx: &mut Ctx<'_>) {
        let [tx, rx0, rx1, sce]: [Irq; 4] = [[19, 20, 21, 22], [63, 64, 65, 66]][self.index];
        ctx.irq.set(
            tx,
            self.ier & ier::TMEIE != 0 && self.mailboxes.any_request_completed(),
        );
        for (irq, fifo, shift) in [
            (rx0, &self.fifos[0], ier::FIFO_SHIFT[0]),
            (rx1, &self.fifos[1], ier::FIFO_SHIFT[1]),
        ] {
            ctx.irq
                .set(irq, self.ier >> shift & fifo.interrupt_flags() != 0);
        }
        let both = |enable, flag| self.ier & enable != 0 && self.msr_flags & flag != 0;
        let status_change = both(ier::ERRIE, msr::ERRI)
            || both(ier::WKUIE, msr::WKUI)
            || both(ier::SLKIE, msr::SLAKI);
        ctx.irq.set(sce, status_change);
    }
}
