//! The rules that must hold at every instant, checked on the wires and by the firmware's own account.

use robot_plant::{
    time::{MS, Ps, SECOND},
    world::{CanBusId, WireEvent},
};

use super::{
    STEP,
    duty::{self, Duty, Group},
    kept::KeptTally,
    settings::Settings,
    still_flash::{Rest, StillFlash},
};
use crate::{
    machine::Machine,
    scenario::{Action, Deed},
    simulation::Simulation,
};

/// The firmware's word is a sample old, and a command is on its way for a millisecond.
const SLACK: Ps = 5 * MS;
/// From a failure of the image to the reset and the first frames of the next boot.
const AFTER_CHIP_FAULT: Ps = 300 * MS;
/// A controller that went off its bus comes back so late.
const BUS_BACK: Ps = 2 * SECOND;
/// What the radio says is late while frames are lost, and so long after.
const RADIO_BACK: Ps = SECOND;
/// An armed robot asks for no more: 8 A on a wheel; 3 N·m on a joint, and what a leg may have moved since its report.
const MOST_CURRENT_MA: f64 = 8_000.0;
const MOST_TORQUE_NM: f64 = 3.3;
/// Chip complaints that a fault explains: bit errors on the radio line.
const EXPLAINED: [&str; 1] = ["USART3"];

/// A rule broken.
#[derive(Clone, Debug)]
pub struct Violation {
    pub at: Ps,
    pub what: String,
}

/// Numbers of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    pub faults: u64,
    pub frames: u64,
    pub armings: u64,
    pub resets: u64,
    /// Times that something had to be without torque, and was.
    pub stops: u64,
    pub settings: KeptTally,
    pub flash_words: u64,
    pub flash_erases: u64,
    pub most_current_ma: f64,
    pub most_torque_nm: f64,
}

/// Something to be without torque at a certain time.
#[derive(Clone, Debug)]
struct Debt {
    group: Group,
    due: Ps,
    cause: String,
}

/// A fault that is there, or was a short time ago.
#[derive(Clone, Debug)]
struct Trouble {
    name: String,
    ended: Option<Ps>,
}

struct Places {
    currents: [usize; 2],
    enabled: [usize; 4],
    torques: [usize; 4],
    arming: usize,
}

pub struct Watch {
    places: Places,
    tally: Tally,
    troubles: Vec<Trouble>,
    debts: Vec<Debt>,
    chip_fault: Option<Ps>,
    /// The pilot's switches, and when enable went on last.
    e_stop: bool,
    enable: bool,
    enabled_at: Option<Ps>,
    armed: bool,
    last_armed: Option<Ps>,
    /// Torque on a wire that is not yet known to be an armed robot's.
    suspects: Vec<Ps>,
    missed: u64,
    complaints: usize,
    settings: Settings,
    flash: StillFlash,
    events: Vec<WireEvent>,
    world: Vec<f64>,
    diag: Vec<f64>,
}

impl Watch {
    /// `Err` names what the image or the world does not show.
    pub fn new(machine: &mut Machine) -> Result<Self, String> {
        let world = machine.world_names();
        let diag = Simulation::diag_names(machine);
        let place = |names: &[String], name: String| {
            let found = names.iter().position(|n| *n == name);
            found.ok_or(name)
        };
        let joint = |n: usize, part: &str| place(&world, format!("can.joint.{n}.{part}"));
        let current = |n: usize| place(&world, format!("can.m3508.{n}.current_ma"));
        let of_all = |part: &str| {
            Ok::<_, String>([
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
            troubles: Vec::new(),
            debts: Vec::new(),
            chip_fault: None,
            e_stop: false,
            enable: false,
            enabled_at: None,
            armed: false,
            last_armed: None,
            suspects: Vec::new(),
            missed: 0,
            complaints: 0,
            settings: Settings::new(|name| place(&diag, name.to_owned()))?,
            flash: StillFlash::default(),
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

    /// Takes note of what was done to the robot.
    pub fn did(&mut self, action: &Action) {
        let at = action.at;
        match &action.what {
            Deed::Remote(input) => self.pilot(at, input.enable, input.e_stop),
            Deed::Can(bus, frame) => {
                self.tally.frames += 1;
                self.settings.sent(*bus, frame);
            }
            Deed::StartFault(name) => self.begin(at, name),
            Deed::EndFault(name) => {
                self.settings.fault(name, false, at);
                if is_of_the_machine(name) {
                    self.chip_fault = Some(at);
                }
                self.debts.retain(|debt| debt.cause != *name);
                let there = self.troubles.iter_mut().filter(|t| t.name == *name);
                there.for_each(|trouble| trouble.ended = Some(at));
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
                self.owe(at + duty::SWITCH, cause, Group::Wheels);
                self.owe(at + duty::SWITCH, cause, Group::Joints);
            } else if !on {
                self.debts.retain(|debt| debt.cause != cause);
            }
        }
        (self.enable, self.e_stop) = (enable, e_stop);
    }

    fn owe(&mut self, due: Ps, cause: &str, group: Group) {
        self.debts.push(Debt {
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
        self.troubles.retain(|trouble| trouble.name != name);
        self.troubles.push(Trouble {
            name: name.to_owned(),
            ended: None,
        });
        for Duty { group, within } in duty::of(name) {
            self.owe(at + within, name, group);
        }
    }

    /// Looks at everything; the first rule that does not hold.
    pub fn look(&mut self, machine: &mut Machine, now: Ps) -> Option<Violation> {
        self.troubles
            .retain(|t| t.ended.is_none_or(|ended| ended + BUS_BACK > now));
        self.hear(machine);
        machine.sample_world(&mut self.world);
        let known = machine.sample_diag(&mut self.diag);
        let armed = known && self.diag[self.places.arming] == 1.0;
        let settings = self.settings_rule(machine, known, now);
        let broken = settings
            .or_else(|| self.flash_rule(machine, armed))
            .or_else(|| self.arming_rule(armed, now))
            .or_else(|| self.unarmed_rule(now))
            .or_else(|| self.limit_rule())
            .or_else(|| self.stop_rule(now))
            .or_else(|| self.machine_rule(machine, now));
        broken.map(|what| Violation { at: now, what })
    }

    fn hear(&mut self, machine: &mut Machine) {
        self.events.clear();
        machine.drain_wire_events(&mut self.events);
        for event in &self.events {
            let wheel = self.places.currents.contains(&event.signal);
            let joint = self.places.enabled.contains(&event.signal);
            let surely_armed = self.last_armed.is_some_and(|t| event.at <= t + SLACK);
            if (wheel || joint) && event.value != 0.0 && !surely_armed {
                self.suspects.push(event.at);
            }
            if wheel {
                self.tally.most_current_ma = self.tally.most_current_ma.max(event.value.abs());
            }
        }
    }

    fn settings_rule(&mut self, machine: &mut Machine, known: bool, now: Ps) -> Option<String> {
        let diag = known.then_some(self.diag.as_slice());
        let troubled = |bus| {
            let group = match bus {
                CanBusId::Can1 => Group::Wheels,
                CanBusId::Can2 => Group::Joints,
            };
            let mut troubles = self.troubles.iter();
            troubles.any(|trouble| duty::disturbs(&trouble.name, group))
        };
        self.settings.look(machine, diag, troubled, now)
    }

    fn flash_rule(&mut self, machine: &Machine, armed: bool) -> Option<String> {
        let progress = machine.progress();
        self.tally.flash_words = progress.flash_programs;
        self.tally.flash_erases = progress.flash_erases;
        let radio = |trouble: &Trouble| trouble.name.starts_with("sbus");
        let heard = self.enable && !self.troubles.iter().any(radio);
        self.flash.look(
            machine,
            &Rest {
                armed: armed && self.armed,
                last_armed: self.last_armed,
                // Looked at every millisecond, it is known so late.
                booted: self.settings.booted().saturating_sub(STEP),
                enabled: self.enabled_at.filter(|_| heard),
            },
        )
    }

    /// Armed only by a switch that went on after the robot was last armed.
    fn arming_rule(&mut self, armed: bool, now: Ps) -> Option<String> {
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

    fn unarmed_rule(&mut self, now: Ps) -> Option<String> {
        let sure = now.saturating_sub(SLACK);
        if self.armed {
            self.suspects.retain(|at| *at < sure);
        }
        let guilty = self.suspects.extract_if(.., |at| *at < sure).next()?;
        let at = guilty as f64 / SECOND as f64;
        Some(format!("torque left the board unarmed at {at:.4} s"))
    }

    fn limit_rule(&mut self) -> Option<String> {
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

    fn stop_rule(&mut self, now: Ps) -> Option<String> {
        let due: Vec<Debt> = self.debts.extract_if(.., |debt| debt.due <= now).collect();
        for debt in due {
            if self.is_excused(&debt, now) {
                continue;
            }
            let (group, cause) = (debt.group, &debt.cause);
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

    /// Another fault keeps the stop's cause from the firmware, or its frames from the motors.
    fn is_excused(&self, debt: &Debt, now: Ps) -> bool {
        let by_pilot = duty::of(&debt.cause).is_empty();
        let of_bus = duty::disturbs(&debt.cause, debt.group);
        self.chip_fault
            .is_some_and(|at| now < at + AFTER_CHIP_FAULT)
            || self.troubles.iter().any(|trouble| {
                let name = trouble.name.as_str();
                let recently = trouble.ended.is_none_or(|ended| now < ended + RADIO_BACK);
                let other = name != debt.cause;
                other && duty::disturbs(name, debt.group) && !of_bus
                    || other && duty::hides(name, &debt.cause)
                    || by_pilot && recently && name.starts_with("sbus")
            })
    }

    fn machine_rule(&mut self, machine: &mut Machine, now: Ps) -> Option<String> {
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
        if progress.board_errors == self.complaints {
            return None;
        }
        let errors = Machine::board_errors(machine);
        let new = errors.into_iter().skip(self.complaints).map(|e| e.message);
        self.complaints = progress.board_errors;
        new.into_iter()
            .find(|message| !EXPLAINED.iter().any(|part| message.contains(part)))
            .map(|message| format!("the board complains: {message}"))
    }
}

fn is_of_the_machine(name: &str) -> bool {
    crate::machine::faults::all().any(|fault| fault.name == name)
}
