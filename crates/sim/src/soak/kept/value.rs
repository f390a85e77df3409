//! One setting: what it may be now, and what a boot may find.

use robot_plant::{
    time::{Ps, SECOND},
    world::CanBusId,
};

use super::{OVERTAKEN, Setting};

/// A request that went out is answered by then, or never: an erase may come in between.
const ANSWERED: Ps = SECOND;

/// A change that was asked for and is not answered yet.
#[derive(Clone, Debug)]
struct Open {
    bus: CanBusId,
    /// Of the frames on that bus.
    number: u64,
    bits: u32,
    delivered: Option<Ps>,
}

/// Bits that are possible; `None` if any are.
type Possible = Option<Vec<u32>>;

/// What a reply with the value shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Heard {
    Nothing,
    /// The first since the boot, and right.
    AfterBoot,
    /// Not what was saved, but the boot met worn flash.
    Lost,
    /// Only those would have been right.
    Wrong(Vec<u32>),
}

#[derive(Clone, Debug)]
pub struct Value {
    pub setting: Setting,
    /// But for open requests.
    now: Possible,
    open: Vec<Open>,
    flash: Possible,
    /// What worn flash should have held at the boot.
    missed: Possible,
    /// As the robot had it first since flash is in doubt.
    first: Option<u32>,
    read_since_boot: bool,
    acknowledged: Option<(Ps, CanBusId)>,
}

impl Value {
    pub fn new(setting: Setting, in_flash: Option<u32>) -> Self {
        let flash: Possible = in_flash.map(|bits| vec![bits]);
        Self {
            setting,
            now: flash.clone(),
            open: Vec::new(),
            flash,
            missed: None,
            first: None,
            read_since_boot: false,
            acknowledged: None,
        }
    }

    pub fn asked(&mut self, bus: CanBusId, number: u64, bits: u32) {
        self.open.push(Open {
            bus,
            number,
            bits,
            delivered: None,
        });
        // It may be taken and saved, and nobody hears of it.
        add(&mut self.flash, bits);
    }

    pub fn delivered(&mut self, delivered: [u64; 2], now: Ps) {
        for open in &mut self.open {
            if open.number <= delivered[open.bus as usize] {
                open.delivered.get_or_insert(now);
            }
        }
        let is_over = |open: &mut Open| open.delivered.is_some_and(|at| at + ANSWERED < now);
        for open in self.open.extract_if(.., is_over) {
            add(&mut self.now, open.bits);
        }
    }

    /// True if that was an answer to an open request.
    pub fn acknowledged(&mut self, bus: CanBusId, bits: u32, at: Ps, troubled: bool) -> bool {
        let mut open = self.open.iter();
        let Some(asked) = open.find(|open| open.bus == bus && open.bits == bits) else {
            return false;
        };
        let number = asked.number;
        if troubled || self.changed_elsewhere(bus, at) {
            add(&mut self.now, bits);
        } else {
            self.now = Some(vec![bits]);
            self.open
                .retain(|open| open.bus != bus || open.number > number);
        }
        self.acknowledged = Some((at, bus));
        true
    }

    /// A moment ago, on the other bus: nobody knows in which order.
    pub fn changed_elsewhere(&self, bus: CanBusId, at: Ps) -> bool {
        self.acknowledged
            .is_some_and(|(then, there)| there != bus && at < then + OVERTAKEN)
    }

    pub fn read(&mut self, bits: u32, at: Ps) -> Heard {
        let lately = |(then, _): (Ps, CanBusId)| at < then + OVERTAKEN;
        if self.acknowledged.is_some_and(lately) {
            return Heard::Nothing;
        }
        if let Some(right) = self.possible()
            && !right.contains(&bits)
        {
            return Heard::Wrong(right);
        }
        self.now = Some(vec![bits]);
        self.first.get_or_insert(bits);
        let missed = self.missed.take();
        if missed.is_some_and(|missed| !missed.contains(&bits)) {
            return Heard::Lost;
        }
        let known = self.flash.is_some();
        if std::mem::replace(&mut self.read_since_boot, true) || !known {
            Heard::Nothing
        } else {
            Heard::AfterBoot
        }
    }

    pub fn booted(&mut self, worn: bool) {
        // What was taken of these is among what flash may hold.
        self.open.retain(|open| open.delivered.is_none());
        let flash = if worn { None } else { self.flash.clone() };
        if worn && let Some(mut missed) = self.flash.take() {
            missed.extend(self.open.iter().map(|open| open.bits));
            self.missed = Some(missed);
        }
        self.now = flash;
        self.first = None;
        self.read_since_boot = false;
    }

    /// Nobody knows what flash holds until it is written.
    pub fn doubt(&mut self) {
        self.flash = None;
        self.first = self.only();
    }

    pub fn differs_from_boot(&self) -> bool {
        self.first.is_some() && self.only().is_some() && self.first != self.only()
    }

    pub fn called_saved(&mut self, written: bool) {
        if self.flash.is_some() || written {
            self.flash = self.possible();
        }
    }

    fn only(&self) -> Option<u32> {
        match self.now.as_deref() {
            Some([bits]) if self.open.is_empty() => Some(*bits),
            _ => None,
        }
    }

    fn possible(&self) -> Possible {
        let mut all = self.now.clone()?;
        all.extend(self.open.iter().map(|open| open.bits));
        Some(all)
    }
}

fn add(possible: &mut Possible, bits: u32) {
    if let Some(all) = possible
        && !all.contains(&bits)
    {
        all.push(bits);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUS: CanBusId = CanBusId::Can1;

    fn changed(value: &mut Value, number: u64, bits: u32) {
        value.asked(BUS, number, bits);
        value.delivered([number; 2], 0);
        assert!(value.acknowledged(BUS, bits, 0, false));
    }

    #[test]
    fn what_was_called_saved_must_be_there_after_a_boot() {
        let mut value = Value::new((1, 1), Some(1));
        changed(&mut value, 1, 2);
        let mut cut = value.clone();
        cut.booted(false);
        assert_eq!(cut.read(1, SECOND), Heard::AfterBoot, "not saved yet");
        assert_eq!(cut.read(2, SECOND), Heard::Wrong(vec![1]), "it stays so");
        value.called_saved(false);
        value.booted(false);
        assert_eq!(value.read(1, SECOND), Heard::Wrong(vec![2]));
        assert_eq!(value.read(2, SECOND), Heard::AfterBoot);
    }

    #[test]
    fn a_change_without_an_answer_may_have_happened_or_not() {
        let mut value = Value::new((1, 1), Some(1));
        value.asked(BUS, 1, 2);
        value.delivered([1, 0], 0);
        value.delivered([1, 0], 2 * SECOND);
        value.called_saved(false);
        for found in [1, 2] {
            let mut booted = value.clone();
            booted.booted(false);
            assert_eq!(booted.read(found, SECOND), Heard::AfterBoot);
        }
        assert_eq!(value.read(3, SECOND), Heard::Wrong(vec![1, 2]));
    }

    #[test]
    fn what_worn_flash_loses_is_a_loss_once_and_trusted_again_when_written() {
        let mut value = Value::new((1, 1), Some(1));
        value.booted(true);
        assert_eq!(value.read(9, SECOND), Heard::Lost);
        value.called_saved(value.differs_from_boot());
        value.booted(false);
        assert_eq!(value.read(1, SECOND), Heard::Nothing, "the old one is back");
        changed(&mut value, 1, 2);
        value.called_saved(value.differs_from_boot());
        value.booted(false);
        assert_eq!(value.read(1, SECOND), Heard::Wrong(vec![2]));
    }
}
