//! Gives an event's bank back to the recorder.

use std::{thread, time::Duration};

use super::download::{Bank, DownloadError, contents, is_gone};
use crate::tuning::TuningClient;

/// How long to wait until a bank is given back.
#[derive(Clone, Copy, Debug)]
pub struct ReleaseTimeouts {
    pub pause: Duration,
    pub looks: u32,
}

impl Default for ReleaseTimeouts {
    /// Waits for a second. The robot takes some 20 ms.
    fn default() -> Self {
        Self {
            pause: Duration::from_millis(20),
            looks: 50,
        }
    }
}

/// Makes the robot forget an event, and waits until it has: whoever asks then does not meet the event again. The robot
/// must be disarmed.
pub fn release(
    client: &mut TuningClient,
    bank: Bank,
    timeouts: ReleaseTimeouts,
) -> Result<(), DownloadError> {
    match client.release_event(bank.index, bank.number) {
        // An earlier request, whose reply was lost, has done it.
        Err(error) if is_gone(&error) => return Ok(()),
        done => done?,
    }
    for _ in 0..timeouts.looks {
        let (banks, _) = contents(client)?;
        let is_same = |left: &Bank| (left.index, left.number) == (bank.index, bank.number);
        if !banks.iter().any(is_same) {
            return Ok(());
        }
        thread::sleep(timeouts.pause);
    }
    Err(DownloadError::NotReleased)
}
