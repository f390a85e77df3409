//! Corrects the clock after the chip stood still.
//!
//! The time driver counts half turns of a 16-bit timer (32.768 ms each) in its interrupt. While no interrupt can run, it
//! misses all but two of them. The cycle counter of the core goes on counting and tells how many there were.

use cortex_m::Peripherals;
use cortex_m::peripheral::DWT;
use cortex_m::register::basepri;
use embassy_stm32::pac::TIM2;
use embassy_time::Instant;

/// All interrupts below priority 0, which the time driver alone has (`board.rs`).
const BELOW_TIME_DRIVER: u8 = 0x10;
/// The system clock.
const CYCLES_PER_US: u32 = 168;
/// Half a turn is two to this power, in µs.
const HALF_TURN_BITS: u32 = 15;
const HALF_TURN: u16 = 1 << HALF_TURN_BITS;
/// Least distances from the timer's events, in µs. After an event its interrupt must have run, and before the next one the
/// missing half turns must have been added.
const AFTER_EVENT: u16 = 64;
const BEFORE_EVENT: u16 = 256;

/// Runs `work`, during which no interrupt can run, and corrects the clock. Then it calls `repaired` with the time that
/// passed in µs, before any other interrupt runs. Thread mode only. Returns `None` without running `work` if the cycle
/// counter does not run.
pub fn keep_time<R>(work: impl FnOnce() -> R, repaired: impl FnOnce(u32)) -> Option<R> {
    if !start_cycle_counter() {
        return None;
    }
    // The first wait, with interrupts enabled, keeps the second one short.
    wait_between_events();
    // SAFETY: masks interrupts until the end of this function; no lock relies on their running.
    unsafe { basepri::write(BELOW_TIME_DRIVER) };
    wait_between_events();
    let (result, gap) = cortex_m::interrupt::free(|_| {
        let before = Moment::now();
        let result = work();
        wait_between_events();
        (result, Gap::since(&before))
    });
    // The driver's interrupt has run by now, for the events in the timer's flags.
    for _ in 0..gap.missing_half_turns {
        make_up_for_half_turn();
    }
    let elapsed_us = gap.elapsed_us;
    repaired(elapsed_us);
    // SAFETY: restores the previous state, as thread mode runs with all interrupts unmasked.
    unsafe { basepri::write(0) };
    Some(result)
}

/// Starts the cycle counter, which a debugger stops when it detaches. False if the counter still does not run.
pub fn start_cycle_counter() -> bool {
    // SAFETY: nobody else owns DCB and DWT, and all their writers run in thread mode: at boot, and for an erase.
    let mut core = unsafe { Peripherals::steal() };
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    let before = DWT::cycle_count();
    cortex_m::asm::delay(CYCLES_PER_US);
    DWT::cycle_count() != before
}

struct Moment {
    cycles: u32,
    now_us: u64,
}

impl Moment {
    fn now() -> Self {
        Self {
            cycles: DWT::cycle_count(),
            now_us: Instant::now().as_micros(),
        }
    }
}

struct Gap {
    elapsed_us: u32,
    /// Half turns that the driver's interrupt will not count by itself.
    missing_half_turns: u64,
}

impl Gap {
    /// Call this after a wait between events, while the driver's interrupt is masked.
    fn since(before: &Moment) -> Self {
        let (status, counter) = (TIM2.sr().read(), TIM2.cnt().read() as u16);
        let cycles = DWT::cycle_count().wrapping_sub(before.cycles);
        let roughly_us = before
            .now_us
            .saturating_add((cycles / CYCLES_PER_US).into());
        // The timer shows the low half of the true time.
        let off_us = counter.wrapping_sub(roughly_us as u16) as i16;
        let now_us = roughly_us.saturating_add_signed(off_us.into());
        let half_turns = |us: u64| us >> HALF_TURN_BITS;
        let seen = u64::from(status.uif()).saturating_add(status.ccif(0).into());
        Self {
            elapsed_us: now_us.saturating_sub(before.now_us) as u32,
            missing_half_turns: half_turns(now_us)
                .saturating_sub(half_turns(before.now_us))
                .saturating_sub(seen),
        }
    }
}

fn wait_between_events() {
    let safe = AFTER_EVENT..HALF_TURN.saturating_sub(BEFORE_EVENT);
    while !safe.contains(&(TIM2.cnt().read() as u16 % HALF_TURN)) {}
}

/// Raises the event of channel 1 (RM0090 18.4.6), by which the driver's interrupt counts one more half turn.
fn make_up_for_half_turn() {
    TIM2.egr().write(|w| w.set_ccg(0, true));
    while TIM2.sr().read().ccif(0) {}
}
