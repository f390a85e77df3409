//! The last resort: a panic or a CPU fault sends zero torque on both buses, logs, and waits for the watchdog.
//!
//! `panic-probe` is not used: it halts without touching the motors.

use core::arch::global_asm;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::pac::can::Can;
use embassy_stm32::pac::{CAN1, CAN2, RCC};
use robot_app::domain::{BusId, CanFrame, LastWords};

use crate::board;
use crate::config::SAFE_FRAMES;
use crate::drivers::can::transmit::{self, MailboxesFull};
use crate::drivers::debug_probe;
use crate::last_words;

/// Register reads to wait for the mailboxes, about 0.5 ms: a frame takes at most 0.14 ms.
const MAILBOX_POLLS: u32 = 6_000;
/// CPU cycles between two rounds of zero frames, 1 ms.
const ROUND_CYCLES: u32 = 168_000;
/// Rounds after which the chip resets itself, in case the watchdog was not running yet.
const ROUNDS: u32 = 100;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    enter(LastWords::Panic);
    if first_time() {
        defmt::error!("{}", defmt::Display2Format(info));
    }
    stay_safe_until_reset()
}

#[defmt::panic_handler]
fn defmt_panic() -> ! {
    enter(LastWords::Panic);
    stay_safe_until_reset()
}

// The vector of every CPU fault. After a stack overflow the stack pointer is below CCM, where the first push would
// lock the core up; near the bottom there is no room for the handler either. Then the stack starts anew at the top.
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

/// `frame` is the stack pointer at the fault: all code here runs on the main stack.
extern "C" fn hard_fault(frame: *const ExceptionFrame) -> ! {
    enter(LastWords::HardFault);
    if first_time() {
        match stacked_frame(frame) {
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

/// `None` if the CPU found no stack to put its registers on.
fn stacked_frame(frame: *const ExceptionFrame) -> Option<&'static ExceptionFrame> {
    unsafe extern "C" {
        static _stack_start: u32;
        static _stack_end: u32;
    }
    let stack = (&raw const _stack_end).addr()..(&raw const _stack_start).addr();
    let last_byte = frame
        .addr()
        .checked_add(size_of::<ExceptionFrame>())?
        .checked_sub(1)?;
    let whole = stack.contains(&frame.addr()) && stack.contains(&last_byte) && frame.is_aligned();
    // SAFETY: lies in the stack, where the CPU has put a frame; the handler's own stack is below it or, started anew,
    // far above. All bit patterns are valid.
    whole.then(|| unsafe { &*frame })
}

#[exception]
unsafe fn DefaultHandler(irq: i16) -> ! {
    enter(LastWords::UnexpectedInterrupt);
    if first_time() {
        defmt::error!("unexpected exception or interrupt {=i16}", irq);
    }
    stay_safe_until_reset()
}

/// Stops everything else and sends the first zero frames. A fault on the way to the reset keeps the first words.
fn enter(words: LastWords) {
    cortex_m::interrupt::disable();
    send_zero_torque();
    board::force_heater_off();
    // A debugger may have come since the last tick: the reset at the end must not halt the core.
    debug_probe::undo();
    static SPOKEN: AtomicBool = AtomicBool::new(false);
    if !SPOKEN.swap(true, Ordering::Relaxed) {
        // SAFETY: a fault handler, and interrupts are disabled until the reset.
        unsafe { last_words::leave(words) };
    }
}

/// False when logging itself failed and led back here.
fn first_time() -> bool {
    static LOGGED: AtomicBool = AtomicBool::new(false);
    !LOGGED.swap(true, Ordering::Relaxed)
}

/// Motor controllers may keep their last command, so zero is repeated until the reset comes.
fn stay_safe_until_reset() -> ! {
    for _ in 0..ROUNDS {
        cortex_m::asm::delay(ROUND_CYCLES);
        send_zero_torque();
    }
    cortex_m::peripheral::SCB::sys_reset()
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
