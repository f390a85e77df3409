//! A host and its servos on one wire.

mod events;
mod line;
mod running;
mod unit;

use std::{
    cmp::Reverse,
    collections::{BinaryHeap, VecDeque},
};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::{
    fault::Fault,
    frame::Scanner,
    servo::{Load, Servo, View},
};
use line::{Ear, Line, Party, Sent};
use running::{Fate, Running};
use unit::Unit;

/// What the servos turn: it says what each of them works against.
pub trait Body: Send {
    /// Returns the loads for the angles of all shafts, steps from each encoder's zero, in the order of the servos.
    fn loads(&self, shaft_steps: &[f64]) -> Vec<Load>;
}

/// A fault that was started, so that it can be ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultId(u64);

/// What faults did so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Injected {
    /// Bytes that vanished by `drop`.
    pub dropped_bytes: u64,
    /// Bytes changed by `corrupt`.
    pub corrupted_bytes: u64,
    /// Bytes that came late by `delay`.
    pub delayed_bytes: u64,
    /// Requests and answers that vanished by `drop-packet`.
    pub dropped_packets: u64,
    /// Requests and answers changed by `corrupt-packet`.
    pub corrupted_packets: u64,
}

/// The bus with all that is on it. Time is an argument, in nanoseconds since its start, and never goes back.
pub struct Bus {
    now_ns: u64,
    units: Vec<Unit>,
    body: Option<Box<dyn Body>>,
    next_loads_ns: u64,
    line: Line,
    /// Bytes whose start is to come, the earliest first. The number keeps the order of those that start at once.
    to_send: BinaryHeap<Reverse<Queued>>,
    queued: u64,
    host: Host,
    faults: Vec<Running>,
    started_faults: u64,
    random: Pcg64,
    injected: Injected,
}

/// The PC's adapter.
struct Host {
    baud: u32,
    ear: Ear,
    /// When its UART has sent all it has.
    free_ns: u64,
    /// Bytes for the PC, and when they get there.
    heard: VecDeque<(u64, u8)>,
    /// Follows the host's own frames, to know where one begins.
    frames: Scanner,
    fate: Fate,
}

/// Ordered by start and number; the byte takes no part.
struct Queued {
    start_ns: u64,
    number: u64,
    sent: Sent,
}

impl PartialEq for Queued {
    fn eq(&self, other: &Self) -> bool {
        self.number == other.number
    }
}

impl Eq for Queued {}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.start_ns, self.number).cmp(&(other.start_ns, other.number))
    }
}

impl Bus {
    /// Returns a bus with servos under power, at time 0, the host at 1 Mb/s. The same seed gives the same faults.
    pub fn new(servos: Vec<Servo>, seed: u64) -> Self {
        let units = servos
            .into_iter()
            .enumerate()
            .map(|(place, servo)| Unit::new(place, servo));
        Self {
            now_ns: 0,
            units: units.collect(),
            body: None,
            next_loads_ns: 0,
            line: Line::default(),
            to_send: BinaryHeap::new(),
            queued: 0,
            host: Host {
                baud: 1_000_000,
                ear: Ear::new(Party::Host),
                free_ns: 0,
                heard: VecDeque::new(),
                frames: Scanner::default(),
                fate: Fate::Whole,
            },
            faults: Vec::new(),
            started_faults: 0,
            random: Pcg64::seed_from_u64(seed),
            injected: Injected::default(),
        }
    }

    /// The same with something that the servos turn.
    pub fn with_body(mut self, body: impl Body + 'static) -> Self {
        self.body = Some(Box::new(body));
        self
    }

    /// Time, ns.
    pub fn now_ns(&self) -> u64 {
        self.now_ns
    }

    /// The host's baud rate, b/s.
    pub fn host_baud(&self) -> u32 {
        self.host.baud
    }

    /// Changes the host's baud rate, b/s, for what it sends and hears from now on.
    pub fn set_host_baud(&mut self, baud: u32) {
        self.host.baud = baud.max(1);
    }

    /// The host sends bytes, as soon as those before them are out.
    pub fn send(&mut self, bytes: &[u8]) {
        let mut start_ns = self.now_ns.max(self.host.free_ns);
        for byte in bytes {
            let sent = Sent::new(Party::Host, start_ns, self.host.baud, *byte);
            start_ns = sent.end_ns;
            self.queue(sent);
        }
        self.host.free_ns = start_ns;
    }

    /// When all that the host sends will be on the wire, ns.
    pub fn sent_ns(&self) -> u64 {
        self.host.free_ns
    }

    /// When all that is now known to be sent by anyone will have passed, ns.
    pub fn quiet_ns(&self) -> u64 {
        let queued = self.to_send.iter().map(|queued| queued.0.sent.end_ns);
        let heard = self.next_end_ns();
        queued.chain(heard).max().unwrap_or(self.now_ns)
    }

    /// Returns the next byte that has reached the host, with the time when it did, ns.
    pub fn take_heard(&mut self) -> Option<(u64, u8)> {
        let (at_ns, _) = self.host.heard.front()?;
        (*at_ns <= self.now_ns)
            .then(|| self.host.heard.pop_front())
            .flatten()
    }

    /// Drops what has reached the host and was not taken.
    pub fn discard_heard(&mut self) {
        while self.take_heard().is_some() {}
    }

    /// Starts a fault now.
    pub fn start(&mut self, fault: Fault) -> FaultId {
        let id = self.schedule(fault, self.now_ns, u64::MAX);
        self.change_faults(self.now_ns);
        id
    }

    /// Starts a fault at a time and ends it at another, ns. A fault of a servo that is not there does nothing.
    pub fn schedule(&mut self, fault: Fault, from_ns: u64, to_ns: u64) -> FaultId {
        self.started_faults += 1;
        let id = FaultId(self.started_faults);
        self.faults
            .push(Running::new(id, fault, from_ns.max(self.now_ns), to_ns));
        id
    }

    /// Ends a fault now.
    pub fn end(&mut self, id: FaultId) {
        for fault in self.faults.iter_mut().filter(|fault| fault.id == id) {
            fault.to_ns = self.now_ns;
        }
        self.change_faults(self.now_ns);
    }

    /// Faults that are in force.
    pub fn faults(&self) -> impl Iterator<Item = (FaultId, Fault)> {
        let active = self.faults.iter().filter(|fault| fault.is_active);
        active.map(|fault| (fault.id, fault.fault))
    }

    /// What faults did so far.
    pub fn injected(&self) -> Injected {
        self.injected
    }

    /// What can be seen of the servos now, in their order.
    pub fn view(&mut self) -> Vec<View> {
        let now_ns = self.now_ns;
        let units = self.units.iter_mut();
        units
            .map(|unit| {
                unit.servo.advance(now_ns);
                unit.servo.view()
            })
            .collect()
    }

    /// A servo by its place, to turn its shaft or change its load. `None` if there is none.
    pub fn servo_mut(&mut self, place: usize) -> Option<&mut Servo> {
        let now_ns = self.now_ns;
        self.units.get_mut(place).map(|unit| {
            unit.servo.advance(now_ns);
            &mut unit.servo
        })
    }

    fn queue(&mut self, sent: Sent) {
        self.queued += 1;
        self.to_send.push(Reverse(Queued {
            start_ns: sent.start_ns,
            number: self.queued,
            sent,
        }));
    }

    fn happens(&mut self, probability: f64) -> bool {
        probability > 0.0 && self.random.random::<f64>() < probability
    }
}
