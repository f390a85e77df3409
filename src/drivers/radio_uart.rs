//! The input of the radio receiver: a UART with circular DMA and an idle-line interrupt.
//!
//! The HAL's ring-buffered receiver stops on every line error and drops its buffer. Errors are common on a radio line, so
//! here an error costs only the bytes that it came with, and reception goes on.

use core::future::poll_fn;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use core::task::Poll;

use embassy_stm32::dma::{Channel, ReadableRingBuffer, Request, TransferOptions};
use embassy_stm32::pac::usart::{Usart, vals};
use embassy_sync::waitqueue::AtomicWaker;
use robot_app::domain::RadioLineHealth;
use robot_app::input::RemoteFormat;

use crate::stall::StallWatch;

/// SBUS and DBUS both run at 100 kBd.
const BAUD: u32 = 100_000;

/// Line events since boot. The interrupt writes errors and idle, the task the rest.
pub struct RadioLine {
    idle: AtomicBool,
    waker: AtomicWaker,
    rx_events: AtomicU32,
    rx_bytes: AtomicU32,
    parity: AtomicU32,
    framing: AtomicU32,
    noise: AtomicU32,
    overrun: AtomicU32,
}

impl RadioLine {
    pub const fn new() -> Self {
        Self {
            idle: AtomicBool::new(false),
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

    /// Serves the interrupt of `uart`: counts line errors, and wakes the reader when the line falls idle.
    pub fn on_interrupt(&self, uart: Usart) {
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
            self.waker.wake();
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

/// The receiver's byte stream.
pub struct RadioUart {
    line: &'static RadioLine,
    ring: ReadableRingBuffer<'static, u8>,
    /// Errors that have damaged an earlier burst.
    reported: u32,
    stalls: StallWatch,
}

/// The bytes that arrived since the last read.
pub enum Burst<'a> {
    /// Bytes without a line error.
    Clean(&'a [u8]),
    /// A number of bytes of which the UART flagged or lost at least one.
    Damaged { count: usize },
}

impl RadioUart {
    /// Starts reception. The clock must run, the pin be muxed, and the interrupt of `uart` call
    /// [`RadioLine::on_interrupt`] of `line`.
    pub fn start(
        uart: Usart,
        line: &'static RadioLine,
        clock_hz: u32,
        format: RemoteFormat,
        dma: Channel<'static>,
        request: Request,
        buffer: &'static mut [u8],
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
        configure(uart, clock_hz, format);
        ring.start();
        uart.cr1().modify(|w| w.set_re(true));
        Self {
            line,
            ring,
            reported: line.health().errors(),
            stalls: StallWatch::new(),
        }
    }

    /// Waits for bytes: until the line falls idle, or half of the ring is full.
    pub async fn read<'a>(&mut self, bytes: &'a mut [u8]) -> Burst<'a> {
        loop {
            self.wait().await;
            if self.stalls.take().is_some() {
                // The ring holds only the end of what came meanwhile, which need not begin with a frame.
                self.ring.clear();
                continue;
            }
            let (mut count, mut left) = self.read_ring(bytes);
            // Only after the bytes: the interrupt preempts this task, so the error of a byte in the ring is counted.
            let errors = self.line.health().errors();
            if errors != self.reported {
                self.reported = errors;
                // The flagged byte may be among those that did not fit into `bytes`.
                while left > 0 {
                    let (more, rest) = self.read_ring(bytes);
                    count = count.saturating_add(more);
                    left = rest;
                }
                self.line.count_burst(count);
                return Burst::Damaged { count };
            }
            if count > 0 {
                self.line.count_burst(count);
                return Burst::Clean(bytes.get(..count).unwrap_or_default());
            }
        }
    }

    /// How many bytes were read and how many are left.
    fn read_ring(&mut self, bytes: &mut [u8]) -> (usize, usize) {
        self.ring.read(bytes).unwrap_or_else(|_| {
            // Overwritten before it was read; the HAL has emptied the ring.
            increment(&self.line.overrun);
            (0, 0)
        })
    }

    async fn wait(&mut self) {
        poll_fn(|cx| {
            self.line.waker.register(cx.waker());
            self.ring.set_waker(cx.waker());
            let half = self.ring.capacity() / 2;
            let filling = self.ring.len().is_ok_and(|len| len < half);
            if self.line.idle.swap(false, Ordering::Acquire) || !filling {
                Poll::Ready(())
            } else {
                Poll::Pending
            }
        })
        .await;
    }
}

/// SBUS is 8E2, DBUS 8E1 (docs/hardware.md#sbus, docs/hardware.md#dbus).
fn configure(uart: Usart, clock_hz: u32, format: RemoteFormat) {
    // With 16-fold oversampling BRR is the divider in sixteenths: clock / baud (RM0090 30.3.4).
    uart.brr()
        .write_value(embassy_stm32::pac::usart::regs::Brr(clock_hz / BAUD));
    uart.cr2().write(|w| {
        w.set_stop(match format {
            RemoteFormat::Sbus => vals::Stop::STOP2,
            RemoteFormat::Dbus => vals::Stop::STOP1,
        });
    });
    uart.cr3().write(|w| {
        w.set_dmar(true);
        w.set_eie(true);
    });
    uart.cr1().write(|w| {
        // Nine bits to the shift register: eight data bits and parity.
        w.set_m0(vals::M0::BIT9);
        w.set_pce(true);
        w.set_ps(vals::Ps::EVEN);
        w.set_idleie(true);
        w.set_peie(true);
        w.set_ue(true);
    });
}
