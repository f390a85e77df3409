//! One CAN bus: arbitration among the board's controller and the nodes on it, frame times, acknowledges, errors.

use crate::{
    soc::{
        can::{
            controller::{Controller, Mode, mcr, msr},
            errors::ErrorCode,
            filter::Filters,
            frame_bits,
        },
        peripheral::Ctx,
    },
    time::{Ps, US},
    wire::{CanFrame, CanPort},
};

/// Bit time of the nodes on the board.
const NODE_BIT: Ps = US;
const INTERMISSION_BITS: Ps = 3;
/// Error flag and error delimiter.
const ERROR_FRAME_BITS: Ps = 6 + 8;
/// Wait of an error-passive transmitter, which lets others send first (ISO 11898-1, suspend transmission).
const SUSPEND_BITS: Ps = 8;
/// Bits after the ACK slot: its delimiter and end of frame.
const AFTER_ACK_BITS: Ps = 8;
/// Bits after which a receiver at another bit rate detects a stuff error, within the first bits of the identifier.
const MISREAD_BITS: Ps = 12;

/// Counters of the bus since power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CanBusStats {
    /// Frames the board sent.
    pub tx: u64,
    /// Frames the board received.
    pub rx: u64,
    /// Time with a frame, error frame or intermission on the bus.
    pub busy: Ps,
    /// Frames that ended in an error frame.
    pub errors: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sender {
    Board { mailbox: usize },
    Node(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Delivered,
    NotAcknowledged,
    /// The sender's dominant bits do not reach the bus.
    NotDriven,
    /// Sender and hearers do not share a bit rate.
    Misread,
}

#[derive(Clone, Copy, Debug)]
struct Transmission {
    frame: CanFrame,
    sender: Sender,
    started: Ps,
    outcome: Outcome,
    bit: Ps,
}

#[derive(Clone, Copy, Debug)]
enum Phase {
    Idle,
    Frame(Transmission),
    Intermission,
}

/// The bus of one controller.
#[derive(Debug)]
pub(crate) struct CanBus {
    id: CanPort,
    phase: Phase,
    phase_ends_at: Ps,
    /// Time until which the board waits, after it failed as an error-passive transmitter.
    board_suspended_until: Ps,
    pub stats: CanBusStats,
}

impl CanBus {
    pub fn new(id: CanPort) -> Self {
        Self {
            id,
            phase: Phase::Idle,
            phase_ends_at: 0,
            board_suspended_until: 0,
            stats: CanBusStats::default(),
        }
    }

    pub fn in_frame(&self) -> bool {
        matches!(self.phase, Phase::Frame(_))
    }

    /// Handles a reset of the board's controller. A frame that it was sending ends as an error.
    pub fn board_reset(&mut self) {
        if let Phase::Frame(transmission) = &mut self.phase
            && matches!(transmission.sender, Sender::Board { .. })
        {
            self.phase = Phase::Intermission;
        }
    }

    /// Starts a frame that waits for an idle bus. Returns the time of the next call.
    pub fn start_if_idle(&mut self, board: &mut Controller, ctx: &mut Ctx<'_>) -> Option<Ps> {
        if !matches!(self.phase, Phase::Idle) {
            return None;
        }
        let (sender, frame) = self.arbitrate(board, ctx)?;
        let timing_misfit = board.timing.misfit(ctx.clocks.pclk1_hz);
        if let Some(why) = board
            .timing
            .suspicion()
            .filter(|_| timing_misfit.is_none() && board.on_bus())
        {
            ctx.errors
                .suspect(ctx.now, format!("{}: {why}", board.name()));
        }
        let outcome = self.outcome(sender, timing_misfit.is_some(), board, ctx);
        if let Some(why) = timing_misfit.filter(|_| outcome == Outcome::Misread) {
            ctx.errors
                .report(ctx.now, format!("{}: {why}", board.name()));
        }
        let bit = match sender {
            Sender::Board { mailbox } => {
                board.mailboxes.started(mailbox);
                board.bit(ctx)
            }
            Sender::Node(_) => NODE_BIT,
        };
        self.wake(board);
        let transmission = Transmission {
            frame,
            sender,
            started: ctx.now,
            outcome,
            bit,
        };
        self.phase = Phase::Frame(transmission);
        Some(self.phase_lasts(bits_until_end(&transmission) * bit, ctx))
    }

    /// Ends the phase if its time is over. Returns the time of the next call.
    pub fn phase_ended(
        &mut self,
        board: &mut Controller,
        filters: &Filters,
        ctx: &mut Ctx<'_>,
    ) -> Option<Ps> {
        if ctx.now < self.phase_ends_at {
            return None;
        }
        match self.phase {
            Phase::Idle => None,
            Phase::Frame(mut transmission) => {
                self.phase = Phase::Intermission;
                self.apply_faults_meanwhile(&mut transmission, ctx);
                self.finish(&transmission, board, filters, ctx);
                let at = self.phase_lasts(INTERMISSION_BITS * transmission.bit, ctx);
                self.delay_quiet_bus(&transmission, at, board);
                Some(at)
            }
            Phase::Intermission => {
                self.phase = Phase::Idle;
                if ctx.now < self.board_suspended_until {
                    return self
                        .start_if_idle(board, ctx)
                        .or(Some(self.board_suspended_until));
                }
                self.start_if_idle(board, ctx)
            }
        }
    }

    fn phase_lasts(&mut self, time: Ps, ctx: &Ctx<'_>) -> Ps {
        self.stats.busy += time;
        self.phase_ends_at = ctx.now + time;
        self.phase_ends_at
    }

    /// The frame that wins an idle bus now. A standard frame beats an extended one of the same base identifier.
    fn arbitrate(&self, board: &mut Controller, ctx: &mut Ctx<'_>) -> Option<(Sender, CanFrame)> {
        let from_board = if ctx.now < self.board_suspended_until {
            None
        } else {
            board.pending()
        };
        let board_sender = from_board.map(|(mailbox, frame)| (Sender::Board { mailbox }, frame));
        if ctx.board.can_broken(self.id) {
            return board_sender;
        }
        let mut best = board_sender;
        for node in 0..ctx.board.can_nodes(self.id) {
            let Some(frame) = ctx.board.can_pending(self.id, node, ctx.now) else {
                continue;
            };
            let key = frame_bits::arbitration_key(&frame);
            let rival = best.map(|(_, f)| frame_bits::arbitration_key(&f));
            if rival == Some(key) {
                let message = format!(
                    "{}: two nodes send identifier {:#05x}",
                    board.name(),
                    frame.id
                );
                ctx.errors.report(ctx.now, message);
            }
            if rival.is_none_or(|r| key < r) {
                best = Some((Sender::Node(node), frame));
            }
        }
        if let (Some((Sender::Node(_), _)), Some((mailbox, _))) = (best, from_board) {
            board.arbitration_lost(mailbox);
        }
        best
    }

    fn present_nodes(&self, ctx: &Ctx<'_>) -> Vec<usize> {
        (0..ctx.board.can_nodes(self.id))
            .filter(|n| ctx.board.can_present(self.id, *n))
            .collect()
    }

    fn outcome(
        &self,
        sender: Sender,
        misfit: bool,
        board: &Controller,
        ctx: &mut Ctx<'_>,
    ) -> Outcome {
        let nodes = self.present_nodes(ctx);
        match sender {
            Sender::Board { .. } if ctx.board.can_broken(self.id) || !board.drives_bus(ctx) => {
                Outcome::NotDriven
            }
            Sender::Board { .. } if nodes.is_empty() => Outcome::NotAcknowledged,
            Sender::Board { .. } if misfit => Outcome::Misread,
            Sender::Board { .. } => Outcome::Delivered,
            Sender::Node(sending) => {
                let board_drives = board.on_bus() && board.drives_bus(ctx);
                // A passive node's error flag disturbs nobody.
                if board_drives && misfit && !board.errors.is_passive() {
                    Outcome::Misread
                } else if nodes.iter().any(|n| *n != sending) || board_drives && !misfit {
                    Outcome::Delivered
                } else {
                    Outcome::NotAcknowledged
                }
            }
        }
    }

    /// Applies faults since the start of frame: if the bus was shorted or the sender disappeared, nobody receives the frame.
    fn apply_faults_meanwhile(&self, transmission: &mut Transmission, ctx: &Ctx<'_>) {
        let sender_gone = match transmission.sender {
            Sender::Board { .. } => false,
            Sender::Node(node) => !ctx.board.can_present(self.id, node),
        };
        if ctx.board.can_broken(self.id) || sender_gone {
            transmission.outcome = Outcome::NotDriven;
        }
    }

    fn finish(
        &mut self,
        transmission: &Transmission,
        board: &mut Controller,
        filters: &Filters,
        ctx: &mut Ctx<'_>,
    ) {
        if transmission.outcome != Outcome::Delivered {
            self.stats.errors += 1;
        }
        match transmission.sender {
            Sender::Board { mailbox } => self.finish_own(mailbox, transmission, board, ctx),
            Sender::Node(_) if transmission.outcome == Outcome::Misread => {
                board.reception_failed(ctx)
            }
            Sender::Node(node) if transmission.outcome == Outcome::Delivered => {
                ctx.board.can_sent(self.id, node, ctx.now);
                self.deliver_to_nodes(Some(node), &transmission.frame, ctx);
                if board.on_bus() && board.timing.misfit(ctx.clocks.pclk1_hz).is_none() {
                    self.stats.rx += 1;
                    board.receive(&transmission.frame, transmission.started, filters, ctx);
                }
            }
            Sender::Node(_) => {}
        }
    }

    fn finish_own(
        &mut self,
        mailbox: usize,
        transmission: &Transmission,
        board: &mut Controller,
        ctx: &mut Ctx<'_>,
    ) {
        let was_passive = board.errors.is_passive();
        let result = match transmission.outcome {
            Outcome::Delivered => Ok(()),
            Outcome::NotAcknowledged => Err(ErrorCode::Acknowledgement),
            Outcome::NotDriven => Err(ErrorCode::BitDominant),
            Outcome::Misread => Err(ErrorCode::BitRecessive),
        };
        board.attempt_ended(mailbox, result, ctx);
        if result.is_ok() {
            self.stats.tx += 1;
            self.deliver_to_nodes(None, &transmission.frame, ctx);
        }
        if was_passive {
            let bits = INTERMISSION_BITS + SUSPEND_BITS;
            self.board_suspended_until = ctx.now + bits * transmission.bit;
        }
    }

    fn deliver_to_nodes(&self, sender: Option<usize>, frame: &CanFrame, ctx: &mut Ctx<'_>) {
        for node in 0..ctx.board.can_nodes(self.id) {
            if Some(node) != sender && ctx.board.can_hears(self.id, node) {
                ctx.board.can_received(self.id, node, frame, ctx.now);
            }
        }
    }

    /// Wakes a sleeping controller at a start of frame, if it has enabled that.
    fn wake(&self, board: &mut Controller) {
        if board.mode == Mode::Sleep && board.mcr & mcr::AWUM != 0 {
            board.mcr &= !mcr::SLEEP;
            board.msr_flags |= msr::WKUI;
        }
    }

    /// Delays a controller that waits for eleven recessive bits until the end of the frame, the only place with that many.
    fn delay_quiet_bus(&self, transmission: &Transmission, quiet_at: Ps, board: &mut Controller) {
        if let Mode::Synchronising(until) = &mut board.mode
            && *until != Ps::MAX
        {
            *until = quiet_at;
        }
        if let Some(at) = &mut board.recovers_at {
            let frame_time = quiet_at - transmission.started;
            *at += frame_time.saturating_sub(11 * transmission.bit);
        }
    }
}

/// Duration from start of frame to the end of end-of-frame or of the error frame, in bits of the sender.
fn bits_until_end(transmission: &Transmission) -> Ps {
    let whole = Ps::from(frame_bits::length(&transmission.frame));
    match transmission.outcome {
        Outcome::Delivered => whole,
        Outcome::NotAcknowledged => whole - AFTER_ACK_BITS + ERROR_FRAME_BITS,
        Outcome::NotDriven => 1 + ERROR_FRAME_BITS,
        Outcome::Misread => MISREAD_BITS + ERROR_FRAME_BITS,
    }
}

#[cfg(test)]
mod tests;
