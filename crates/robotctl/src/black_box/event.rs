//! An event as downloaded.

use robot_app::{
    black_box::{Bank, BlackBoxMemory, BlackBoxSample, Event, LAYOUT_VERSION},
    domain::EventKind,
    safety::SafetyFlags,
};

/// An event and its samples in the order of their times.
#[derive(Clone, Debug)]
pub struct RecordedEvent {
    pub event: Event,
    pub samples: Vec<BlackBoxSample>,
}

impl RecordedEvent {
    /// Decodes the bytes of a bank with one of the known layouts. Returns `None` if it holds no event, or none of its records is whole.
    pub(super) fn decode(bytes: &[u8], layout: u8) -> Option<Self> {
        let memory = Box::<BlackBoxMemory>::default();
        memory.fill(0, bytes);
        let bank = Bank::of_layout(&memory, 0, layout);
        let mut samples: Vec<_> = match layout {
            LAYOUT_VERSION => bank.samples().collect(),
            _ => bank.first_samples().collect(),
        };
        samples.sort_by_key(|sample| sample.time);
        // A record may be in both rings when a reset came between the two writes.
        samples.dedup_by_key(|sample| sample.time);
        let event = bank.event()?;
        (!samples.is_empty()).then_some(Self { event, samples })
    }

    /// Returns the time of the event in s since the recorded run booted.
    pub fn seconds(&self) -> f64 {
        self.event.seconds()
    }

    /// Returns the time of a sample in s after the event; it is negative before.
    pub fn after_s(&self, sample: &BlackBoxSample) -> f64 {
        sample.seconds() - self.seconds()
    }

    /// Returns the last sample before the event, or the first of all.
    pub fn just_before(&self) -> &BlackBoxSample {
        let before = self.samples.iter().rev();
        let mut before = before.skip_while(|sample| sample.time >= self.event.time);
        before.next().unwrap_or(&self.samples[0])
    }

    /// Lists the flags that came and went, with the time of each in s after the event.
    pub fn changes(&self) -> Vec<(f64, &'static str, bool)> {
        let mut changes = Vec::new();
        for pair in self.samples.windows(2) {
            let (before, now) = (pair[0].flags, pair[1].flags);
            let at = self.after_s(&pair[1]);
            let raised = now.difference(before);
            let ended = before.difference(now);
            changes.extend(raised.names().map(|name| (at, name, true)));
            changes.extend(ended.names().map(|name| (at, name, false)));
        }
        changes
    }

    /// Returns the flags that caused the stop: of those at the event, the ones that stop something.
    pub fn causes(&self) -> SafetyFlags {
        let stopping = SafetyFlags::GLOBAL_STOP
            .union(SafetyFlags::WHEELS_STOP)
            .union(SafetyFlags::JOINTS_STOP)
            .union(SafetyFlags::BUS_STOP[0])
            .union(SafetyFlags::BUS_STOP[1])
            .union(SafetyFlags::COMMAND_STALE)
            .union(SafetyFlags::STICKS_AWAITED)
            .union(SafetyFlags::PC_LOST);
        match self.event.kind {
            EventKind::PartialStop => {
                let stopping = stopping.union(SafetyFlags::PC_AWAITED);
                self.event.flags.intersection(stopping)
            }
            // Then it only says that the PC did not steer.
            _ => self.event.flags.intersection(stopping),
        }
    }
}
