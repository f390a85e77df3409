//! Events in order of time. Events of the same time keep the order in which they were requested.

use std::{cmp::Reverse, collections::BinaryHeap};

use crate::time::Ps;

/// Receiver of an event, with a variant for each block that schedules events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Target {
    Rcc,
    Timer(u8),
    /// USART1, USART3 or USART6, by number.
    Usart(u8),
    Spi1,
    I2c3,
    CanBus(u8),
    /// The tag is the index of the converter.
    Adc,
    Iwdg,
    Flash,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Event {
    pub at: Ps,
    /// Order of the requests, so that events of the same time are deterministic.
    pub order: u64,
    pub target: Target,
    /// The target defines its meaning. A target that cancels events puts a generation number in it and ignores old ones.
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
