//! The pause that a die needs after a register write: 2 µs in normal mode, 450 µs in suspend mode (datasheet
//! BST-BMI088-DS001, SPI timing, "idle time after write access"; Bosch's BMI08x sensor API waits as long).

use crate::{
    complaint::Complaint,
    time::{Ps, US},
};

const NORMAL: Ps = 2 * US;
const SUSPEND: Ps = 450 * US;

/// Watches one chip select. A write that comes too early is accepted nevertheless: DJI's `BMI088driver.c` pauses only 150 µs
/// in suspend mode on this board, and its sensor starts.
#[derive(Clone, Debug, Default)]
pub(super) struct WriteGap {
    /// The pause after the last write, which begins when the chip select rises.
    gap: Ps,
    /// Time at which that pause is over.
    over_at: Ps,
    /// Whether the current transaction has written a register.
    wrote: bool,
    complaint: Option<Complaint>,
}

impl WriteGap {
    /// Notes that a register is written in a transaction that began at `selected_at`.
    pub(super) fn written(&mut self, suspended: bool, selected_at: Ps) {
        if selected_at < self.over_at {
            self.complaint = Some(if self.gap == NORMAL {
                Complaint::fails("BMI088: register written less than 2 us after another")
            } else {
                Complaint::suspicious(
                    "BMI088: register written less than 450 us after another in suspend mode",
                )
            });
        }
        self.gap = if suspended { SUSPEND } else { NORMAL };
        self.wrote = true;
    }

    pub(super) fn deselected(&mut self, now: Ps) {
        if std::mem::take(&mut self.wrote) {
            self.over_at = now + self.gap;
        }
    }

    pub(super) fn take_complaint(&mut self) -> Option<Complaint> {
        self.complaint.take()
    }
}
