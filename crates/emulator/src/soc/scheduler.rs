//! Events in order of time; those of the same time in the order in which they were requested.

use std::{cmp::Reverse, collections::BinaryHeap};

use crate::time::Ps;

/// Receiver of an event: one variant for each block that acts by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Target {
    Rcc,
    Timer(u8),
    /// 1, 3 or 6.
    Usart(u8),
    Spi1,
    I2c3,
    CanBus(u8),
    /// Tag: which converter, from 0.
    Adc,
    Iwdg,
    Flash,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Event {
    pub at: Ps,
    /// Order of asking, so that equal times stay deterministic.
    pub order: u64,
    pub target: Target,
    /// Meaning is the target's own; a target that cancels keeps a generation number in it and ignores old ones.
    pub tag: u32,
}

#[derive(Debug, Default)]
pub struct Scheduler {
    heap: BinaryHeap<Reverse<Event>>,
    asked: u64,
}

impl Scheduler {
    pub fn at(&mut self, at: Ps, target: Target, tag: u32) {
        self.asked += 1;
        self.heap.push(Reverse(Event {
            at,
            order: self.asked,
            target,
            tag,
        }));
    }

    pub fn next(&self) -> Ps {
        self.heap.peek().map_or(Ps::MAX, |e| e.0.at)
    }

    /// The earliest event at or before `now`.
    pub fn pop_due(&mut self, now: Ps) -> Option<Event> {
        if self.next() > now {
            return None;
        }
        self.heap.pop().map(|e| e.0)
    }
}
