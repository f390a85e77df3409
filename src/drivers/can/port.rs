//! One CAN bus as the control tick sees it.

use embassy_stm32::pac::can::Can;
use robot_app::domain::{BusErrorState, BusHealth, BusId, CanFrame};

use super::link::Link;
use super::receive::{FrameSource, Losses};
use super::transmit::{self, Outcomes};

/// Receive queues, transmit mailboxes and link state of one bus.
pub struct CanPort {
    bus: BusId,
    can: Can,
    sources: [FrameSource; 2],
    link: Link,
    health: BusHealth,
}

impl CanPort {
    pub(super) fn new(bus: BusId, can: Can, sources: [FrameSource; 2]) -> Self {
        Self {
            bus,
            can,
            sources,
            link: Link::join(can),
            health: BusHealth::default(),
        }
    }

    pub fn bus(&self) -> BusId {
        self.bus
    }

    pub fn health(&self) -> &BusHealth {
        &self.health
    }

    /// Whether the peripheral takes part in bus traffic.
    pub fn is_on_bus(&self) -> bool {
        self.link.is_on_bus()
    }

    /// Aborts frames of the last tick that still wait, advances the link and reads the error state. Never waits. Part of
    /// the control tick.
    #[inline(always)]
    pub fn begin_tick(&mut self, now_us: u64) {
        let outcomes = transmit::retire_old_frames(self.can);
        if outcomes.sent > 0 {
            self.link.frame_got_through(now_us);
        }
        self.link.step(now_us);
        self.count_outcomes(outcomes);
        self.read_error_state();
    }

    /// Empties the queues after a stall of the whole chip: the arrival times are unknown, and lost frames are no fault.
    #[cold]
    #[inline(never)]
    pub fn drop_backlog(&mut self) {
        for source in &mut self.sources {
            while source.queue.dequeue().is_some() {}
        }
        let (overruns, queue_full) = self.losses();
        let [fifo0, _] = &self.sources;
        fifo0.discount(&Losses {
            overruns: overruns.wrapping_sub(self.health.rx_overruns),
            queue_full: queue_full.wrapping_sub(self.health.rx_queue_full),
        });
    }

    /// Passes every received frame with its arrival time to `sink`.
    pub fn drain(&mut self, mut sink: impl FnMut(&CanFrame, u64)) {
        for source in &mut self.sources {
            // A frame is read in its place, as copies of it would cost the tick more than the rest.
            while let Some(received) = source.queue.peek() {
                sink(&received.frame, received.ts_us);
                self.health.rx_frames = self.health.rx_frames.wrapping_add(1);
                // SAFETY: `peek` has found a frame, and nobody else takes frames out. Asking once more would cost the tick
                // five instructions a frame.
                unsafe { source.queue.dequeue_unchecked() };
            }
        }
    }

    /// Whether a mailbox is free.
    pub fn has_room(&self) -> bool {
        transmit::has_room(self.can)
    }

    /// Sends a frame in this tick. One that finds no free mailbox counts as expired.
    pub fn send(&mut self, frame: &CanFrame) {
        if !self.link.is_on_bus() || transmit::send(self.can, frame).is_err() {
            self.count_outcomes(Outcomes {
                sent: 0,
                expired: 1,
            });
        }
    }

    fn count_outcomes(&mut self, outcomes: Outcomes) {
        let health = &mut self.health;
        health.tx_frames = health.tx_frames.wrapping_add(outcomes.sent);
        health.tx_aborted = health.tx_aborted.wrapping_add(outcomes.expired);
        health.tx_failures_in_row = if outcomes.sent > 0 {
            0
        } else {
            health.tx_failures_in_row.saturating_add(outcomes.expired)
        };
    }

    fn read_error_state(&mut self) {
        let errors = self.can.esr().read();
        let health = &mut self.health;
        health.transmit_errors = errors.tec();
        health.receive_errors = errors.rec();
        health.bus_off_count = self.link.bus_off_count();
        health.state = if self.link.is_bus_off() {
            BusErrorState::BusOff
        } else if errors.epvf() {
            BusErrorState::Passive
        } else {
            BusErrorState::Active
        };
        (self.health.rx_overruns, self.health.rx_queue_full) = self.losses();
    }

    /// Overruns of the hardware and of the queue, summed over both FIFOs.
    fn losses(&self) -> (u32, u32) {
        let [fifo0, fifo1] = &self.sources;
        let (fifo0, fifo1) = (fifo0.losses(), fifo1.losses());
        (
            fifo0.overruns.wrapping_add(fifo1.overruns),
            fifo0.queue_full.wrapping_add(fifo1.queue_full),
        )
    }
}
