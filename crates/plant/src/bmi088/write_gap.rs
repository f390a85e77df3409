//! The pause that a die wants after a register write: 2 µs in normal mode, 450 µs in suspend mode (datasheet
//! BST-BMI088-DS001, SPI timing, "idle time after write access"; Bosch's BMI08x sensor API waits as long).

use crate::{
    complaint::Complaint,
    time::{Ps, US},
};

const NORMAL: Ps = 2 * US;
const SUSPEND: Ps = 450 * US;

/// Watches one chip select. The write that came too soon is taken all the same: DJI's `BMI088driver.c` pauses 150 µs
/// in suspend mode, on this board, and its sensor starts.
#[derive(Debug, Default)]
pub(super) struct WriteGap {
    /// Of the last write, and when it is over; it begins with the rise of the chip select.
    gap: Ps,
    over_at: Ps,
    /// A write is in the transaction under way.
    wrote: bool,
    complaint: Option<Complaint>,
}

impl WriteGap {
    /// A register is written in a transaction that began at `selected_at`.
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
