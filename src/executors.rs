//! Two interrupt executors: control preempts sensors, both preempt the thread executor.

use embassy_executor::{InterruptExecutor, SendSpawner};
use embassy_stm32::interrupt::Interrupt;
use embassy_stm32::interrupt::typelevel::{self, Handler};

static CONTROL: InterruptExecutor = InterruptExecutor::new();
static SENSOR: InterruptExecutor = InterruptExecutor::new();

/// Handler of the control executor's interrupt.
pub struct ControlInterrupt;

/// Handler of the sensor executor's interrupt.
pub struct SensorInterrupt;

impl<I: typelevel::Interrupt> Handler<I> for ControlInterrupt {
    unsafe fn on_interrupt() {
        // SAFETY: `board.rs` binds this handler to the interrupt that it gives to `start_control`, and `start` unmasks
        // that interrupt after the executor exists.
        unsafe { CONTROL.on_interrupt() };
    }
}

impl<I: typelevel::Interrupt> Handler<I> for SensorInterrupt {
    unsafe fn on_interrupt() {
        // SAFETY: `board.rs` binds this handler to the interrupt that it gives to `start_sensor`, and `start` unmasks
        // that interrupt after the executor exists.
        unsafe { SENSOR.on_interrupt() };
    }
}

/// Starts the control executor on the interrupt that [`ControlInterrupt`] serves. Call once, after the board has set
/// the interrupt's priority.
pub fn start_control(interrupt: Interrupt) -> SendSpawner {
    CONTROL.start(interrupt)
}

/// Starts the sensor executor on the interrupt that [`SensorInterrupt`] serves. Call once, after the board has set the
/// interrupt's priority.
pub fn start_sensor(interrupt: Interrupt) -> SendSpawner {
    SENSOR.start(interrupt)
}
