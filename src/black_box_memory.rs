//! The memory of the black box, which survives a reset.

use robot_app::black_box::BlackBoxMemory;

/// The start-up code does not initialise `.uninit`, which holds noise after power-on.
// SAFETY: `memory.x` and cortex-m-rt place the section in SRAM, where any static may live. Every bit pattern is a value.
#[unsafe(link_section = ".uninit.black_box")]
static MEMORY: BlackBoxMemory = BlackBoxMemory::new();

/// The memory as the run before left it.
pub fn memory() -> &'static BlackBoxMemory {
    // The compiler must not take the initial value for what the memory holds.
    core::hint::black_box(&MEMORY)
}
