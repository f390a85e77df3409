//! Two interrupt executors: control preempts sensors, both preempt the thread executor.

use embassy_executor::{InterruptExecutor, SendSpawner};
use embassy_stm32::interrupt::typelevel::{Handler, Interrupt};

use crate::board::{CONTROL_EXECUTOR_IRQ, SENSOR_EXECUTOR_IRQ};

static CONTROL: InterruptExecutor = InterruptExecutor::new();
static SENSOR: InterruptExecutor = InterruptExecutor::new();

/// Handler of the control executor's interrupt.
pub struct ControlInterrupt;

/// Handler of the sensor executor's interrupt.
pub struct SensorInterrupt;

impl<I: Interrupt> Handler<I> for ControlInterrupt {
    unsafe fn on_interrupt() {
        // SAFETY: this is the handler of the interrupt that `start_control` gives to the executor, and `start`
        // unmasks it after the executor exists.
        unsafe { CONTROL.on_interrupt() };
    }
}

impl<I: Interrupt> Handler<I> for SensorInterrupt {
    unsafe fn on_interrupt() {
        // SAFETY: as above, for `start_sensor`.
        unsafe { SENSOR.on_interrupt() };
    }
}

/// Call once, after the board has set the priority.
pub fn start_control() -> SendSpawner {
    CONTROL.start(CONTROL_EXECUTOR_IRQ)
}

/// Call once, after the board has set the priority.
pub fn start_sensor() -> SendSpawner {
    SENSOR.start(SENSOR_EXECUTOR_IRQ)
}
