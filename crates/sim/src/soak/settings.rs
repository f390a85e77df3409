//! Hears what the robot says of its settings, on CAN and in its own account.

use robot_plant::{
    time::{MS, Ps},
    wire::CanFrame,
    world::CanBusId,
};

use super::{
    harmless,
    kept::{Account, Kept, KeptTally, Letter},
};
use crate::machine::Machine;

/// Cells stick at 1 while it lasts.
const STUCK_BITS: &str = "flash-stuck-bits";
/// The image reads its settings in this time after a reset.
const SETTINGS_READ: Ps = 100 * MS;

/// Where in the diagnostics.
struct Places {
    unsaved: usize,
    seen: usize,
    revision: usize,
    generation: usize,
    /// Each tells what the boot could not use.
    losses: [usize; 3],
}

pub struct Settings {
    places: Places,
    kept: Kept,
    boots: usize,
    booted: Ps,
    /// Until when cells stick, as far as known.
    worn_until: Ps,
}

impl Settings {
    /// `place` finds a name in the diagnostics.
    pub fn new(place: impl Fn(&str) -> Result<usize, String>) -> Result<Self, String> {
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
            kept: Kept::new(),
            boots: 0,
            booted: 0,
            worn_until: 0,
        })
    }

    pub fn tally(&self) -> KeptTally {
        self.kept.tally()
    }

    /// When the run of the image began.
    pub fn booted(&self) -> Ps {
        self.booted
    }

    pub fn sent(&mut self, bus: CanBusId, frame: &CanFrame) {
        self.kept.sent(bus, frame);
    }

    pub fn fault(&mut self, name: &str, begins: bool, now: Ps) {
        if name != STUCK_BITS {
            return;
        }
        self.worn_until = if begins { Ps::MAX } else { now + SETTINGS_READ };
        if begins && now < self.booted + SETTINGS_READ {
            self.kept.booted(true, self.booted);
        }
    }

    /// The rule broken. `diag` is there while the image runs; `troubled` are buses on which replies may be late.
    pub fn look(
        &mut self,
        machine: &mut Machine,
        diag: Option<&[f64]>,
        troubled: impl Fn(CanBusId) -> bool,
        now: Ps,
    ) -> Option<String> {
        let (delivered, letters) = post(machine);
        self.kept.delivered(delivered, now);
        let wrong = letters.iter().find_map(|(at, bus, frame)| {
            self.kept.heard(&Letter {
                at: *at,
                bus: *bus,
                frame,
                troubled: troubled(*bus),
            })
        });
        let boots = machine.resets();
        let worn = now < self.worn_until;
        if boots != std::mem::replace(&mut self.boots, boots) {
            self.booted = now;
            self.kept.booted(worn, now);
        } else if let Some(diag) = diag {
            let account = self.places.account(diag);
            self.kept.account(account, worn, now);
        }
        wrong
    }
}

impl Places {
    fn account(&self, diag: &[f64]) -> Account {
        let knows_all = diag[self.seen] == diag[self.revision];
        Account {
            all_saved: knows_all && diag[self.unsaved] == 0.0,
            generation: diag[self.generation] as u32,
            told_loss: self.losses.iter().any(|place| diag[*place] != 0.0),
        }
    }
}

/// Frames that went out on each bus since the start, and replies that came in.
fn post(machine: &mut Machine) -> ([u64; 2], Vec<(Ps, CanBusId, CanFrame)>) {
    let mut delivered = [0; 2];
    let mut replies = Vec::new();
    machine.with_world(|world| {
        for bus in [CanBusId::Can1, CanBusId::Can2] {
            let adapter = world.can_adapter(bus);
            delivered[bus as usize] = adapter.sent();
            while let Some((at, frame)) = adapter.take() {
                replies.extend((frame.id == harmless::REPLY).then_some((at, bus, frame)));
            }
        }
    });
    (delivered, replies)
}
