//! Feeds [`SavedSettings`] with the frames on CAN and with the firmware's own status.

use robot_plant::{
    time::{MS, Ps},
    wire::CanFrame,
    world::CanBusId,
};

use super::{
    missing_signal::MissingSignal,
    saved_settings::{ReceivedFrame, SavedSettings, SettingsTally, StoreStatus},
    tuning_frames,
};
use crate::machine::Machine;

/// The fault that makes cells stick at 1.
const STUCK_BITS: &str = "flash-stuck-bits";
/// The image has read its settings within this time after a reset.
const SETTINGS_READ: Ps = 100 * MS;

/// Positions in the diagnostics.
struct Places {
    unsaved: usize,
    seen: usize,
    revision: usize,
    generation: usize,
    /// Counters of what the boot could not use.
    losses: [usize; 3],
}

pub struct SettingsCheck {
    places: Places,
    saved: SavedSettings,
    boots: usize,
    booted: Ps,
    /// Latest time at which cells may still be stuck.
    worn_until: Ps,
}

impl SettingsCheck {
    /// `place` finds the position of a name in the diagnostics.
    pub fn new(
        place: impl Fn(&str) -> Result<usize, MissingSignal>,
    ) -> Result<Self, MissingSignal> {
        Ok(Self {
            places: Places {
                unsaved: place("diag.params.unsaved")?,
                seen: place("diag.params.seen")?,
                revision: place("diag.tuning.revision")?,
                generation: place("diag.params.generation")?,
                losses: [
                    place("diag.params.lost_sectors")?,
                    place("diag.params.damaged")?,
                    place("diag.params.refused")?,
                ],
            },
            saved: SavedSettings::new(),
            boots: 0,
            booted: 0,
            worn_until: 0,
        })
    }

    pub fn tally(&self) -> SettingsTally {
        self.saved.tally()
    }

    /// When the image last booted.
    pub fn booted(&self) -> Ps {
        self.booted
    }

    pub fn sent(&mut self, bus: CanBusId, frame: &CanFrame) {
        self.saved.sent(bus, frame);
    }

    pub fn fault(&mut self, name: &str, begins: bool, now: Ps) {
        if name != STUCK_BITS {
            return;
        }
        self.worn_until = if begins { Ps::MAX } else { now + SETTINGS_READ };
        if begins && now < self.booted + SETTINGS_READ {
            self.saved.booted(true, self.booted);
        }
    }

    /// Returns the violation found, if any. `diag` is `None` while the image does not run; on buses that are `disturbed`
    /// replies may be late.
    pub fn check(
        &mut self,
        machine: &mut Machine,
        diag: Option<&[f64]>,
        disturbed: impl Fn(CanBusId) -> bool,
        now: Ps,
    ) -> Option<String> {
        let (delivered, frames) = drain_adapters(machine);
        self.saved.delivered(delivered, now);
        let wrong = frames.iter().find_map(|(at, bus, frame)| {
            self.saved.received(&ReceivedFrame {
                at: *at,
                bus: *bus,
                frame,
                disturbed: disturbed(*bus),
            })
        });
        let boots = machine.resets();
        let worn = now < self.worn_until;
        if boots != std::mem::replace(&mut self.boots, boots) {
            self.booted = now;
            self.saved.booted(worn, now);
        } else if let Some(diag) = diag {
            let status = self.places.status(diag);
            self.saved.status(status, worn, now);
        }
        wrong
    }
}

impl Places {
    fn status(&self, diag: &[f64]) -> StoreStatus {
        let knows_all = diag[self.seen] == diag[self.revision];
        StoreStatus {
            all_saved: knows_all && diag[self.unsaved] == 0.0,
            generation: diag[self.generation] as u32,
            reported_loss: self.losses.iter().any(|place| diag[*place] != 0.0),
        }
    }
}

/// The number of frames sent on each bus since the start, and the replies received since the last call.
fn drain_adapters(machine: &mut Machine) -> ([u64; 2], Vec<(Ps, CanBusId, CanFrame)>) {
    let mut delivered = [0; 2];
    let mut replies = Vec::new();
    machine.with_world(|world| {
        for bus in [CanBusId::Can1, CanBusId::Can2] {
            let adapter = world.can_adapter(bus);
            delivered[bus as usize] = adapter.sent();
            while let Some((at, frame)) = adapter.take() {
                replies.extend((frame.id == tuning_frames::REPLY).then_some((at, bus, frame)));
            }
        }
    });
    (delivered, replies)
}
