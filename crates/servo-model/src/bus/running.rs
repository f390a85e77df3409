//! Faults from their start to their end.

use super::{Bus, FaultId};
use crate::fault::Fault;

/// Temperature around servos without a fault, °C.
const ROOM_C: f64 = 25.0;

/// A fault that was scheduled.
#[derive(Clone, Copy, Debug)]
pub struct Running {
    pub id: FaultId,
    pub fault: Fault,
    pub from_ns: u64,
    pub to_ns: u64,
    pub is_active: bool,
}

/// What becomes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    Whole,
    Lost,
    /// The byte at a place is changed; the count goes down to it.
    Changed {
        bytes_left: usize,
    },
}

impl Running {
    pub fn new(id: FaultId, fault: Fault, from_ns: u64, to_ns: u64) -> Self {
        Self {
            id,
            fault,
            from_ns,
            to_ns,
            is_active: false,
        }
    }

    /// When it changes next, ns.
    pub fn edge_ns(&self) -> u64 {
        if self.is_active {
            self.to_ns
        } else {
            self.from_ns
        }
    }
}

impl Bus {
    /// When a fault starts or ends next, ns.
    pub(super) fn next_fault_ns(&self) -> Option<u64> {
        self.faults.iter().map(Running::edge_ns).min()
    }

    /// Starts and ends the faults whose time has come.
    pub(super) fn change_faults(&mut self, now_ns: u64) {
        for place in 0..self.faults.len() {
            let mut running = self.faults[place];
            let begins = !running.is_active && running.from_ns <= now_ns;
            running.is_active |= begins;
            self.faults[place] = running;
            if begins {
                self.begin(running.fault);
            }
        }
        let mut over = Vec::new();
        self.faults.retain(|running| {
            let stays = running.to_ns > now_ns;
            if !stays {
                over.push(running.fault);
            }
            stays
        });
        over.into_iter().for_each(|fault| self.finish(fault));
        self.apply(now_ns);
    }

    fn begin(&mut self, fault: Fault) {
        match fault {
            Fault::DuplicateId { servo, id } => {
                if let Some(unit) = self.units.get_mut(servo) {
                    unit.own_id.get_or_insert(unit.servo.id());
                    unit.servo.set_id(id);
                }
            }
            Fault::Hot { servo, celsius } => {
                if let Some(unit) = self.units.get_mut(servo) {
                    unit.servo.set_temperature_c(celsius);
                }
            }
            _ => {}
        }
    }

    fn finish(&mut self, fault: Fault) {
        if let Fault::DuplicateId { servo, .. } = fault
            && let Some(unit) = self.units.get_mut(servo)
            && let Some(id) = unit.own_id.take()
        {
            unit.servo.set_id(id);
        }
    }

    /// Brings the state of everything in line with the faults in force.
    fn apply(&mut self, now_ns: u64) {
        let active: Vec<Fault> = self.faults().map(|(_, fault)| fault).collect();
        self.host.ear.hears_itself = active.contains(&Fault::Echo);
        for (place, unit) in self.units.iter_mut().enumerate() {
            unit.servo.advance(now_ns);
            let mut volts = unit.rated_v;
            let mut ambient_c = ROOM_C;
            let mut has_power = true;
            let mut load = unit.servo.load();
            load.is_blocked = false;
            unit.wrong_id = None;
            for fault in &active {
                match *fault {
                    Fault::Gone { servo } => has_power &= servo != place,
                    Fault::BrownOut => has_power = false,
                    Fault::Supply { volts: other } => volts = other,
                    Fault::Blocked { servo } => load.is_blocked |= servo == place,
                    Fault::Hot { servo, celsius } if servo == place => ambient_c = celsius,
                    Fault::WrongId { servo, id } if servo == place => unit.wrong_id = Some(id),
                    _ => {}
                }
            }
            unit.set_power(has_power, now_ns);
            unit.servo.set_supply_v(if has_power { volts } else { 0.0 });
            unit.servo.set_ambient_c(ambient_c);
            unit.servo.set_load(load);
        }
    }

    /// The sum of the probabilities of faults of one kind that are in force.
    pub(super) fn probability(&self, of: impl Fn(&Fault) -> Option<f64>) -> f64 {
        self.faults().filter_map(|(_, fault)| of(&fault)).sum()
    }

    /// Decides what becomes of a frame of so many bytes.
    pub(super) fn draw_fate(&mut self, bytes: usize) -> Fate {
        let lost = self.probability(|fault| match fault {
            Fault::DropPacket { probability } => Some(*probability),
            _ => None,
        });
        let changed = self.probability(|fault| match fault {
            Fault::CorruptPacket { probability } => Some(*probability),
            _ => None,
        });
        if self.happens(lost) {
            self.injected.dropped_packets += 1;
            Fate::Lost
        } else if self.happens(changed) {
            self.injected.corrupted_packets += 1;
            Fate::Changed {
                bytes_left: self.below(bytes),
            }
        } else {
            Fate::Whole
        }
    }
}

impl Fate {
    /// What becomes of the frame's next byte. `None` if it vanishes; true if it is changed.
    pub fn next(&mut self) -> Option<bool> {
        match self {
            Self::Whole => Some(false),
            Self::Lost => None,
            Self::Changed { bytes_left: 0 } => {
                *self = Self::Whole;
                Some(true)
            }
            Self::Changed { bytes_left } => {
                *bytes_left -= 1;
                Some(false)
            }
        }
    }
}
