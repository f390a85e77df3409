//! What happened on the bus so far.

/// Counters since the bus was opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Statistics {
    /// Requests, those sent again included.
    pub sent: u64,
    /// Answers that were taken.
    pub answered: u64,
    /// Requests that were sent again.
    pub retried: u64,
    /// Frames with a wrong checksum, or a status that no servo has.
    pub damaged: u64,
    /// Frames of servos that were not asked.
    pub alien: u64,
    /// Frames of a servo that was asked, with another length than asked for; late answers are among them.
    pub other_length: u64,
    /// Copies of the host's own requests, which some adapters return.
    pub echoes: u64,
    /// Bytes that belonged to no frame, or came when nothing was asked.
    pub stray_bytes: u64,
    /// Answers that did not come in time.
    pub missing: u64,
    /// Questions that had no answer after all tries.
    pub lost: u64,
}
