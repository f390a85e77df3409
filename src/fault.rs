//! The last resort: a panic or a CPU fault sends zero torque on both buses, logs, and waits for the watchdog.
//!
//! `panic-probe` logs a panic with its place and then executes UDF, so a panic arrives here as a hard fault.

use core::arch::global_asm;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::pac::can::Can;
use embassy_stm32::pac::{CAN1, CAN2, RCC};
use panic_probe as _;
use robot_app::domain::{BusId, CanFrame, CrashCause};

use crate::board;
use crate::config::SAFE_FRAMES;
use crate::crash_record;
use crate::drivers::can::transmit::{self, MailboxesFull};
use crate::drivers::debug_probe;

/// Register reads to wait for the mailboxes, about 0.5 ms: a frame takes at most 0.14 ms.
const MAILBOX_POLLS: u32 = 6_000;
/// CPU cycles between two rounds of zero frames, 1 ms.
const ROUND_CYCLES: u32 = 168_000;
/// Rounds after which the chip resets itself, in case the watchdog was not running yet.
const ROUNDS: u32 = 100;

// The vector of every CPU fault. After a stack overflow the stack pointer is below CCM, where the first push would lock the
// core up; near the bottom of CCM there is no room for the handler either. In both cases the stack restarts at the top.
global_asm!(
    ".section .HardFault.user, \"ax\"",
    ".global HardFault",
    ".type HardFault,%function",
    ".thumb_func",
    "HardFault:",
    "mrs r0, msp",
    "movw r1, #:lower16:_stack_end",
    "movt r1, #:upper16:_stack_end",
    "movw r2, #:lower16:_stack_start",
    "movt r2, #:upper16:_stack_start",
    "add r1, r1, #{room}",
    "cmp r0, r1",
    "blo 0f",
    "cmp r0, r2",
    "bls 1f",
    "0: msr msp, r2",
    "1: b {handler}",
    ".size HardFault, . - HardFault",
    room = const HANDLER_STACK_BYTES,
    handler = sym hard_fault,
);

/// More than the handlers below need to send and to log.
const HANDLER_STACK_BYTES: u32 = 2_048;

/// Ends a CPU fault or a panic. `frame` is the stack pointer at the fault: all code here runs on the main stack.
extern "C" fn hard_fault(frame: *const ExceptionFrame) -> ! {
    stop_everything();
    let frame = stacked_frame(frame);
    let panicked = frame.is_some_and(is_panic);
    let is_first = write_crash_record(if panicked {
        CrashCause::Panic
    } else {
        CrashCause::HardFault
    });
    if is_first && !panicked {
        match frame {
            Some(frame) => defmt::error!(
                "hard fault at pc {=u32:#010x}, lr {=u32:#010x}",
                frame.pc(),
                frame.lr()
            ),
            None => defmt::error!("hard fault: stack overflow"),
        }
    }
    stay_safe_until_reset()
}

/// Whether the fault is the UDF instruction with which `panic-probe` ends a panic.
fn is_panic(frame: &ExceptionFrame) -> bool {
    const UNDEFINSTR: u32 = 1 << 16;
    const UDF_0: u16 = 0xDE00;
    // SAFETY: the System Control Block of every Cortex-M4; all accesses are volatile.
    let scb = unsafe { &*SCB::PTR };
    if scb.cfsr.read() & UNDEFINSTR == 0 {
        return false;
    }
    let instruction = frame.pc() as *const u16;
    // SAFETY: the CPU fetched an instruction from there just now, so memory answers, and instructions are half-words.
    let opcode = unsafe { instruction.read_volatile() };
    opcode == UDF_0
}

/// `None` if the CPU found no stack to put its registers on.
fn stacked_frame(frame: *const ExceptionFrame) -> Option<&'static ExceptionFrame> {
    // SAFETY: `memory.x` defines both symbols. Only their addresses are taken.
    unsafe extern "C" {
        static _stack_start: u32;
        static _stack_end: u32;
    }
    let stack = (&raw const _stack_end).addr()..(&raw const _stack_start).addr();
    let last_byte = frame
        .addr()
        .checked_add(size_of::<ExceptionFrame>())?
        .checked_sub(1)?;
    let is_whole =
        stack.contains(&frame.addr()) && stack.contains(&last_byte) && frame.is_aligned();
    if !is_whole {
        return None;
    }
    // SAFETY: the frame lies in the stack, where the CPU has put it; the handler's own stack is below it or, started
    // anew, far above. All bit patterns are valid.
    Some(unsafe { &*frame })
}

#[exception]
unsafe fn DefaultHandler(irq: i16) -> ! {
    stop_everything();
    if write_crash_record(CrashCause::UnexpectedInterrupt) {
        defmt::error!("unexpected exception or interrupt {=i16}", irq);
    }
    stay_safe_until_reset()
}

/// Stops everything else and sends the first zero frames.
fn stop_everything() {
    cortex_m::interrupt::disable();
    send_zero_torque();
    board::force_heater_off();
    // A debugger may have come since the last tick: the reset at the end must not halt the core.
    debug_probe::undo();
}

/// Records the cause for the next run. False if this run has failed before: a fault on the way to the reset keeps the
/// first cause.
fn write_crash_record(cause: CrashCause) -> bool {
    static HAS_FAILED: AtomicBool = AtomicBool::new(false);
    if HAS_FAILED.swap(true, Ordering::Relaxed) {
        return false;
    }
    // SAFETY: a fault handler, and interrupts are disabled until the reset.
    unsafe { crash_record::write(cause) };
    true
}

/// Motor controllers may keep their last command, so zero is repeated until the reset comes.
fn stay_safe_until_reset() -> ! {
    for _ in 0..ROUNDS {
        cortex_m::asm::delay(ROUND_CYCLES);
        send_zero_torque();
    }
    SCB::sys_reset()
}

fn send_zero_torque() {
    for bus in BusId::ALL {
        if let Some(can) = running_peripheral(bus) {
            transmit::retire_old_frames(can);
            send_safe_frames(can, bus);
        }
    }
}

/// A dead bus is given up at the first frame that finds no place.
fn send_safe_frames(can: Can, bus: BusId) {
    for (_, frame) in SAFE_FRAMES.iter().filter(|(on, _)| *on == bus) {
        if send_when_free(can, frame).is_err() {
            return;
        }
    }
}

/// Touching a peripheral without clock would be a fault inside the fault.
fn running_peripheral(bus: BusId) -> Option<Can> {
    let clocks = RCC.apb1enr().read();
    match bus {
        BusId::Can1 if clocks.can1en() => Some(CAN1),
        BusId::Can2 if clocks.can2en() => Some(CAN2),
        _ => None,
    }
}

fn send_when_free(can: Can, frame: &CanFrame) -> Result<(), MailboxesFull> {
    for _ in 0..MAILBOX_POLLS {
        if transmit::send(can, frame).is_ok() {
            return Ok(());
        }
    }
    Err(MailboxesFull)
}
