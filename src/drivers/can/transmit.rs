//! Transmit mailboxes. A frame is sent within its control tick or not at all.

use embassy_stm32::pac::can::{Can, regs};
use robot_app::domain::CanFrame;

/// Mailboxes of a bxCAN peripheral (RM0090 32.7.1).
const MAILBOXES: core::ops::Range<usize> = 0..3;

/// The outcome of frames of earlier ticks.
#[derive(Clone, Copy, Default)]
pub struct Outcomes {
    pub sent: u32,
    /// Aborted because their tick was over. One that was being sent at that moment may count as sent later.
    pub expired: u32,
}

/// Every mailbox was still occupied.
pub struct MailboxesFull;

/// Collects the outcome of earlier frames and aborts those that still wait.
///
/// It does not wait: the hardware drops a waiting frame at once and finishes a frame that is being sent.
pub fn retire_old_frames(can: Can) -> Outcomes {
    let status = can.tsr().read();
    let mut outcomes = Outcomes::default();
    let mut command = regs::Tsr(0);
    for mailbox in MAILBOXES {
        if status.rqcp(mailbox) {
            command.set_rqcp(mailbox, true);
            outcomes.sent = outcomes.sent.wrapping_add(u32::from(status.txok(mailbox)));
        }
        // Counted now: the next frame in this mailbox clears the flags of the aborted one.
        if !status.tme(mailbox) {
            command.set_abrq(mailbox, true);
            outcomes.expired = outcomes.expired.wrapping_add(1);
        }
    }
    can.tsr().write_value(command);
    outcomes
}

/// Puts a frame into a free mailbox. The hardware sends waiting frames in the order of their identifiers.
pub fn send(can: Can, frame: &CanFrame) -> Result<(), MailboxesFull> {
    let status = can.tsr().read();
    let mailbox = MAILBOXES
        .into_iter()
        .find(|&mailbox| status.tme(mailbox))
        .ok_or(MailboxesFull)?;
    let [d0, d1, d2, d3, d4, d5, d6, d7] = frame.padded_payload();
    let registers = can.tx(mailbox);
    // A CAN frame holds at most 8 bytes, so the length fits.
    registers
        .tdtr()
        .write(|w| w.set_dlc(frame.payload().len() as u8));
    registers
        .tdlr()
        .write_value(regs::Tdlr(u32::from_le_bytes([d0, d1, d2, d3])));
    registers
        .tdhr()
        .write_value(regs::Tdhr(u32::from_le_bytes([d4, d5, d6, d7])));
    registers.tir().write(|w| {
        w.set_stid(frame.id().raw());
        w.set_txrq(true);
    });
    Ok(())
}

/// Whether a mailbox is free.
pub fn has_room(can: Can) -> bool {
    let status = can.tsr().read();
    MAILBOXES.into_iter().any(|mailbox| status.tme(mailbox))
}
