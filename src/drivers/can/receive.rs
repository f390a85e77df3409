//! Receive interrupts, which only move frames from a hardware FIFO to a single-producer queue.

use core::marker::PhantomData;
use core::sync::atomic::{AtomicU32, Ordering};

use bxcan::{Frame, Id, OverrunError, Rx0, Rx1};
use embassy_stm32::interrupt::typelevel::{Handler, Interrupt};
use embassy_time::Instant;
use heapless::spsc::{Consumer, Producer, Queue};
use robot_app::domain::{CanFrame, StandardId};
use static_cell::StaticCell;

use super::peripherals::{Can1, Can2};
use crate::isr_cell::IsrCell;

/// Places in each queue, of which one stays unused. A bus at 1 Mb/s carries at most about 20 frames per tick.
const QUEUE_LEN: usize = 32;

/// A frame with the time of its interrupt.
#[derive(Clone, Copy)]
pub struct ReceivedFrame {
    pub frame: CanFrame,
    pub ts_us: u64,
}

type FrameQueue = Queue<ReceivedFrame, QUEUE_LEN>;

/// The control tick's end of one hardware FIFO.
pub struct FrameSource {
    pub queue: Consumer<'static, ReceivedFrame>,
    losses: &'static LossCounters,
}

/// Frames lost since boot.
pub struct Losses {
    /// In the hardware FIFO.
    pub overruns: u32,
    /// Because the control tick did not empty the queue.
    pub queue_full: u32,
}

impl FrameSource {
    pub fn losses(&self) -> Losses {
        Losses {
            overruns: self.losses.overruns.load(Ordering::Relaxed),
            queue_full: self.losses.queue_full.load(Ordering::Relaxed),
        }
    }

    /// Subtracts losses that do not count as faults.
    pub fn discount(&self, losses: &Losses) {
        let counters = self.losses;
        counters
            .overruns
            .fetch_sub(losses.overruns, Ordering::Relaxed);
        counters
            .queue_full
            .fetch_sub(losses.queue_full, Ordering::Relaxed);
    }
}

struct LossCounters {
    overruns: AtomicU32,
    queue_full: AtomicU32,
}

/// The data of one FIFO's interrupt handler.
struct FifoIsr<R> {
    fifo: R,
    queue: Producer<'static, ReceivedFrame>,
}

/// Statics of one hardware FIFO.
pub struct FifoStatics<R: 'static> {
    isr: IsrCell<FifoIsr<R>>,
    queue: StaticCell<FrameQueue>,
    losses: LossCounters,
}

impl<R> FifoStatics<R> {
    const fn new() -> Self {
        Self {
            isr: IsrCell::empty(),
            queue: StaticCell::new(),
            losses: LossCounters {
                overruns: AtomicU32::new(0),
                queue_full: AtomicU32::new(0),
            },
        }
    }
}

/// One of the four receive FIFOs of the chip.
pub trait ReceiveFifo: Sized + Send + 'static {
    fn statics() -> &'static FifoStatics<Self>;
    fn receive(&mut self) -> nb::Result<Frame, OverrunError>;
}

macro_rules! receive_fifo {
    ($name:ident, $fifo:ident, $can:ident) => {
        static $name: FifoStatics<$fifo<$can>> = FifoStatics::new();

        impl ReceiveFifo for $fifo<$can> {
            fn statics() -> &'static FifoStatics<Self> {
                &$name
            }

            fn receive(&mut self) -> nb::Result<Frame, OverrunError> {
                $fifo::receive(self)
            }
        }
    };
}

receive_fifo!(CAN1_FIFO0, Rx0, Can1);
receive_fifo!(CAN1_FIFO1, Rx1, Can1);
receive_fifo!(CAN2_FIFO0, Rx0, Can2);
receive_fifo!(CAN2_FIFO1, Rx1, Can2);

/// Connects a hardware FIFO to its queue. Its interrupt must still be masked.
pub fn install<R: ReceiveFifo>(fifo: R) -> FrameSource {
    let statics = R::statics();
    let (producer, consumer) = statics.queue.init(Queue::new()).split();
    // SAFETY: called by `start` before the board unmasks the CAN interrupts; `StaticCell::init` above would
    // have stopped a second call.
    unsafe {
        statics.isr.install(FifoIsr {
            fifo,
            queue: producer,
        });
    }
    FrameSource {
        queue: consumer,
        losses: &statics.losses,
    }
}

/// Interrupt handler of one receive FIFO.
pub struct FifoInterrupt<R>(PhantomData<R>);

impl<I: Interrupt, R: ReceiveFifo> Handler<I> for FifoInterrupt<R> {
    unsafe fn on_interrupt() {
        let statics = R::statics();
        // SAFETY: each FIFO is bound to one interrupt in `board.rs`, and no other code uses its `isr` cell.
        unsafe { statics.isr.with(|isr| isr.drain(&statics.losses)) };
    }
}

impl<R: ReceiveFifo> FifoIsr<R> {
    fn drain(&mut self, losses: &LossCounters) {
        loop {
            match self.fifo.receive() {
                Ok(frame) => self.enqueue(&frame, losses),
                Err(nb::Error::Other(_)) => count(&losses.overruns),
                Err(nb::Error::WouldBlock) => return,
            }
        }
    }

    fn enqueue(&mut self, frame: &Frame, losses: &LossCounters) {
        // The filters let only standard data frames through; anything else has no reader.
        let (Id::Standard(id), Some(data)) = (frame.id(), frame.data()) else {
            return;
        };
        let Some(frame) =
            StandardId::new(id.as_raw()).and_then(|id| CanFrame::from_payload(id, data))
        else {
            return;
        };
        let received = ReceivedFrame {
            frame,
            ts_us: Instant::now().as_micros(),
        };
        if self.queue.enqueue(received).is_err() {
            count(&losses.queue_full);
        }
    }
}

fn count(counter: &AtomicU32) {
    // No other writer of the counter can preempt this handler, so load and store need no atomic exchange.
    counter.store(
        counter.load(Ordering::Relaxed).wrapping_add(1),
        Ordering::Relaxed,
    );
}
