//! The receiving half of a UART: circular DMA and an idle-line interrupt.
//!
//! The HAL's ring-buffered receiver stops on every line error and drops its buffer. Errors are common on a radio line and
//! on a long cable, so here an error costs only the bytes that it came with, and reception goes on.

use core::future::poll_fn;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use core::task::Poll;

use embassy_stm32::dma::{Channel, ReadableRingBuffer, Request, TransferOptions};
use embassy_stm32::pac::usart::Usart;
use embassy_sync::waitqueue::AtomicWaker;
use robot_app::domain::RadioLineHealth;

use crate::stall::StallWatch;

/// Line events since boot. The interrupt and the reader write them.
pub struct UartLine {
    idle: AtomicBool,
    /// The reader waits for an idle line. At other times one does not wake it, however often the line falls idle.
    awaited: AtomicBool,
    waker: AtomicWaker,
    rx_events: AtomicU32,
    rx_bytes: AtomicU32,
    parity: AtomicU32,
    framing: AtomicU32,
    noise: AtomicU32,
    overrun: AtomicU32,
}

impl UartLine {
    pub const fn new() -> Self {
        Self {
            idle: AtomicBool::new(false),
            awaited: AtomicBool::new(false),
            waker: AtomicWaker::new(),
            rx_events: AtomicU32::new(0),
            rx_bytes: AtomicU32::new(0),
            parity: AtomicU32::new(0),
            framing: AtomicU32::new(0),
            noise: AtomicU32::new(0),
            overrun: AtomicU32::new(0),
        }
    }

    /// The counters since boot.
    pub fn health(&self) -> RadioLineHealth {
        RadioLineHealth {
            rx_events: self.rx_events.load(Ordering::Relaxed),
            rx_bytes: self.rx_bytes.load(Ordering::Relaxed),
            parity: self.parity.load(Ordering::Relaxed),
            framing: self.framing.load(Ordering::Relaxed),
            noise: self.noise.load(Ordering::Relaxed),
            overrun: self.overrun.load(Ordering::Relaxed),
        }
    }

    /// Serves the flags of `uart`: counts line errors, and wakes the reader when the line falls idle.
    pub fn serve(&self, uart: Usart) {
        let status = uart.sr().read();
        if !(status.idle() || status.pe() || status.fe() || status.ne() || status.ore()) {
            return;
        }
        // Reading DR after SR clears the flags (RM0090 30.6.1). DMA has taken the byte long before idle; after
        // an error the byte is worthless.
        let _ = uart.dr().read();
        for (flag, counter) in [
            (status.pe(), &self.parity),
            (status.fe(), &self.framing),
            (status.ne(), &self.noise),
            (status.ore(), &self.overrun),
        ] {
            if flag {
                increment(counter);
            }
        }
        if status.idle() {
            self.idle.store(true, Ordering::Release);
            if self.awaited.swap(false, Ordering::Relaxed) {
                self.waker.wake();
            }
        }
    }

    fn count_burst(&self, bytes: usize) {
        increment(&self.rx_events);
        // The count fits: it is no more than the ring holds.
        self.rx_bytes.fetch_add(bytes as u32, Ordering::Relaxed);
    }
}

fn increment(counter: &AtomicU32) {
    counter.fetch_add(1, Ordering::Relaxed);
}

/// How line errors come to be counted.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum ErrorReports {
    /// Each by an interrupt. A line whose every byte is wrong causes as many interrupts as it carries bytes.
    Interrupt,
    /// The reader asks for them, and counts those of one kind between two reads as one.
    Polled,
}

/// The bytes that arrived since the last call of [`UartReceiver::take`].
pub struct Burst<'a> {
    pub bytes: &'a [u8],
    /// Errors by which the UART flagged or lost bytes.
    pub errors: u32,
}

/// The byte stream of a UART, with room for `N` bytes.
pub struct UartReceiver<const N: usize> {
    uart: Usart,
    line: &'static UartLine,
    ring: ReadableRingBuffer<'static, u8>,
    error_reports: ErrorReports,
    /// Errors that have damaged an earlier burst.
    reported: u32,
    stalls: StallWatch,
}

impl<const N: usize> UartReceiver<N> {
    /// Starts reception. The UART must be set up and enabled, its receiver not; its interrupt must call
    /// [`UartLine::serve`] of `line`.
    pub fn start(
        uart: Usart,
        line: &'static UartLine,
        dma: Channel<'static>,
        request: Request,
        buffer: &'static mut [u8; N],
        error_reports: ErrorReports,
    ) -> Self {
        let data_register = uart.dr().as_ptr().cast::<u8>();
        // SAFETY: `request` routes this UART's receive requests to `dma` (board.rs), the data register stays
        // valid, and `buffer` is static memory in SRAM that nobody else uses.
        let mut ring = unsafe {
            ReadableRingBuffer::new(
                dma,
                request,
                data_register,
                buffer,
                TransferOptions::default(),
            )
        };
        let with_interrupts = error_reports == ErrorReports::Interrupt;
        uart.cr3().modify(|w| {
            w.set_dmar(true);
            w.set_eie(with_interrupts);
        });
        ring.start();
        uart.cr1().modify(|w| {
            w.set_idleie(true);
            w.set_peie(with_interrupts);
            w.set_re(true);
        });
        Self {
            uart,
            line,
            ring,
            error_reports,
            reported: line.health().errors(),
            stalls: StallWatch::new(),
        }
    }

    /// Waits until the line falls idle or half of the ring is full.
    pub async fn wait(&mut self) {
        poll_fn(|cx| {
            self.line.waker.register(cx.waker());
            self.line.awaited.store(true, Ordering::Release);
            self.ring.set_waker(cx.waker());
            let filling = self.ring.len().is_ok_and(|len| len < N / 2);
            if self.line.idle.swap(false, Ordering::Acquire) || !filling {
                Poll::Ready(())
            } else {
                Poll::Pending
            }
        })
        .await;
    }

    /// Hands everything that has arrived to `sink`. After a stall that is nothing: the ring holds only the end of what came
    /// meanwhile, which need not begin with a frame.
    pub fn take(&mut self, sink: impl FnOnce(Burst<'_>)) {
        self.line.idle.store(false, Ordering::Relaxed);
        if self.stalls.take().is_some() {
            self.ring.clear();
            self.reported = self.line.health().errors();
            return;
        }
        let mut bytes = [0; N];
        let count = match self.ring.read(&mut bytes) {
            Ok((count, _)) => count,
            Err(_) => {
                // Overwritten before it was read; the HAL has emptied the ring.
                increment(&self.line.overrun);
                0
            }
        };
        if count > 0 {
            self.line.count_burst(count);
            if self.error_reports == ErrorReports::Polled {
                self.line.serve(self.uart);
            }
        }
        // Only after the bytes: the interrupt preempts this task, so the error of a byte in the ring is counted.
        let errors = self.line.health().errors();
        let before = core::mem::replace(&mut self.reported, errors);
        sink(Burst {
            bytes: bytes.get(..count).unwrap_or_default(),
            errors: errors.wrapping_sub(before),
        });
    }
}
