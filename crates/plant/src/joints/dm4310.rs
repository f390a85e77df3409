//! Damiao DM4310 geared motor with its driver (docs/hardware.md#dm4310).

mod receive;
mod registers;

use super::{
    actuator::Rating,
    drive::{Drive, DriveFaults, DriveParts, Reception, Shaft},
    mit_frame::MitCommand,
    speed_loop,
};
use crate::{
    time::{Ps, US},
    wire::CanFrame,
};
use registers::Registers;

/// V1.1: peak 7 N·m, 200 rpm without load at 24 V, static friction 0.15 N·m. From memory of the datasheet: 120 rpm at
/// the rated 3 N·m, which makes the slope and puts the stall torque at 24 V just above the peak. Assumed: 3 N·m for
/// ever end at 90 °C, after some minutes.
const RATING: Rating = Rating {
    peak_nm: 7.0,
    no_load_rps: 200.0 * std::f64::consts::TAU / 60.0,
    supply_v: 24.0,
    slope_rps_per_nm: 2.79,
    friction_nm: 0.15,
    kelvin_per_watt: 2.4,
    heat_capacity_j_per_k: 150.0,
};

const TIMEOUT_UNIT: Ps = 50 * US;
/// Identifiers of the fault `motor-N-wrong-id` are this much too high.
const WRONG_ID: u32 = 8;
const STANDARD_ID: u32 = 0x7FF;

/// Why a motor has switched itself off; the discriminant is the ERR field of its replies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trip {
    OverCurrent = 0xA,
    RotorTemperature = 0xC,
    CommunicationLost = 0xD,
}

/// A trip stays until it is cleared with FB, 0xD too (umeow0716/damiao_firmware, `app_commands.c`; nobody has tried it on
/// a motor). Enabling and command frames do not clear it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Disabled,
    Enabled,
    Tripped(Trip),
}

/// The command that an enabled motor follows; `None` until the first one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    None,
    Mit(MitCommand),
    PositionSpeed { pos_rad: f64, max_rps: f64 },
    Speed { vel_rps: f64 },
}

#[derive(Clone)]
pub(crate) struct Dm4310 {
    parts: DriveParts,
    /// The registers as stored, which a power cycle restores.
    stored: Registers,
    registers: Registers,
    state: State,
    target: Target,
    /// Time until which it stores its registers and neither receives nor sends.
    deaf_until: Ps,
}

impl Dm4310 {
    pub(crate) fn new(esc_id: u32, mst_id: u32) -> Self {
        let registers = Registers::new(esc_id, mst_id);
        Self {
            parts: DriveParts::new(&RATING),
            stored: registers,
            registers,
            state: State::Disabled,
            target: Target::None,
            deaf_until: 0,
        }
    }

    /// Performs a power cycle. Settings that were not stored are lost; temperature and zero position remain.
    fn power_cycle(&mut self, now: Ps) {
        self.registers = self.stored;
        self.deaf_until = now;
        self.parts.replies.drop_waiting();
        self.switch_off(State::Disabled);
    }

    fn switch_off(&mut self, state: State) {
        self.state = state;
        self.target = Target::None;
        self.parts.cut();
    }

    fn esc_id(&self) -> u32 {
        (self.registers.esc_id + u32::from(self.parts.faults.wrong_id) * WRONG_ID) & STANDARD_ID
    }

    fn mst_id(&self) -> u32 {
        (self.registers.mst_id + u32::from(self.parts.faults.wrong_id) * WRONG_ID) & STANDARD_ID
    }

    /// Runs the motor's own protection: time-out and over-temperature.
    fn watch(&mut self, now: Ps) {
        if self.state != State::Enabled {
            return;
        }
        let timeout = u64::from(self.registers.timeout) * TIMEOUT_UNIT;
        if timeout != 0 && now > self.parts.last_frame_at + timeout {
            self.switch_off(State::Tripped(Trip::CommunicationLost));
        } else if self.parts.actuator.winding_c() > f64::from(self.registers.over_temperature_c) {
            self.switch_off(State::Tripped(Trip::RotorTemperature));
        }
    }
}

impl Drive for Dm4310 {
    fn boxed(&self) -> Box<dyn Drive> {
        Box::new(self.clone())
    }

    fn parts(&self) -> &DriveParts {
        &self.parts
    }

    fn parts_mut(&mut self) -> &mut DriveParts {
        &mut self.parts
    }

    fn set_faults(&mut self, faults: DriveFaults, now: Ps) {
        if faults.gone || faults.wrong_id != self.parts.faults.wrong_id {
            self.power_cycle(now);
        }
        if faults.tripped {
            self.switch_off(State::Tripped(Trip::OverCurrent));
        }
        self.parts.actuator.heated = faults.hot;
        self.parts.faults = faults;
    }

    fn receive(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Reception {
        self.take_frame(frame, shaft, now)
    }

    fn enabled(&self) -> bool {
        self.state == State::Enabled
    }

    fn step(&mut self, shaft: Shaft, supply_v: f64, now: Ps, dt_s: f64) {
        self.watch(now);
        let max_nm = RATING.peak_nm;
        let goal_rps = match self.target {
            Target::None | Target::Mit(_) => None,
            Target::PositionSpeed { pos_rad, max_rps } => {
                let here_rad = shaft.pos_rad - self.parts.zero_rad;
                Some(speed_loop::towards(pos_rad, here_rad, max_rps))
            }
            Target::Speed { vel_rps } => Some(vel_rps),
        };
        if let Some(goal_rps) = goal_rps {
            self.parts
                .speed_loop
                .step(goal_rps, shaft.vel_rps, max_nm, dt_s);
        }
        let wanted_nm = self.enabled().then(|| self.commanded_nm(shaft));
        self.parts
            .actuator
            .step(wanted_nm, shaft.vel_rps, supply_v, dt_s);
    }

    fn commanded_nm(&self, shaft: Shaft) -> f64 {
        match self.target {
            Target::None => 0.0,
            Target::Mit(command) => {
                command.commanded_nm(shaft.pos_rad - self.parts.zero_rad, shaft.vel_rps)
            }
            Target::PositionSpeed { .. } | Target::Speed { .. } => {
                self.parts.speed_loop.commanded_nm()
            }
        }
    }
}

#[cfg(test)]
mod tests;
