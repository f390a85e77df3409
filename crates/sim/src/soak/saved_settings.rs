//! A setting that the robot has acknowledged and reported as saved must be there after every later boot. Replies on CAN
//! show both.

mod tracked_setting;

use robot_plant::{
    time::{MS, Ps},
    wire::CanFrame,
    world::CanBusId,
};

use super::tuning_frames::{self, READ_SETTING, Setting, WRITE_SETTING};
use tracked_setting::{ReadOutcome, TrackedSetting};

/// Replies on the two buses overtake each other by at most this time.
const OVERTAKEN: Ps = 20 * MS;
/// The firmware's status is older than this only if a task no longer runs; by then the watchdog has reset the chip.
const FRESH: Ps = 100 * MS;

/// A frame that the PC has received.
#[derive(Clone, Copy, Debug)]
pub struct ReceivedFrame<'a> {
    pub at: Ps,
    pub bus: CanBusId,
    pub frame: &'a CanFrame,
    /// Whether a fault disturbs the bus, so that replies may be late.
    pub disturbed: bool,
}

/// What the firmware reports about its parameter store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoreStatus {
    pub all_saved: bool,
    pub generation: u32,
    /// The boot found sectors, slots or groups that it could not use.
    pub reported_loss: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SettingsTally {
    /// Writes that the robot has acknowledged.
    pub changes: u64,
    /// Values that were read after a boot and were the saved ones.
    pub restored: u64,
    /// Values that worn flash has lost, as the robot reported.
    pub reported_lost: u64,
}

/// The settings that the soak changes, followed through writes, saves and boots.
#[derive(Debug)]
pub struct SavedSettings {
    values: Vec<TrackedSetting>,
    /// Frames sent on each bus.
    sent: [u64; 2],
    changed: Ps,
    booted: Ps,
    status: Option<StoreStatus>,
    tally: SettingsTally,
}

impl SavedSettings {
    /// Starts with the flash contents of [`initial_flash`](super::initial_flash).
    pub fn new() -> Self {
        let settings = tuning_frames::RANGES.iter();
        let values = settings
            .map(|(setting, ..)| TrackedSetting::new(*setting, tuning_frames::initial(*setting)));
        Self {
            values: values.collect(),
            sent: [0; 2],
            changed: 0,
            booted: 0,
            status: None,
            tally: SettingsTally::default(),
        }
    }

    pub fn tally(&self) -> SettingsTally {
        self.tally
    }

    /// Notes that a frame of the PC was handed to the bus.
    pub fn sent(&mut self, bus: CanBusId, frame: &CanFrame) {
        let sent = &mut self.sent[bus as usize];
        *sent += 1;
        let number = *sent;
        if let Some((setting, bits)) = tuning_frames::parse_write(frame) {
            let changed = self.values.iter_mut().find(|v| v.setting == setting);
            changed
                .into_iter()
                .for_each(|v| v.requested(bus, number, bits));
        }
    }

    /// Notes the number of frames sent on each bus.
    pub fn delivered(&mut self, delivered: [u64; 2], now: Ps) {
        self.values
            .iter_mut()
            .for_each(|v| v.delivered(delivered, now));
    }

    /// Takes a reply; returns the violation that it shows.
    pub fn received(&mut self, received: &ReceivedFrame) -> Option<String> {
        let ReceivedFrame {
            at,
            bus,
            frame,
            disturbed,
        } = *received;
        if let Some((setting, bits)) = tuning_frames::parse_value(frame, WRITE_SETTING) {
            if self.of(setting)?.acknowledged(bus, bits, at, disturbed) {
                self.tally.changes += 1;
                self.changed = at;
            }
        } else if disturbed {
        } else if let Some((setting, bits)) = tuning_frames::parse_value(frame, READ_SETTING) {
            return self.read(setting, bits, at);
        } else if tuning_frames::parse_unsaved(frame) == Some(0) {
            self.reported_saved(|value| !value.changed_elsewhere(bus, at));
        }
        None
    }

    fn read(&mut self, setting: Setting, bits: u32, at: Ps) -> Option<String> {
        let reported_loss = self.status.is_some_and(|status| status.reported_loss);
        match self.of(setting)?.read(bits, at) {
            ReadOutcome::Consistent => None,
            ReadOutcome::Restored => {
                self.tally.restored += 1;
                None
            }
            ReadOutcome::LostByWear if reported_loss => {
                self.tally.reported_lost += 1;
                None
            }
            ReadOutcome::LostByWear => Some(format!(
                "setting {setting:?} is {} after a boot with worn flash, and the robot does not report a loss",
                f32::from_bits(bits)
            )),
            ReadOutcome::Wrong(right) => Some(format!(
                "setting {setting:?} is {}, and can only be {:?}",
                f32::from_bits(bits),
                right.into_iter().map(f32::from_bits).collect::<Vec<_>>()
            )),
        }
    }

    /// Notes a boot of the image. With `worn` cells it may not find the saved values.
    pub fn booted(&mut self, worn: bool, now: Ps) {
        self.booted = now;
        self.status = None;
        self.values.iter_mut().for_each(|v| v.booted(worn));
    }

    /// Takes the firmware's status, as read from its memory.
    pub fn status(&mut self, status: StoreStatus, worn: bool, now: Ps) {
        let before = self.status.replace(status);
        if worn && before.is_some_and(|before| before.generation != status.generation) {
            // A value that could not be read was not copied to the new sector.
            self.values
                .iter_mut()
                .for_each(TrackedSetting::forget_flash);
        }
        if status.all_saved && now > self.changed + FRESH && now > self.booted + FRESH {
            self.reported_saved(|_| true);
        }
    }

    /// Notes the robot's report that flash holds the values in use.
    fn reported_saved(&mut self, applies: impl Fn(&TrackedSetting) -> bool) {
        for n in 0..self.values.len() {
            let group = self.values[n].setting.0;
            let of_group = self.values.iter().filter(|v| v.setting.0 == group);
            // A group with a value that differs from the boot was written since.
            let written = of_group.clone().any(TrackedSetting::differs_from_boot);
            let value = &mut self.values[n];
            if applies(value) {
                value.reported_saved(written);
            }
        }
    }

    fn of(&mut self, setting: Setting) -> Option<&mut TrackedSetting> {
        self.values.iter_mut().find(|v| v.setting == setting)
    }
}
