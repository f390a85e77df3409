//! RobStride RS00 set to its MIT protocol (docs/hardware.md#rs00).

mod receive;

use super::{
    actuator::Rating,
    drive::{Drive, DriveFaults, DriveParts, Reception, Shaft},
    mit_frame::{MitCommand, Ranges},
    speed_loop,
};
use crate::{time::Ps, wire::CanFrame};

const RANGES: Ranges = Ranges {
    pos_rad: 12.57,
    vel_rps: 33.0,
    torque_nm: 14.0,
};

/// Peak 14 N·m, 315 rpm without load at 48 V. Assumed: at 24 V the peak is just reached at standstill, which makes the
/// slope; friction as of the DM4310; the rated 5 N·m for ever end at 90 °C.
const RATING: Rating = Rating {
    peak_nm: 14.0,
    no_load_rps: 315.0 * std::f64::consts::TAU / 60.0,
    supply_v: 48.0,
    slope_rps_per_nm: 1.19,
    friction_nm: 0.15,
    kelvin_per_watt: 2.0,
    heat_capacity_j_per_k: 180.0,
};
const TORQUE_NM_PER_A: f64 = 1.48;

/// Bits of the fault word.
const OVER_TEMPERATURE: u32 = 1 << 0;
const DRIVER: u32 = 1 << 1;
const OVER_TEMPERATURE_C: f64 = 145.0;

/// Identifiers of the fault `motor-N-wrong-id` are this much too high.
const WRONG_ID: u32 = 8;

/// Discriminants are the codes on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Mit = 0,
    Position = 1,
    Speed = 2,
}

/// The command that a running motor follows; `None` until the first one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    None,
    Mit(MitCommand),
    Position { pos_rad: f64, max_rps: f64 },
    Speed { vel_rps: f64, max_a: f64 },
}

/// A motor as shipped holds its last command indefinitely: its CAN time-out, parameter 0x7028, is off, and the MIT protocol
/// cannot set it.
#[derive(Clone)]
pub(crate) struct Rs00 {
    parts: DriveParts,
    /// Time without frames after which it returns to reset mode; 0 is never.
    can_timeout: Ps,
    motor_id: u32,
    host_id: u32,
    mode: Mode,
    running: bool,
    fault_word: u32,
    target: Target,
}

impl Rs00 {
    /// `can_timeout` is the value that was set in the private protocol.
    pub(crate) fn new(motor_id: u32, host_id: u32, can_timeout: Ps) -> Self {
        Self {
            parts: DriveParts::new(&RATING),
            can_timeout,
            motor_id,
            host_id,
            mode: Mode::Mit,
            running: false,
            fault_word: 0,
            target: Target::None,
        }
    }

    fn switch_off(&mut self) {
        self.running = false;
        self.target = Target::None;
        self.parts.cut();
    }

    fn trip(&mut self, fault: u32) {
        self.fault_word |= fault;
        self.switch_off();
    }

    fn id(&self) -> u32 {
        self.motor_id + u32::from(self.parts.faults.wrong_id) * WRONG_ID
    }
}

impl Drive for Rs00 {
    fn boxed(&self) -> Box<dyn Drive> {
        Box::new(self.clone())
    }

    fn parts(&self) -> &DriveParts {
        &self.parts
    }

    fn parts_mut(&mut self) -> &mut DriveParts {
        &mut self.parts
    }

    fn set_faults(&mut self, faults: DriveFaults, _now: Ps) {
        if faults.gone || faults.wrong_id != self.parts.faults.wrong_id {
            self.mode = Mode::Mit;
            self.fault_word = 0;
            self.parts.replies.drop_waiting();
            self.switch_off();
        }
        if faults.tripped {
            self.trip(DRIVER);
        }
        self.parts.actuator.heated = faults.hot;
        self.parts.faults = faults;
    }

    fn receive(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Reception {
        self.take_frame(frame, shaft, now)
    }

    fn enabled(&self) -> bool {
        self.running
    }

    fn step(&mut self, shaft: Shaft, supply_v: f64, now: Ps, dt_s: f64) {
        // Assumed: it raises no fault, and may be enabled again at once.
        if self.running
            && self.can_timeout != 0
            && now > self.parts.last_frame_at + self.can_timeout
        {
            self.switch_off();
        }
        if self.running && self.parts.actuator.winding_c() > OVER_TEMPERATURE_C {
            self.trip(OVER_TEMPERATURE);
        }
        let goal = match self.target {
            Target::None | Target::Mit(_) => None,
            Target::Position { pos_rad, max_rps } => {
                let here_rad = shaft.pos_rad - self.parts.zero_rad;
                let goal_rps = speed_loop::towards(pos_rad, here_rad, max_rps);
                Some((goal_rps, RATING.peak_nm))
            }
            Target::Speed { vel_rps, max_a } => {
                let max_nm = (max_a.abs() * TORQUE_NM_PER_A).min(RATING.peak_nm);
                Some((vel_rps, max_nm))
            }
        };
        if let Some((goal_rps, max_nm)) = goal {
            self.parts
                .speed_loop
                .step(goal_rps, shaft.vel_rps, max_nm, dt_s);
        }
        let wanted_nm = self.running.then(|| self.commanded_nm(shaft));
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
            Target::Position { .. } | Target::Speed { .. } => self.parts.speed_loop.commanded_nm(),
        }
    }
}

#[cfg(test)]
mod tests;
