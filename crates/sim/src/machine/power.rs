//! The board's supply. The motors, the radio and the PC have supplies of their own and keep running. The sensors lose their
//! power together with the board.

use robot_plant::time::{MS, Ps};

use super::Machine;
use robot_emulator::soc::reset::ResetCause;

/// Default length of a power cut at a step of the flash.
pub(super) const OFF_TIME: Ps = 100 * MS;

impl Machine {
    /// How long the board stays off after a power cut at a step of the flash.
    pub fn set_off_time(&mut self, time: Ps) {
        self.off_time = time;
    }

    /// Cuts the power now. It returns `off_time` later, and the image boots.
    pub fn cut_power(&mut self, off_time: Ps) {
        self.power_off(self.cpu.now().saturating_add(off_time));
    }

    /// Sets the chip's supply, which is 3300 mV at first. The chip works from 1.8 V on.
    pub fn set_vdd_mv(&mut self, vdd_mv: u32) {
        self.cpu.with_soc(|soc, _| soc.set_vdd_mv(vdd_mv));
    }

    /// Switches the board off until it is switched on again, or on.
    pub(super) fn switch_power(&mut self, on: bool) {
        if !on {
            self.power_off(Ps::MAX);
        } else if !self.cpu.is_powered() {
            self.power_up();
        }
    }

    pub(super) fn power_off(&mut self, until: Ps) {
        self.poll_log();
        self.diagnostics.forget();
        self.stack_peak = self.stack_peak.max(self.stack.peak(&self.cpu));
        self.cpu
            .with_soc(|soc, now| soc.reset(ResetCause::PowerOn, now));
        self.with_world(|world| world.set_board_supply(false));
        self.cpu.power_off(until);
    }

    pub(super) fn power_up(&mut self) {
        self.resets.push(format!("{:?}", ResetCause::PowerOn));
        self.with_world(|world| world.set_board_supply(true));
        self.cpu.power_up();
        self.ticks.rebooted();
    }
}
