//! What happens on the bus, one event after the other.

use rand::RngExt;

use super::{
    Bus, Queued,
    line::{Party, Sent, byte_ns},
    running::Fate,
};
use crate::{fault::Fault, servo::Reply};

/// Time between two looks at the loads, ns.
const LOADS_NS: u64 = 10_000_000;
/// Bytes of a request in which `corrupt-packet` changes one: the shortest requests have six.
const SHORTEST_REQUEST: usize = 6;

/// What happens next. Of events at one time the first of these comes first: an answer sees all of its question.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Event {
    /// A fault starts or ends.
    Fault,
    /// The loads are looked at again.
    Loads,
    /// A byte ends at someone who receives it.
    End,
    /// A byte starts on the wire.
    Start,
}

impl Bus {
    /// Lets time pass up to `to_ns`.
    pub fn advance(&mut self, to_ns: u64) {
        while let Some((at_ns, event)) = self.next_event().filter(|(at_ns, _)| *at_ns <= to_ns) {
            self.now_ns = self.now_ns.max(at_ns);
            self.happen(at_ns, event);
        }
        self.now_ns = self.now_ns.max(to_ns);
    }

    /// When something changes next by itself, ns: a byte starts or ends on the wire or reaches the host, a fault starts or ends.
    pub fn next_change_ns(&self) -> Option<u64> {
        let arrival = self.host.heard.front().map(|(at_ns, _)| *at_ns);
        let event = self.next_event().map(|(at_ns, _)| at_ns);
        match (arrival, event) {
            (Some(arrival), Some(event)) => Some(arrival.min(event)),
            (arrival, event) => arrival.or(event),
        }
    }

    /// The next event with its time, ns.
    fn next_event(&self) -> Option<(u64, Event)> {
        let starts_ns = self.to_send.peek().map(|queued| queued.0.start_ns);
        let events = [
            (self.next_fault_ns(), Event::Fault),
            (self.body.as_ref().map(|_| self.next_loads_ns), Event::Loads),
            (self.next_end_ns(), Event::End),
            (starts_ns, Event::Start),
        ];
        let known = events
            .into_iter()
            .filter_map(|(at_ns, event)| Some((at_ns?, event)));
        known.filter(|(at_ns, _)| *at_ns < u64::MAX).min()
    }

    /// When the next byte that someone receives ends.
    pub(super) fn next_end_ns(&self) -> Option<u64> {
        let servos = self.units.iter().filter_map(|unit| unit.ear.ends_ns());
        servos.chain(self.host.ear.ends_ns()).min()
    }

    fn happen(&mut self, at_ns: u64, event: Event) {
        match event {
            Event::Fault => self.change_faults(at_ns),
            Event::Loads => {
                self.next_loads_ns = at_ns + LOADS_NS;
                self.load_servos(at_ns);
            }
            Event::End => self.receive(at_ns),
            Event::Start => {
                if let Some(queued) = self.to_send.pop() {
                    self.transmit(queued.0);
                }
            }
        }
    }

    fn load_servos(&mut self, now_ns: u64) {
        let angles: Vec<f64> = self
            .units
            .iter_mut()
            .map(|unit| {
                unit.servo.advance(now_ns);
                unit.servo.shaft_steps()
            })
            .collect();
        let Some(body) = &self.body else { return };
        for (unit, mut load) in self.units.iter_mut().zip(body.loads(&angles)) {
            load.is_blocked = unit.servo.load().is_blocked;
            unit.servo.set_load(load);
        }
    }

    /// A byte starts on the wire, if no fault takes it away.
    fn transmit(&mut self, queued: Queued) {
        let mut sent = queued.sent;
        if sent.by == Party::Host && !self.passes_as_request(&mut sent) {
            return;
        }
        let dropped = self.probability(|fault| match fault {
            Fault::Drop { probability } => Some(*probability),
            _ => None,
        });
        if self.happens(dropped) {
            self.injected.dropped_bytes += 1;
            return;
        }
        let corrupted = self.probability(|fault| match fault {
            Fault::Corrupt { probability } => Some(*probability),
            _ => None,
        });
        if self.happens(corrupted) {
            self.injected.corrupted_bytes += 1;
            self.change(&mut sent);
        }
        self.forget(sent.start_ns);
        self.line.put(sent);
        self.listen();
    }

    /// Lets go of bytes that have ended, which are needed only by those in the middle of a byte.
    fn forget(&mut self, now_ns: u64) {
        if self.next_end_ns().is_none() {
            self.line.forget(now_ns);
        }
    }

    /// Lets faults of packets act on a byte of the host. False if it vanishes.
    fn passes_as_request(&mut self, sent: &mut Sent) -> bool {
        if self.host.frames.is_between() {
            self.host.fate = self.draw_fate(SHORTEST_REQUEST);
        }
        self.host.frames.take(sent.byte);
        match self.host.fate.next() {
            None => false,
            Some(is_changed) => {
                if is_changed {
                    self.change(sent);
                }
                true
            }
        }
    }

    fn change(&mut self, sent: &mut Sent) {
        sent.byte ^= self.random.random_range(1..=0xFF_u8);
    }

    pub(super) fn below(&mut self, limit: usize) -> usize {
        self.random.random_range(0..limit.max(1))
    }

    fn listen(&mut self) {
        self.host.ear.listen(&self.line, self.host.baud);
        for unit in self.units.iter_mut().filter(|unit| unit.has_power) {
            let baud = unit.servo.baud();
            unit.ear.listen(&self.line, baud);
        }
    }

    /// Bytes end at everyone who receives one until now.
    fn receive(&mut self, now_ns: u64) {
        let is_over = |ends_ns: Option<u64>| ends_ns.is_some_and(|ends_ns| ends_ns <= now_ns);
        if is_over(self.host.ear.ends_ns())
            && let Some(byte) = self.host.ear.take(&self.line)
        {
            self.deliver(now_ns, byte);
        }
        for place in 0..self.units.len() {
            let unit = &mut self.units[place];
            if !is_over(unit.ear.ends_ns()) {
                continue;
            }
            let byte = unit.ear.take(&self.line).filter(|_| unit.has_power);
            let Some(frame) = byte.and_then(|byte| unit.scanner.take(byte)) else {
                continue;
            };
            unit.servo.advance(now_ns);
            let baud = unit.servo.baud();
            let reply = unit.servo.hear(&frame);
            if let Some(reply) = reply {
                self.answer(place, baud, now_ns, reply);
            }
        }
        self.forget(now_ns);
        self.listen();
    }

    fn deliver(&mut self, now_ns: u64, byte: u8) {
        let mut at_ns = now_ns;
        let delays: Vec<(f64, u64)> = self
            .faults()
            .filter_map(|(_, fault)| match fault {
                Fault::Delay { probability, by_ns } => Some((probability, by_ns)),
                _ => None,
            })
            .collect();
        for (probability, by_ns) in delays {
            if self.happens(probability) {
                self.injected.delayed_bytes += 1;
                at_ns += by_ns;
            }
        }
        let last_ns = self.host.heard.back().map_or(0, |(last_ns, _)| *last_ns);
        self.host.heard.push_back((at_ns.max(last_ns), byte));
    }

    fn answer(&mut self, place: usize, baud: u32, now_ns: u64, reply: Reply) {
        let unit = &mut self.units[place];
        let mut start_ns = (now_ns + reply.after_ns).max(unit.free_ns);
        unit.free_ns = start_ns + reply.bytes.len() as u64 * byte_ns(baud);
        let bytes = match unit.wrong_id {
            Some(id) => reply.with_id(id).bytes,
            None => reply.bytes,
        };
        let mut fate = self.draw_fate(bytes.len());
        if fate == Fate::Lost {
            return;
        }
        for byte in bytes {
            let mut sent = Sent::new(Party::Servo(place), start_ns, baud, byte);
            if fate.next() == Some(true) {
                self.change(&mut sent);
            }
            start_ns = sent.end_ns;
            self.queue(sent);
        }
    }
}
