//! One setting: the values it may have now, and the values that a boot may find.

use robot_plant::{
    time::{Ps, SECOND},
    world::CanBusId,
};

use super::{OVERTAKEN, Setting};

/// A request that was sent is answered within this time, including an erase, or never.
const ANSWERED: Ps = SECOND;

/// A write request that has no reply yet.
#[derive(Clone, Debug)]
struct PendingWrite {
    bus: CanBusId,
    /// Position among the frames sent on that bus.
    number: u64,
    bits: u32,
    /// Time at which the frame was sent.
    delivered: Option<Ps>,
}

/// The bit patterns that the value may have; `None` if it may have any.
type Possible = Option<Vec<u32>>;

/// Result of a reply to a read request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReadOutcome {
    /// The value is one of those that are possible.
    Consistent,
    /// The same, and it is the first reply since a boot: the value was restored from flash.
    Restored,
    /// The value is not the saved one, but the boot met worn flash.
    LostByWear,
    /// The value is not possible; these would have been.
    Wrong(Vec<u32>),
}

/// Knowledge about one setting from the frames on both buses.
#[derive(Clone, Debug)]
pub struct TrackedSetting {
    pub setting: Setting,
    /// Possible values in use, without those of pending writes.
    now: Possible,
    pending: Vec<PendingWrite>,
    /// Possible values in flash.
    flash: Possible,
    /// The values that worn flash should have held at the boot.
    missed: Possible,
    /// The first value in use since the contents of flash became unknown.
    first: Option<u32>,
    read_since_boot: bool,
    /// Time and bus of the last acknowledged write.
    acknowledged: Option<(Ps, CanBusId)>,
}

impl TrackedSetting {
    pub fn new(setting: Setting, in_flash: Option<u32>) -> Self {
        let flash: Possible = in_flash.map(|bits| vec![bits]);
        Self {
            setting,
            now: flash.clone(),
            pending: Vec::new(),
            flash,
            missed: None,
            first: None,
            read_since_boot: false,
            acknowledged: None,
        }
    }

    /// Notes that a write request was handed to the bus.
    pub fn requested(&mut self, bus: CanBusId, number: u64, bits: u32) {
        self.pending.push(PendingWrite {
            bus,
            number,
            bits,
            delivered: None,
        });
        // It may be accepted and saved although no reply arrives.
        add(&mut self.flash, bits);
    }

    /// Notes the number of frames sent on each bus.
    pub fn delivered(&mut self, delivered: [u64; 2], now: Ps) {
        for write in &mut self.pending {
            if write.number <= delivered[write.bus as usize] {
                write.delivered.get_or_insert(now);
            }
        }
        let is_over =
            |write: &mut PendingWrite| write.delivered.is_some_and(|at| at + ANSWERED < now);
        for write in self.pending.extract_if(.., is_over) {
            add(&mut self.now, write.bits);
        }
    }

    /// Notes an acknowledged write. Returns false if no write of this value was pending.
    pub fn acknowledged(&mut self, bus: CanBusId, bits: u32, at: Ps, disturbed: bool) -> bool {
        let mut pending = self.pending.iter();
        let Some(write) = pending.find(|write| write.bus == bus && write.bits == bits) else {
            return false;
        };
        let number = write.number;
        if disturbed || self.changed_elsewhere(bus, at) {
            add(&mut self.now, bits);
        } else {
            self.now = Some(vec![bits]);
            self.pending
                .retain(|write| write.bus != bus || write.number > number);
        }
        self.acknowledged = Some((at, bus));
        true
    }

    /// Whether a write was acknowledged on the other bus just before, so that the order of the two is unknown.
    pub fn changed_elsewhere(&self, bus: CanBusId, at: Ps) -> bool {
        self.acknowledged
            .is_some_and(|(then, there)| there != bus && at < then + OVERTAKEN)
    }

    /// Takes the reply `bits` to a read request.
    pub fn read(&mut self, bits: u32, at: Ps) -> ReadOutcome {
        let lately = |(then, _): (Ps, CanBusId)| at < then + OVERTAKEN;
        if self.acknowledged.is_some_and(lately) {
            return ReadOutcome::Consistent;
        }
        if let Some(right) = self.possible()
            && !right.contains(&bits)
        {
            return ReadOutcome::Wrong(right);
        }
        self.now = Some(vec![bits]);
        self.first.get_or_insert(bits);
        let missed = self.missed.take();
        if missed.is_some_and(|missed| !missed.contains(&bits)) {
            return ReadOutcome::LostByWear;
        }
        let known = self.flash.is_some();
        if std::mem::replace(&mut self.read_since_boot, true) || !known {
            ReadOutcome::Consistent
        } else {
            ReadOutcome::Restored
        }
    }

    /// Notes a boot of the image, with or without worn flash.
    pub fn booted(&mut self, worn: bool) {
        // If one of these was accepted, its value is among those that flash may hold.
        self.pending.retain(|write| write.delivered.is_none());
        let flash = if worn { None } else { self.flash.clone() };
        if worn && let Some(mut missed) = self.flash.take() {
            missed.extend(self.pending.iter().map(|write| write.bits));
            self.missed = Some(missed);
        }
        self.now = flash;
        self.first = None;
        self.read_since_boot = false;
    }

    /// Makes the contents of flash unknown until the setting is written again.
    pub fn forget_flash(&mut self) {
        self.flash = None;
        self.first = self.only();
    }

    /// Whether the value in use is known to differ from the first one.
    pub fn differs_from_boot(&self) -> bool {
        self.first.is_some() && self.only().is_some() && self.first != self.only()
    }

    /// The robot has reported that flash holds the value in use; `written`: its group was written since the boot.
    pub fn reported_saved(&mut self, written: bool) {
        if self.flash.is_some() || written {
            self.flash = self.possible();
        }
    }

    fn only(&self) -> Option<u32> {
        match self.now.as_deref() {
            Some([bits]) if self.pending.is_empty() => Some(*bits),
            _ => None,
        }
    }

    fn possible(&self) -> Possible {
        let mut all = self.now.clone()?;
        all.extend(self.pending.iter().map(|write| write.bits));
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

    fn changed(value: &mut TrackedSetting, number: u64, bits: u32) {
        value.requested(BUS, number, bits);
        value.delivered([number; 2], 0);
        assert!(value.acknowledged(BUS, bits, 0, false));
    }

    #[test]
    fn a_value_reported_as_saved_must_be_there_after_a_boot() {
        let mut value = TrackedSetting::new((1, 1), Some(1));
        changed(&mut value, 1, 2);
        let mut cut = value.clone();
        cut.booted(false);
        assert_eq!(cut.read(1, SECOND), ReadOutcome::Restored, "not saved yet");
        assert_eq!(
            cut.read(2, SECOND),
            ReadOutcome::Wrong(vec![1]),
            "it stays so"
        );
        value.reported_saved(false);
        value.booted(false);
        assert_eq!(value.read(1, SECOND), ReadOutcome::Wrong(vec![2]));
        assert_eq!(value.read(2, SECOND), ReadOutcome::Restored);
    }

    #[test]
    fn a_write_without_a_reply_may_have_been_accepted_or_not() {
        let mut value = TrackedSetting::new((1, 1), Some(1));
        value.requested(BUS, 1, 2);
        value.delivered([1, 0], 0);
        value.delivered([1, 0], 2 * SECOND);
        value.reported_saved(false);
        for found in [1, 2] {
            let mut booted = value.clone();
            booted.booted(false);
            assert_eq!(booted.read(found, SECOND), ReadOutcome::Restored);
        }
        assert_eq!(value.read(3, SECOND), ReadOutcome::Wrong(vec![1, 2]));
    }

    #[test]
    fn a_loss_by_wear_is_reported_once_and_flash_is_trusted_again_after_a_write() {
        let mut value = TrackedSetting::new((1, 1), Some(1));
        value.booted(true);
        assert_eq!(value.read(9, SECOND), ReadOutcome::LostByWear);
        value.reported_saved(value.differs_from_boot());
        value.booted(false);
        assert_eq!(
            value.read(1, SECOND),
            ReadOutcome::Consistent,
            "the old one is back"
        );
        changed(&mut value, 1, 2);
        value.reported_saved(value.differs_from_boot());
        value.booted(false);
        assert_eq!(value.read(1, SECOND), ReadOutcome::Wrong(vec![2]));
    }
}
