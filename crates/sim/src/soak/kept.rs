//! What the robot acknowledged and called saved is there after every later boot, by its own replies on CAN.

mod value;

use robot_plant::{
    time::{MS, Ps},
    wire::CanFrame,
    world::CanBusId,
};

use super::harmless::{self, READ_SETTING, Setting, WRITE_SETTING};
use value::{Heard, Value};

/// Replies on the two buses overtake each other by that at most.
const OVERTAKEN: Ps = 20 * MS;
/// The firmware's account is older only if a task no longer runs; by then the watchdog has struck.
const FRESH: Ps = 100 * MS;

/// A frame that the PC heard, or sent.
#[derive(Clone, Copy, Debug)]
pub struct Letter<'a> {
    pub at: Ps,
    pub bus: CanBusId,
    pub frame: &'a CanFrame,
    /// Something disturbs the bus: replies may be late.
    pub troubled: bool,
}

/// The firmware's account of its store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Account {
    pub all_saved: bool,
    pub generation: u32,
    /// Sectors, places or groups that the boot could not use.
    pub told_loss: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeptTally {
    pub changes: u64,
    /// Values read after a boot that were those called saved.
    pub found_again: u64,
    /// Values that worn flash took, and the robot said so.
    pub lost_and_told: u64,
}

#[derive(Debug)]
pub struct Kept {
    values: Vec<Value>,
    /// Frames sent on each bus.
    sent: [u64; 2],
    changed: Ps,
    booted: Ps,
    account: Option<Account>,
    tally: KeptTally,
}

impl Kept {
    /// With the sectors of [`full_sectors`](super::full_sectors).
    pub fn new() -> Self {
        let settings = harmless::RANGES.iter();
        let values = settings.map(|(setting, ..)| Value::new(*setting, harmless::start(*setting)));
        Self {
            values: values.collect(),
            sent: [0; 2],
            changed: 0,
            booted: 0,
            account: None,
            tally: KeptTally::default(),
        }
    }

    pub fn tally(&self) -> KeptTally {
        self.tally
    }

    /// The PC's frame waits for its bus.
    pub fn sent(&mut self, bus: CanBusId, frame: &CanFrame) {
        let sent = &mut self.sent[bus as usize];
        *sent += 1;
        let number = *sent;
        if let Some((setting, bits)) = harmless::as_change(frame) {
            let changed = self.values.iter_mut().find(|v| v.setting == setting);
            changed.into_iter().for_each(|v| v.asked(bus, number, bits));
        }
    }

    /// So many frames went out on each bus.
    pub fn delivered(&mut self, delivered: [u64; 2], now: Ps) {
        self.values
            .iter_mut()
            .for_each(|v| v.delivered(delivered, now));
    }

    /// The rule broken, if the frame shows that.
    pub fn heard(&mut self, letter: &Letter) -> Option<String> {
        let Letter {
            at,
            bus,
            frame,
            troubled,
        } = *letter;
        if let Some((setting, bits)) = harmless::as_value(frame, WRITE_SETTING) {
            if self.of(setting)?.acknowledged(bus, bits, at, troubled) {
                self.tally.changes += 1;
                self.changed = at;
            }
        } else if troubled {
        } else if let Some((setting, bits)) = harmless::as_value(frame, READ_SETTING) {
            return self.read(setting, bits, at);
        } else if harmless::as_unsaved(frame) == Some(0) {
            self.called_saved(|value| !value.changed_elsewhere(bus, at));
        }
        None
    }

    fn read(&mut self, setting: Setting, bits: u32, at: Ps) -> Option<String> {
        let told_loss = self.account.is_some_and(|account| account.told_loss);
        match self.of(setting)?.read(bits, at) {
            Heard::Nothing => None,
            Heard::AfterBoot => {
                self.tally.found_again += 1;
                None
            }
            Heard::Lost if told_loss => {
                self.tally.lost_and_told += 1;
                None
            }
            Heard::Lost => Some(format!(
                "setting {setting:?} is {} after a boot with worn flash, and the robot does not say so",
                f32::from_bits(bits)
            )),
            Heard::Wrong(right) => Some(format!(
                "setting {setting:?} is {}, and can only be {:?}",
                f32::from_bits(bits),
                right.into_iter().map(f32::from_bits).collect::<Vec<_>>()
            )),
        }
    }

    /// The image began anew; with `worn` cells it may not find what was saved.
    pub fn booted(&mut self, worn: bool, now: Ps) {
        self.booted = now;
        self.account = None;
        self.values.iter_mut().for_each(|v| v.booted(worn));
    }

    /// The firmware's account, read in its memory.
    pub fn account(&mut self, account: Account, worn: bool, now: Ps) {
        let before = self.account.replace(account);
        if worn && before.is_some_and(|before| before.generation != account.generation) {
            // What could not be read was not copied.
            self.values.iter_mut().for_each(Value::doubt);
        }
        if account.all_saved && now > self.changed + FRESH && now > self.booted + FRESH {
            self.called_saved(|_| true);
        }
    }

    /// The robot says that flash holds what is in use.
    fn called_saved(&mut self, applies: impl Fn(&Value) -> bool) {
        for n in 0..self.values.len() {
            let group = self.values[n].setting.0;
            let of_group = self.values.iter().filter(|v| v.setting.0 == group);
            // A group with another value than at boot was written since.
            let written = of_group.clone().any(Value::differs_from_boot);
            let value = &mut self.values[n];
            if applies(value) {
                value.called_saved(written);
            }
        }
    }

    fn of(&mut self, setting: Setting) -> Option<&mut Value> {
        self.values.iter_mut().find(|v| v.setting == setting)
    }
}
