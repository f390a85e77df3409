//! What the pilot, the world and a PC do, and when.

use std::{cmp::Reverse, collections::BinaryHeap};

use robot_plant::{
    time::{MS, Ps, SECOND},
    wire::CanFrame,
    world::{CanBusId, RemoteInput, World},
};

use super::{
    dice::Dice,
    harmless::{self, READ, WRITE},
};
use crate::{
    machine::faults,
    scenario::{Action, Deed},
};

/// Calibration and set-up are over, as a rule.
const BOOTED: Ps = 2_500 * MS;

/// Between two requests on one bus: the robot answers one in 4 ms.
const NEXT_REQUEST: Ps = 7 * MS;

/// Who acts next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Actor {
    Pilot,
    World,
    Chip,
    Pc,
    Tuner,
}

/// Deeds in order of time, drawn as they are needed.
pub struct Plan {
    dice: Dice,
    /// The image and its supply fail only up to here: afterwards the uptime grows past every counter's end.
    chip_fails_until: Ps,
    due: BinaryHeap<Reverse<(Ps, Actor)>>,
    /// Drawn, not yet handed out; by time and order of drawing.
    waiting: BinaryHeap<Reverse<(Ps, u64)>>,
    deeds: std::collections::HashMap<u64, Deed>,
    drawn: u64,
}

impl Plan {
    pub fn new(seed: u64, length: Ps) -> Self {
        let actors = [
            (BOOTED, Actor::Pilot),
            (5 * SECOND, Actor::World),
            (20 * SECOND, Actor::Chip),
            (SECOND, Actor::Pc),
            (SECOND, Actor::Tuner),
        ];
        Self {
            dice: Dice::new(seed),
            chip_fails_until: length / 3,
            due: actors.into_iter().map(Reverse).collect(),
            waiting: BinaryHeap::new(),
            deeds: Default::default(),
            drawn: 0,
        }
    }

    /// The next deed due at or before `now`.
    pub fn next_until(&mut self, now: Ps) -> Option<Action> {
        while let Some(Reverse((at, actor))) = self.due.peek().copied()
            && at <= now
        {
            self.due.pop();
            let next = match actor {
                Actor::Pilot => self.pilot(at),
                Actor::World => self.world(at),
                Actor::Chip => self.chip(at),
                Actor::Pc => self.pc(at),
                Actor::Tuner => {
                    self.tune(at);
                    at + self.dice.time(500.0, 10_000.0)
                }
            };
            self.due.push(Reverse((next, actor)));
        }
        let Reverse((at, _)) = *self.waiting.peek()?;
        if at > now {
            return None;
        }
        let Reverse((at, number)) = self.waiting.pop()?;
        let what = self.deeds.remove(&number)?;
        Some(Action { at, what })
    }

    fn then(&mut self, at: Ps, what: Deed) {
        self.waiting.push(Reverse((at, self.drawn)));
        self.deeds.insert(self.drawn, what);
        self.drawn += 1;
    }

    fn remote(&mut self, at: Ps, input: RemoteInput) {
        self.then(at, Deed::Remote(input));
    }

    /// One turn at the radio: clear what is latched, arm, drive, stop. Returns when the next begins.
    fn pilot(&mut self, start: Ps) -> Ps {
        let mut at = start;
        self.remote(at, switches(false, false));
        at += self.dice.time(50.0, 500.0);
        let bring_up = self.bring_up();
        self.then(at, Deed::Can(CanBusId::Can1, bring_up));
        if self.dice.chance(0.7) {
            self.remote(at, switches(false, true));
            at += self.dice.time(1_100.0, 1_500.0);
            self.remote(at, switches(false, false));
            at += self.dice.time(50.0, 300.0);
        }
        while self.dice.chance(0.5) {
            at = self.rest(at);
        }
        self.remote(at, switches(true, false));
        at += self.dice.time(100.0, 600.0);
        let end = at + self.dice.time(1_000.0, 12_000.0);
        while at < end {
            let sticks = self.sticks();
            self.remote(at, sticks);
            at += self.dice.time(20.0, 2_000.0);
        }
        if self.dice.chance(0.3) {
            self.remote(at, switches(true, true));
            at += self.dice.time(20.0, 1_000.0);
        }
        at
    }

    /// Time to tune and to save, which ends at any moment of that. Returns when.
    fn rest(&mut self, start: Ps) -> Ps {
        let changes = start + self.dice.time(50.0, 800.0);
        self.tune(changes);
        let end = changes + self.dice.time(300.0, 5_000.0);
        if changes < self.chip_fails_until && self.dice.chance(0.7) {
            let cut = changes + self.dice.time(400.0, 1_500.0);
            let back = cut + self.dice.time(10.0, 250.0);
            self.fault("power-cut", cut, back);
            self.ask(back + 300 * MS);
            return end.max(back + 600 * MS);
        }
        end
    }

    /// A PC changes some settings, asks whether they are saved, and what they are. Flash may fail at that.
    fn tune(&mut self, start: Ps) {
        let bus = self.bus();
        let mut at = start;
        for _ in 0..1 + self.dice.bits() % 4 {
            let change = harmless::change(&mut self.dice);
            self.then(at, Deed::Can(bus, change));
            at += NEXT_REQUEST + self.dice.time(1.0, 100.0);
        }
        if self.dice.chance(0.15) {
            let faults = ["flash-stuck-bits", "flash-erase-fails"];
            let name = self.dice.pick(&faults).copied().unwrap_or_default();
            let begins = at + self.dice.time(1.0, 800.0);
            let ends = begins + self.dice.time(50.0, 4_000.0);
            self.fault(name, begins, ends);
        }
        at += self.dice.time(400.0, 1_500.0);
        self.then(at, Deed::Can(bus, harmless::store_question()));
        self.ask(at + NEXT_REQUEST);
    }

    fn ask(&mut self, start: Ps) {
        let bus = self.bus();
        for (question, n) in harmless::questions().zip(0..) {
            self.then(start + n * NEXT_REQUEST, Deed::Can(bus, question));
        }
    }

    fn fault(&mut self, name: &str, begins: Ps, ends: Ps) {
        self.then(begins, Deed::StartFault(name.to_owned()));
        self.then(ends, Deed::EndFault(name.to_owned()));
    }

    fn bus(&mut self) -> CanBusId {
        if self.dice.chance(0.5) {
            CanBusId::Can1
        } else {
            CanBusId::Can2
        }
    }

    /// Off, mostly: else one of the three steps, with one motor to try out and how.
    fn bring_up(&mut self) -> CanFrame {
        let step = match self.dice.unit() {
            u if u < 0.7 => 0,
            u if u < 0.75 => 1,
            u if u < 0.8 => 2,
            _ => 3,
        };
        let (motor, action, value) = if step < 3 {
            (0, 0, 0)
        } else {
            let motor = (self.dice.bits() % 6) as u8;
            let most = if motor < 2 { 1_100.0 } else { 550.0 };
            let value = self.dice.between(-most, most) as i16;
            let kinds = [(0, value), (0, 0), (1, 0)];
            let (action, value) = self.dice.pick(&kinds).copied().unwrap_or_default();
            (motor, action, value)
        };
        let [low, high] = value.to_le_bytes();
        CanFrame {
            id: WRITE,
            extended: false,
            remote: false,
            dlc: 8,
            data: [0x40, step, motor, action, low, high, 0, 0],
        }
    }

    fn sticks(&mut self) -> RemoteInput {
        let mut axis = || match self.dice.unit() {
            u if u < 0.2 => 0.0,
            u if u < 0.3 => 1.0,
            u if u < 0.4 => -1.0,
            _ => self.dice.between(-1.0, 1.0),
        };
        let (vx, wz) = (axis(), axis());
        // The dead-man stick of bring-up.
        let left_x = self.dice.chance(0.5);
        let mode = self.dice.chance(0.1).then(|| (self.dice.bits() % 3) as u8);
        RemoteInput {
            vx: Some(vx),
            wz: Some(wz),
            mode,
            left_x: Some(f64::from(left_x)),
            ..RemoteInput::default()
        }
    }

    /// A fault of a device, wire or radio, or a burst of a rogue node.
    fn world(&mut self, at: Ps) -> Ps {
        let names: Vec<&str> = World::faults().iter().map(|fault| fault.name).collect();
        let Some(name) = self.dice.pick(&names).map(|name| (*name).to_owned()) else {
            return Ps::MAX;
        };
        let lasts = if name.starts_with("rogue") {
            self.dice.time(1.0, 300.0)
        } else if name.ends_with("-gone") || name.ends_with("-wrong-id") {
            // What has no supply, or gets another identifier, takes its time to boot.
            self.dice.time(100.0, 4_000.0)
        } else {
            self.dice.time(10.0, 4_000.0)
        };
        self.fault(&name, at, at + lasts);
        // Often alone, at times together.
        at + self.dice.time(300.0, 20_000.0)
    }

    fn chip(&mut self, at: Ps) -> Ps {
        if at > self.chip_fails_until {
            return Ps::MAX;
        }
        let names: Vec<&str> = faults::all().map(|fault| fault.name).collect();
        if let Some(name) = self.dice.pick(&names) {
            self.then(at, Deed::StartFault((*name).to_owned()));
            let ends_by_reset = faults::of_the_program().any(|fault| fault.name == *name);
            if !ends_by_reset {
                let end = at + self.dice.time(10.0, 250.0);
                self.then(end, Deed::EndFault((*name).to_owned()));
            }
        }
        at + self.dice.time(20_000.0, 120_000.0)
    }

    /// Requests on the tuning channel: those that change nothing, and those that must be refused.
    fn pc(&mut self, at: Ps) -> Ps {
        let bus = self.bus();
        let frame = self.request();
        self.then(at, Deed::Can(bus, frame));
        at + self.dice.time(5.0, 2_000.0)
    }

    fn request(&mut self) -> CanFrame {
        let junk = self.dice.bits().to_le_bytes();
        let [group, index, .., length] = junk;
        let (id, data, dlc) = match self.dice.bits() % 6 {
            0 => (READ, [0x11, 0, 0, 0, 0, 0, 0, 0], 1),
            1 => (READ, [0x21, group % 10, index % 24, 0, 0, 0, 0, 0], 3),
            // Not a number: no setting may become that.
            2 => (
                WRITE,
                [0x20, group % 10, index % 24, 0, 0, 0, 0xC0, 0x7F],
                8,
            ),
            // Wheel geometry of another robot's size, and too short.
            3 => (WRITE, [0x10, 200, 0, 0xB8, 0x0B, 0, 0, 0], 5),
            4 => (READ, junk, length % 9),
            // An unknown command.
            _ => (WRITE, [0x80 | group, index, 0, 0, 0, 0, 0, 0], 8),
        };
        CanFrame {
            id,
            extended: false,
            remote: false,
            dlc,
            data,
        }
    }
}

/// With the sticks let go.
fn switches(enable: bool, e_stop: bool) -> RemoteInput {
    RemoteInput {
        enable: Some(enable),
        e_stop: Some(e_stop),
        vx: Some(0.0),
        wz: Some(0.0),
        left_x: Some(0.0),
        ..RemoteInput::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deeds(seed: u64) -> Vec<Action> {
        let mut plan = Plan::new(seed, 600 * SECOND);
        let mut all = Vec::new();
        for ms in 0..300_000 {
            while let Some(action) = plan.next_until(ms * MS) {
                assert!(action.at <= ms * MS);
                all.push(action);
            }
        }
        all
    }

    #[test]
    fn a_seed_is_one_story_told_in_order() {
        let story = deeds(1);
        assert_eq!(story, deeds(1));
        assert_ne!(story, deeds(2));
        assert!(story.is_sorted_by_key(|action| action.at));
        let count = |is: fn(&Deed) -> bool| story.iter().filter(|a| is(&a.what)).count();
        assert!(count(|d| matches!(d, Deed::Remote(r) if r.enable == Some(true))) > 20);
        assert!(count(|d| matches!(d, Deed::StartFault(_))) > 30);
        assert!(count(|d| matches!(d, Deed::Can(..))) > 300);
    }

    #[test]
    fn faults_of_the_world_end() {
        let story = deeds(3);
        for info in World::faults() {
            let starts = |d: &Deed| matches!(d, Deed::StartFault(n) if n == info.name);
            let ends = |d: &Deed| matches!(d, Deed::EndFault(n) if n == info.name);
            let count = |is: &dyn Fn(&Deed) -> bool| story.iter().filter(|a| is(&a.what)).count();
            assert!(count(&starts) <= count(&ends) + 1, "{}", info.name);
        }
    }
}
