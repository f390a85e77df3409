//! Invariants that are checked at every instant, on the wires and in the firmware's diagnostics.

use robot_plant::{
    time::{MS, Ps, SECOND},
    world::{CanBusId, WireEvent},
};

use super::{
    STEP,
    flash_at_rest::{FlashAtRest, RobotState},
    missing_signal::MissingSignal,
    saved_settings::SettingsTally,
    settings_check::SettingsCheck,
    stop_deadlines::{self, Group, StopDeadline},
};
use crate::{
    machine::Machine,
    scenario::{Event, TimedEvent},
    simulation::Simulation,
};

/// Tolerance in time: the diagnostics are one sample old, and a command takes a millisecond to reach the wire.
const SLACK: Ps = 5 * MS;
/// Time from a failure of the image to the reset and the first frames of the next boot.
const AFTER_CHIP_FAULT: Ps = 300 * MS;
/// Time until a CAN controller that went bus-off takes part again.
const BUS_BACK: Ps = 2 * SECOND;
/// Time after a fault of the radio until its switches arrive without delay again.
const RADIO_BACK: Ps = SECOND;
/// Limits of an armed robot's commands: 8 A for a wheel; for a joint 5 N·m and what the leg may have moved since its
/// report, with the largest gains that a PC can ask for (1.1 mrad at a Kp of 500, and 0.17 rad/s at a Kd of 5).
const MOST_CURRENT_MA: f64 = 8_000.0;
const MOST_TORQUE_NM: f64 = 5.0 + 0.56 + 0.86;
/// Board errors that a fault explains: bit errors on the radio line.
const EXPLAINED: [&str; 1] = ["USART3"];

/// An invariant did not hold.
#[derive(Clone, Debug)]
pub struct Violation {
    pub at: Ps,
    pub what: String,
}

/// Totals of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Faults that were started.
    pub faults: u64,
    /// Tuning frames that were sent.
    pub frames: u64,
    pub armings: u64,
    pub resets: u64,
    /// Number of met deadlines for actuators without torque.
    pub stops: u64,
    pub settings: SettingsTally,
    pub flash_words: u64,
    pub flash_erases: u64,
    pub most_current_ma: f64,
    pub most_torque_nm: f64,
}

/// Actuators that must be without torque by a certain time.
#[derive(Clone, Debug)]
struct PendingStop {
    group: Group,
    due: Ps,
    cause: String,
}

/// A fault that is active or ended a short time ago.
#[derive(Clone, Debug)]
struct ActiveFault {
    name: String,
    ended: Option<Ps>,
}

/// Positions of the signals.
struct Places {
    currents: [usize; 2],
    enabled: [usize; 4],
    torques: [usize; 4],
    arming: usize,
}

/// The invariants, with the history that they need.
pub struct Invariants {
    places: Places,
    tally: Tally,
    faults: Vec<ActiveFault>,
    pending_stops: Vec<PendingStop>,
    chip_fault: Option<Ps>,
    /// The pilot's switches, and the time at which the enable switch last went on.
    e_stop: bool,
    enable: bool,
    enabled_at: Option<Ps>,
    armed: bool,
    last_armed: Option<Ps>,
    /// Times of torque on a wire for which the diagnostics have not yet shown that the robot was armed.
    unconfirmed: Vec<Ps>,
    missed: u64,
    board_errors_seen: usize,
    settings: SettingsCheck,
    flash: FlashAtRest,
    events: Vec<WireEvent>,
    world: Vec<f64>,
    diag: Vec<f64>,
}

impl Invariants {
    /// Finds the signals that the invariants need.
    pub fn new(machine: &mut Machine) -> Result<Self, MissingSignal> {
        let world = machine.world_names();
        let diag = Simulation::diag_names(machine);
        let place = |names: &[String], name: String| {
            let found = names.iter().position(|n| *n == name);
            found.ok_or(MissingSignal(name))
        };
        let joint = |n: usize, part: &str| place(&world, format!("can.joint.{n}.{part}"));
        let current = |n: usize| place(&world, format!("can.m3508.{n}.current_ma"));
        let of_all = |part: &str| {
            Ok::<_, MissingSignal>([
                joint(0, part)?,
                joint(1, part)?,
                joint(2, part)?,
                joint(3, part)?,
            ])
        };
        Ok(Self {
            places: Places {
                currents: [current(0)?, current(1)?],
                enabled: of_all("enabled")?,
                torques: of_all("torque_nm")?,
                arming: place(&diag, "diag.arming.state".to_owned())?,
            },
            tally: Tally::default(),
            faults: Vec::new(),
            pending_stops: Vec::new(),
            chip_fault: None,
            e_stop: false,
            enable: false,
            enabled_at: None,
            armed: false,
            last_armed: None,
            unconfirmed: Vec::new(),
            missed: 0,
            board_errors_seen: 0,
            settings: SettingsCheck::new(|name| place(&diag, name.to_owned()))?,
            flash: FlashAtRest::default(),
            events: Vec::new(),
            world: Vec::new(),
            diag: Vec::new(),
        })
    }

    pub fn tally(&self) -> Tally {
        Tally {
            settings: self.settings.tally(),
            ..self.tally
        }
    }

    /// Takes an event.
    pub fn record(&mut self, timed: &TimedEvent) {
        let at = timed.at;
        match &timed.event {
            Event::Remote(input) => self.pilot(at, input.enable, input.e_stop),
            Event::Pc(_) | Event::Push(_) => {}
            Event::Can(bus, frame) => {
                self.tally.frames += 1;
                self.settings.sent(*bus, frame);
            }
            Event::StartFault(name) => self.begin(at, name),
            Event::EndFault(name) => {
                self.settings.fault(name, false, at);
                if is_of_the_machine(name) {
                    self.chip_fault = Some(at);
                }
                self.pending_stops.retain(|stop| stop.cause != *name);
                let there = self.faults.iter_mut().filter(|t| t.name == *name);
                there.for_each(|fault| fault.ended = Some(at));
            }
        }
    }

    fn pilot(&mut self, at: Ps, enable: Option<bool>, e_stop: Option<bool>) {
        let enable = enable.unwrap_or(self.enable);
        let e_stop = e_stop.unwrap_or(self.e_stop);
        if enable && !self.enable {
            self.enabled_at = Some(at);
        }
        for (cause, on, was) in [
            ("e-stop", e_stop, self.e_stop),
            ("enable switch off", !enable, !self.enable),
        ] {
            if on && !was {
                self.expect_stop(at + stop_deadlines::AFTER_SWITCH, cause, Group::Wheels);
                self.expect_stop(at + stop_deadlines::AFTER_SWITCH, cause, Group::Joints);
            } else if !on {
                self.pending_stops.retain(|stop| stop.cause != cause);
            }
        }
        (self.enable, self.e_stop) = (enable, e_stop);
    }

    fn expect_stop(&mut self, due: Ps, cause: &str, group: Group) {
        self.pending_stops.push(PendingStop {
            group,
            due,
            cause: cause.to_owned(),
        });
    }

    fn begin(&mut self, at: Ps, name: &str) {
        self.tally.faults += 1;
        self.settings.fault(name, true, at);
        if is_of_the_machine(name) {
            self.chip_fault = Some(at);
            return;
        }
        self.faults.retain(|fault| fault.name != name);
        self.faults.push(ActiveFault {
            name: name.to_owned(),
            ended: None,
        });
        for StopDeadline { group, within } in stop_deadlines::after(name) {
            self.expect_stop(at + within, name, group);
        }
    }

    /// Checks all invariants. Returns the first one that does not hold.
    pub fn check(&mut self, machine: &mut Machine, now: Ps) -> Option<Violation> {
        self.faults
            .retain(|t| t.ended.is_none_or(|ended| ended + BUS_BACK > now));
        self.read_wire_events(machine);
        machine.sample_world(&mut self.world);
        let known = machine.sample_diag(&mut self.diag);
        let armed = known && self.diag[self.places.arming] == 1.0;
        let settings = self.check_settings(machine, known, now);
        let broken = settings
            .or_else(|| self.check_flash(machine, armed))
            .or_else(|| self.check_arming(armed, now))
            .or_else(|| self.check_no_torque_unarmed(now))
            .or_else(|| self.check_limits())
            .or_else(|| self.check_stops(now))
            .or_else(|| self.check_machine(machine, now));
        broken.map(|what| Violation { at: now, what })
    }

    fn read_wire_events(&mut self, machine: &mut Machine) {
        self.events.clear();
        machine.drain_wire_events(&mut self.events);
        for event in &self.events {
            let wheel = self.places.currents.contains(&event.signal);
            let joint = self.places.enabled.contains(&event.signal);
            let surely_armed = self.last_armed.is_some_and(|t| event.at <= t + SLACK);
            if (wheel || joint) && event.value != 0.0 && !surely_armed {
                self.unconfirmed.push(event.at);
            }
            if wheel {
                self.tally.most_current_ma = self.tally.most_current_ma.max(event.value.abs());
            }
        }
    }

    fn check_settings(&mut self, machine: &mut Machine, known: bool, now: Ps) -> Option<String> {
        let diag = known.then_some(self.diag.as_slice());
        let disturbed = |bus| {
            let group = match bus {
                CanBusId::Can1 => Group::Wheels,
                CanBusId::Can2 => Group::Joints,
            };
            let mut faults = self.faults.iter();
            faults.any(|fault| stop_deadlines::disturbs(&fault.name, group))
        };
        self.settings.check(machine, diag, disturbed, now)
    }

    fn check_flash(&mut self, machine: &Machine, armed: bool) -> Option<String> {
        let progress = machine.progress();
        self.tally.flash_words = progress.flash_programs;
        self.tally.flash_erases = progress.flash_erases;
        let radio = |fault: &ActiveFault| fault.name.starts_with("sbus");
        let received = self.enable && !self.faults.iter().any(radio);
        self.flash.check(
            machine,
            &RobotState {
                armed: armed && self.armed,
                last_armed: self.last_armed,
                // A boot is noticed up to one step late.
                booted: self.settings.booted().saturating_sub(STEP),
                enabled: self.enabled_at.filter(|_| received),
            },
        )
    }

    /// The robot arms only by a switch that went on after it was last armed.
    fn check_arming(&mut self, armed: bool, now: Ps) -> Option<String> {
        let rose = armed && !self.armed;
        let before = self.last_armed;
        self.armed = armed;
        if armed {
            self.last_armed = Some(now);
        }
        if !rose {
            return None;
        }
        self.tally.armings += 1;
        match (self.enabled_at, before) {
            (None, _) => Some("armed, and the enable switch was never on".into()),
            (Some(on), Some(before)) if on + SLACK < before => {
                Some("armed again without the enable switch going off and on".into())
            }
            _ => None,
        }
    }

    fn check_no_torque_unarmed(&mut self, now: Ps) -> Option<String> {
        let sure = now.saturating_sub(SLACK);
        if self.armed {
            self.unconfirmed.retain(|at| *at < sure);
        }
        let violating = self.unconfirmed.extract_if(.., |at| *at < sure).next()?;
        let at = violating as f64 / SECOND as f64;
        Some(format!("torque left the board unarmed at {at:.4} s"))
    }

    fn check_limits(&mut self) -> Option<String> {
        let torques = self
            .places
            .torques
            .iter()
            .map(|place| self.world[*place].abs());
        let torque = torques.fold(0.0, f64::max);
        self.tally.most_torque_nm = self.tally.most_torque_nm.max(torque);
        let current = self.tally.most_current_ma;
        if current > MOST_CURRENT_MA {
            return Some(format!("a wheel was asked for {current} mA"));
        }
        (torque > MOST_TORQUE_NM).then(|| format!("a joint was asked for {torque:.3} N·m"))
    }

    fn check_stops(&mut self, now: Ps) -> Option<String> {
        let due: Vec<PendingStop> = self
            .pending_stops
            .extract_if(.., |stop| stop.due <= now)
            .collect();
        for stop in due {
            if self.is_excused(&stop, now) {
                continue;
            }
            let (group, cause) = (stop.group, &stop.cause);
            let places = match group {
                Group::Wheels => &self.places.currents[..],
                Group::Joints => &self.places.enabled[..],
            };
            if places.iter().any(|place| self.world[*place] != 0.0) {
                return Some(format!("{group:?} still have torque after `{cause}`"));
            }
            self.tally.stops += 1;
        }
        None
    }

    /// Whether another fault hides the stop's cause from the firmware, or keeps its frames from the motors.
    fn is_excused(&self, stop: &PendingStop, now: Ps) -> bool {
        let by_pilot = stop_deadlines::after(&stop.cause).is_empty();
        let of_bus = stop_deadlines::disturbs(&stop.cause, stop.group);
        self.chip_fault
            .is_some_and(|at| now < at + AFTER_CHIP_FAULT)
            || self.faults.iter().any(|fault| {
                let name = fault.name.as_str();
                let recently = fault.ended.is_none_or(|ended| now < ended + RADIO_BACK);
                let other = name != stop.cause;
                other && stop_deadlines::disturbs(name, stop.group) && !of_bus
                    || other && stop_deadlines::hides(name, &stop.cause)
                    || by_pilot && recently && name.starts_with("sbus")
            })
    }

    fn check_machine(&mut self, machine: &mut Machine, now: Ps) -> Option<String> {
        let struck = self
            .chip_fault
            .is_some_and(|at| now < at + AFTER_CHIP_FAULT);
        let resets = machine.resets() as u64;
        if resets > self.tally.resets {
            self.tally.resets = resets;
            if !struck {
                return Some("the chip was reset, and nothing had failed".into());
            }
        }
        let progress = machine.progress();
        let missed = std::mem::replace(&mut self.missed, progress.missed);
        if progress.missed > missed && self.armed && !struck {
            return Some("a control tick was missed while armed".into());
        }
        if progress.board_errors == self.board_errors_seen {
            return None;
        }
        let errors = Machine::board_errors(machine);
        let new = errors
            .into_iter()
            .skip(self.board_errors_seen)
            .map(|e| e.message);
        self.board_errors_seen = progress.board_errors;
        new.into_iter()
            .find(|message| !EXPLAINED.iter().any(|part| message.contains(part)))
            .map(|message| format!("board error: {message}"))
    }
}

fn is_of_the_machine(name: &str) -> bool {
    crate::machine::faults::all().any(|fault| fault.name == name)
}
