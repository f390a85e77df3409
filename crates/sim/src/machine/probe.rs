//! A debug probe at the board's SWD connector, and the settings that stay in the core when it is detached.

use robot_plant::time::Ps;

use super::Machine;
use robot_emulator::core::system::debug_registers::{DEMCR_VC_CORERESET, DEMCR_VC_HARDERR};

/// The catch bits that `probe-rs run` and `attach` 0.28 to 0.32 set by default (docs/hardware.md#debug-probes).
const CAUGHT_BY_DEFAULT: u32 = DEMCR_VC_CORERESET | DEMCR_VC_HARDERR;
/// Functions with breakpoints in the `openocd.gdb` of Rust's Cortex-M quickstart, and the panic handler.
const BROKEN_AT: [&str; 4] = ["HardFault", "DefaultHandler", "main", "_defmt_panic"];

impl Machine {
    /// Sets the core up as `probe-rs run` does before it resumes it. The image then waits for a reader of its log.
    pub fn attach_probe(&mut self) {
        self.cpu.debug().attach(CAUGHT_BY_DEFAULT);
        self.log_is_read = true;
        if let Some(rtt) = &self.rtt {
            rtt.ask_to_block(&mut self.cpu);
        }
    }

    /// Detaches the probe. Its settings stay in the core until power-on, as probe-rs does not undo them on the STM32F4
    /// (docs/hardware.md#debug-probes). Nobody reads the log any more.
    pub(super) fn pull_probe(&mut self) {
        self.log_is_read = false;
    }

    /// Leaves the core in the state after a killed session of OpenOCD and gdb: with breakpoints, and with watchdogs that
    /// stop in every halt.
    pub(super) fn leave_breakpoints(&mut self) {
        let addresses = BROKEN_AT.map(|name| self.image.symbol(name));
        let addresses: Vec<u32> = addresses.into_iter().flatten().collect();
        let debug = self.cpu.debug();
        debug.attach(0);
        debug.breakpoints.set(&addresses);
        debug.freeze_watchdogs();
    }

    /// Simulates a debugger that sets its catch bits again whenever they are cleared.
    pub(super) fn keep_catches_set(&mut self, insists: bool) {
        let debug = self.cpu.debug();
        debug.attach(0);
        debug.keep_catches_set(if insists { CAUGHT_BY_DEFAULT } else { 0 });
    }

    /// Attaching and detaching halt the core for many SWD transactions.
    pub(super) fn halt_core(&mut self, time: Ps) {
        self.cpu.halt_for(time);
    }
}
