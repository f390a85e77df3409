//! The last resort: a panic or a CPU fault sends zero torque on both buses, logs, and waits for the watchdog.
//!
//! `panic-probe` is not used: it halts without touching the motors.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::pac::can::Can;
use embassy_stm32::pac::{CAN1, CAN2, RCC};
use robot_app::domain::{BusId, CanFrame};
use robot_app::motor;

use crate::drivers::can::transmit;

/// Register reads to wait for the mailboxes, about 0.5 ms: a frame takes at most 0.14 ms.
const MAILBOX_POLLS: u32 = 6_000;
/// CPU cycles between two rounds of zero frames, 1 ms.
const ROUND_CYCLES: u32 = 168_000;
/// Rounds after which the chip resets itself, in case the watchdog was not running yet.
const ROUNDS: u32 = 100;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    enter();
    if first_time() {
        defmt::error!("{}", defmt::Display2Format(info));
    }
    stay_safe_until_reset()
}

#[defmt::panic_handler]
fn defmt_panic() -> ! {
    enter();
    stay_safe_until_reset()
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    enter();
    if first_time() {
        defmt::error!(
            "hard fault at pc {=u32:#010x}, lr {=u32:#010x}",
            frame.pc(),
            frame.lr()
        );
    }
    stay_safe_until_reset()
}

#[exception]
unsafe fn DefaultHandler(irq: i16) -> ! {
    enter();
    if first_time() {
        defmt::error!("unexpected exception or interrupt {=i16}", irq);
    }
    stay_safe_until_reset()
}

/// Stops everything else and sends the first zero frames.
fn enter() {
    cortex_m::interrupt::disable();
    send_zero_torque();
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
    for (bus, frame) in motor::safe_frames() {
        if let Some(can) = running_peripheral(bus) {
            replace_mailboxes(can, &frame);
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

/// Drops what waits in the mailboxes and sends `frame`. Bounded: gives up on a dead bus.
fn replace_mailboxes(can: Can, frame: &CanFrame) {
    transmit::retire_old_frames(can);
    wait_until_idle(can);
    if transmit::send(can, frame).is_ok() {
        wait_until_idle(can);
    }
}

fn wait_until_idle(can: Can) {
    for _ in 0..MAILBOX_POLLS {
        if transmit::is_idle(can) {
            return;
        }
    }
}
