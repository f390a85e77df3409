//! Draws the actions of the pilot, the world and a PC, and their times.

use std::{cmp::Reverse, collections::BinaryHeap};

use robot_plant::{
    time::{MS, Ps, SECOND},
    wire::CanFrame,
    world::{CanBusId, PcInput, RemoteInput, World},
};

use super::{
    pc_program,
    rng::Rng,
    tuning_frames::{self, READ, WRITE},
};
use crate::{
    machine::faults,
    scenario::{Event, TimedEvent},
};

/// By this time calibration and set-up are over, unless a fault delays them.
const BOOTED: Ps = 2_500 * MS;

/// Time between two requests on one bus: the robot answers one in 4 ms.
const NEXT_REQUEST: Ps = 7 * MS;

/// The source of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Actor {
    Pilot,
    World,
    Chip,
    Pc,
    Tuner,
    Driver,
}

/// Events in order of time. They are drawn as they are needed.
pub struct Plan {
    rng: Rng,
    /// The image and its supply fail only until then. Afterwards the uptime grows until every counter has wrapped.
    chip_fails_until: Ps,
    due: BinaryHeap<Reverse<(Ps, Actor)>>,
    /// Events that were drawn and not yet returned, by time and order of drawing.
    waiting: BinaryHeap<Reverse<(Ps, u64)>>,
    events: std::collections::HashMap<u64, Event>,
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
            (SECOND / 2, Actor::Driver),
        ];
        Self {
            rng: Rng::new(seed),
            chip_fails_until: length / 3,
            due: actors.into_iter().map(Reverse).collect(),
            waiting: BinaryHeap::new(),
            events: Default::default(),
            drawn: 0,
        }
    }

    /// The next event due at or before `now`.
    pub fn next_until(&mut self, now: Ps) -> Option<TimedEvent> {
        while let Some(Reverse((at, actor))) = self.due.peek().copied()
            && at <= now
        {
            self.due.pop();
            let next = match actor {
                Actor::Pilot => self.pilot(at),
                Actor::World => self.world(at),
                Actor::Chip => self.chip(at),
                Actor::Pc => self.pc(at),
                Actor::Driver => self.driver(at),
                Actor::Tuner => {
                    self.tune(at);
                    at + self.rng.time(500.0, 10_000.0)
                }
            };
            self.due.push(Reverse((next, actor)));
        }
        let Reverse((at, _)) = *self.waiting.peek()?;
        if at > now {
            return None;
        }
        let Reverse((at, number)) = self.waiting.pop()?;
        let event = self.events.remove(&number)?;
        Some(TimedEvent { at, event })
    }

    /// Adds an event at `at`.
    fn then(&mut self, at: Ps, event: Event) {
        self.waiting.push(Reverse((at, self.drawn)));
        self.events.insert(self.drawn, event);
        self.drawn += 1;
    }

    fn remote(&mut self, at: Ps, input: RemoteInput) {
        self.then(at, Event::Remote(input));
    }

    /// The pilot clears what is latched, arms, drives and stops. Returns when the next turn begins.
    fn pilot(&mut self, start: Ps) -> Ps {
        let mut at = start;
        self.remote(at, switches(false, false));
        at += self.rng.time(50.0, 500.0);
        let bring_up = self.bring_up();
        self.then(at, Event::Can(CanBusId::Can1, bring_up));
        if self.rng.chance(0.7) {
            self.remote(at, switches(false, true));
            at += self.rng.time(1_100.0, 1_500.0);
            self.remote(at, switches(false, false));
            at += self.rng.time(50.0, 300.0);
        }
        while self.rng.chance(0.5) {
            at = self.rest(at);
        }
        self.remote(at, switches(true, false));
        at += self.rng.time(100.0, 600.0);
        let end = at + self.rng.time(1_000.0, 12_000.0);
        while at < end {
            let sticks = self.sticks();
            self.remote(at, sticks);
            at += self.rng.time(20.0, 2_000.0);
        }
        if self.rng.chance(0.3) {
            self.remote(at, switches(true, true));
            at += self.rng.time(20.0, 1_000.0);
        }
        at
    }

    /// The robot rests, is tuned and saves, until a power cut or the end of the rest. Returns the time of that end.
    fn rest(&mut self, start: Ps) -> Ps {
        let changes = start + self.rng.time(50.0, 800.0);
        self.tune(changes);
        let end = changes + self.rng.time(300.0, 5_000.0);
        if changes < self.chip_fails_until && self.rng.chance(0.7) {
            let cut = changes + self.rng.time(400.0, 1_500.0);
            let back = cut + self.rng.time(10.0, 250.0);
            self.fault("power-cut", cut, back);
            self.ask(back + 300 * MS);
            return end.max(back + 600 * MS);
        }
        end
    }

    /// A PC changes some settings, then asks whether they are saved and reads them. Flash may fail meanwhile.
    fn tune(&mut self, start: Ps) {
        let bus = self.bus();
        let mut at = start;
        for _ in 0..1 + self.rng.bits() % 4 {
            let change = tuning_frames::random_write(&mut self.rng);
            self.then(at, Event::Can(bus, change));
            at += NEXT_REQUEST + self.rng.time(1.0, 100.0);
        }
        if self.rng.chance(0.15) {
            let faults = ["flash-stuck-bits", "flash-erase-fails"];
            let name = self.rng.pick(&faults).copied().unwrap_or_default();
            let begins = at + self.rng.time(1.0, 800.0);
            let ends = begins + self.rng.time(50.0, 4_000.0);
            self.fault(name, begins, ends);
        }
        at += self.rng.time(400.0, 1_500.0);
        self.then(at, Event::Can(bus, tuning_frames::store_status_request()));
        self.ask(at + NEXT_REQUEST);
    }

    fn ask(&mut self, start: Ps) {
        let bus = self.bus();
        for (request, n) in tuning_frames::read_requests().zip(0..) {
            self.then(start + n * NEXT_REQUEST, Event::Can(bus, request));
        }
    }

    fn fault(&mut self, name: &str, begins: Ps, ends: Ps) {
        self.then(begins, Event::StartFault(name.to_owned()));
        self.then(ends, Event::EndFault(name.to_owned()));
    }

    fn bus(&mut self) -> CanBusId {
        if self.rng.chance(0.5) {
            CanBusId::Can1
        } else {
            CanBusId::Can2
        }
    }

    /// A request of bring-up: mostly off, else one of the three steps, with the motor to try and its command.
    fn bring_up(&mut self) -> CanFrame {
        let step = match self.rng.unit() {
            u if u < 0.7 => 0,
            u if u < 0.75 => 1,
            u if u < 0.8 => 2,
            _ => 3,
        };
        let (motor, action, value) = if step < 3 {
            (0, 0, 0)
        } else {
            let motor = (self.rng.bits() % 6) as u8;
            let most = if motor < 2 { 1_100.0 } else { 550.0 };
            let value = self.rng.between(-most, most) as i16;
            let kinds = [(0, value), (0, 0), (1, 0)];
            let (action, value) = self.rng.pick(&kinds).copied().unwrap_or_default();
            (motor, action, value)
        };
        let [low, high] = value.to_le_bytes();
        CanFrame {
            id: WRITE,
            extended: false,
            remote: false,
            dlc: 8,
            data: [
                tuning_frames::BRING_UP,
                step,
                motor,
                action,
                low,
                high,
                0,
                0,
            ],
        }
    }

    fn sticks(&mut self) -> RemoteInput {
        let mut axis = || match self.rng.unit() {
            u if u < 0.2 => 0.0,
            u if u < 0.3 => 1.0,
            u if u < 0.4 => -1.0,
            _ => self.rng.between(-1.0, 1.0),
        };
        let (vx, wz) = (axis(), axis());
        // The dead-man stick of bring-up.
        let left_x = self.rng.chance(0.5);
        // Mode PC as often as both others.
        let mode = self.rng.chance(0.2).then(|| (self.rng.bits() % 4) as u8);
        let mode = mode.map(|mode| if mode == 3 { 1 } else { mode });
        RemoteInput {
            vx: Some(vx),
            wz: Some(wz),
            mode,
            left_x: Some(f64::from(left_x)),
            ..RemoteInput::default()
        }
    }

    /// Starts and ends a fault of a device, wire or radio, or a burst of a rogue node. Returns when the next begins.
    fn world(&mut self, at: Ps) -> Ps {
        let names: Vec<&str> = World::faults().iter().map(|fault| fault.name).collect();
        let Some(name) = self.rng.pick(&names).map(|name| (*name).to_owned()) else {
            return Ps::MAX;
        };
        let lasts = if name.starts_with("rogue") {
            self.rng.time(1.0, 300.0)
        } else if name.ends_with("-gone") || name.ends_with("-wrong-id") {
            // A device that was without supply, or has a new identifier, takes this time to boot.
            self.rng.time(100.0, 4_000.0)
        } else {
            self.rng.time(10.0, 4_000.0)
        };
        self.fault(&name, at, at + lasts);
        // Most faults occur alone, some overlap.
        at + self.rng.time(300.0, 20_000.0)
    }

    fn chip(&mut self, at: Ps) -> Ps {
        if at > self.chip_fails_until {
            return Ps::MAX;
        }
        let names: Vec<&str> = faults::all().map(|fault| fault.name).collect();
        if let Some(name) = self.rng.pick(&names) {
            self.then(at, Event::StartFault((*name).to_owned()));
            let ends_by_reset = faults::of_the_program().any(|fault| fault.name == *name);
            if !ends_by_reset {
                let end = at + self.rng.time(10.0, 250.0);
                self.then(end, Event::EndFault((*name).to_owned()));
            }
        }
        at + self.rng.time(20_000.0, 120_000.0)
    }

    /// Sends a request on the tuning channel that changes nothing or must be refused. Returns when the next is due.
    fn pc(&mut self, at: Ps) -> Ps {
        let bus = self.bus();
        let frame = self.request();
        self.then(at, Event::Can(bus, frame));
        at + self.rng.time(5.0, 2_000.0)
    }

    /// A program on the serial link rests, asks for some motions, and may end or seem frozen. Returns when the next turn
    /// begins.
    fn driver(&mut self, start: Ps) -> Ps {
        let mut at = start;
        if self.rng.chance(0.8) {
            let rest = pc_program::rest(&mut self.rng);
            self.then(at, Event::Pc(rest));
            at += self.rng.time(20.0, 1_000.0);
        }
        let end = at + self.rng.time(500.0, 8_000.0);
        while at < end {
            let motion = pc_program::motion(&mut self.rng);
            self.then(at, Event::Pc(motion));
            at += self.rng.time(5.0, 2_000.0);
        }
        if self.rng.chance(0.3) {
            let off = PcInput {
                on: Some(false),
                ..PcInput::default()
            };
            self.then(at, Event::Pc(off));
            at += self.rng.time(20.0, 2_000.0);
        }
        at
    }

    fn request(&mut self) -> CanFrame {
        let junk = self.rng.bits().to_le_bytes();
        let [group, index, .., length] = junk;
        let (id, data, dlc) = match self.rng.bits() % 6 {
            0 => (READ, [tuning_frames::READ_GEOMETRY, 0, 0, 0, 0, 0, 0, 0], 1),
            1 => (
                READ,
                [
                    tuning_frames::READ_SETTING,
                    group % 10,
                    index % 24,
                    0,
                    0,
                    0,
                    0,
                    0,
                ],
                3,
            ),
            // NaN: no setting may take this value.
            2 => (
                WRITE,
                [
                    tuning_frames::WRITE_SETTING,
                    group % 10,
                    index % 24,
                    0,
                    0,
                    0,
                    0xC0,
                    0x7F,
                ],
                8,
            ),
            // A wheel geometry request that is too short.
            3 => (
                WRITE,
                [tuning_frames::WRITE_GEOMETRY, 200, 0, 0xB8, 0x0B, 0, 0, 0],
                5,
            ),
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

/// The switches, with the sticks centred.
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

    fn events(seed: u64) -> Vec<TimedEvent> {
        let mut plan = Plan::new(seed, 600 * SECOND);
        let mut all = Vec::new();
        for ms in 0..300_000 {
            while let Some(timed) = plan.next_until(ms * MS) {
                assert!(timed.at <= ms * MS);
                all.push(timed);
            }
        }
        all
    }

    #[test]
    fn a_seed_gives_one_sequence_of_events_in_order_of_time() {
        let sequence = events(1);
        assert_eq!(sequence, events(1));
        assert_ne!(sequence, events(2));
        assert!(sequence.is_sorted_by_key(|timed| timed.at));
        let count = |is: fn(&Event) -> bool| sequence.iter().filter(|a| is(&a.event)).count();
        assert!(count(|d| matches!(d, Event::Remote(r) if r.enable == Some(true))) > 20);
        assert!(count(|d| matches!(d, Event::StartFault(_))) > 30);
        assert!(count(|d| matches!(d, Event::Can(..))) > 300);
        assert!(count(|d| matches!(d, Event::Pc(_))) > 100);
    }

    #[test]
    fn faults_of_the_world_end() {
        let sequence = events(3);
        for info in World::faults() {
            let starts = |d: &Event| matches!(d, Event::StartFault(n) if n == info.name);
            let ends = |d: &Event| matches!(d, Event::EndFault(n) if n == info.name);
            let count =
                |is: &dyn Fn(&Event) -> bool| sequence.iter().filter(|a| is(&a.event)).count();
            assert!(count(&starts) <= count(&ends) + 1, "{}", info.name);
        }
    }
}
