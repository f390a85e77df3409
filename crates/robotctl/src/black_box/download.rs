//! Downloads events over the tuning channel.

use robot_app::{
    black_box::{BANK_BYTES, BANK_COUNT, LAYOUT_VERSION, LAYOUTS},
    domain::{BankState, EventKind},
    tuning::{BlockFrame, Refusal},
};

use super::event::RecordedEvent;
use crate::tuning::{BankReport, TuningClient, TuningError};

/// Frames of a block. One that is damaged on its way is asked for again as a whole.
const BLOCK_FRAMES: u8 = 253;
const BLOCK_BYTES: usize = BLOCK_FRAMES as usize * BlockFrame::BYTES;
/// Tries for each block.
const TRIES: u32 = 4;

#[derive(Debug, thiserror::Error)]
pub enum DownloadError {
    #[error(transparent)]
    Robot(#[from] TuningError),
    #[error("this firmware has no black box: it is older than this robotctl")]
    TooOld,
    #[error(
        "the black box of this firmware has layout {0}, this robotctl reads layouts up to {LAYOUT_VERSION}: use the robotctl of \
         the firmware's version"
    )]
    OtherLayout(u8),
    #[error(
        "frames of the black box were lost {TRIES} times in a row: another program at the adapter, a busy computer, a slow \
         serial line?"
    )]
    Lost,
    #[error("the event is gone: another program released it, or the robot drove again meanwhile")]
    Gone,
    #[error("the robot accepted the release of the event but still holds it: try again")]
    NotReleased,
    #[error(
        "the event was downloaded, but its checksums are wrong: the robot's memory was damaged"
    )]
    Damaged,
}

/// A bank with an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bank {
    pub index: u8,
    pub kind: EventKind,
    /// Number of the event.
    pub number: u16,
    /// Layout of the bank, one of [`LAYOUTS`].
    pub layout: u8,
    /// The end of the event is still being recorded.
    pub is_closing: bool,
}

/// Returns the banks that hold events, and how many events were overwritten before anybody had released them. The robot
/// may be armed.
pub fn contents(client: &mut TuningClient) -> Result<(Vec<Bank>, u8), DownloadError> {
    let mut banks = Vec::new();
    let mut overwritten = 0;
    for index in 0..BANK_COUNT as u8 {
        let report = client.black_box(index)?.ok_or(DownloadError::TooOld)?;
        let BankReport {
            state,
            kind,
            number,
            bytes,
            layout,
            ..
        } = report;
        if !LAYOUTS.contains(&layout) || bytes != BANK_BYTES {
            return Err(DownloadError::OtherLayout(layout));
        }
        overwritten = report.overwritten;
        if matches!(state, BankState::Event | BankState::Closing) {
            banks.push(Bank {
                index,
                kind,
                number,
                layout,
                is_closing: state == BankState::Closing,
            });
        }
    }
    // The older one first; numbers wrap.
    banks.sort_by(|a, b| a.number.wrapping_sub(b.number).cast_signed().cmp(&0));
    Ok((banks, overwritten))
}

/// Downloads the event of a bank. The robot must be disarmed. `progress` gets the bytes received so far.
pub fn download(
    client: &mut TuningClient,
    bank: Bank,
    mut progress: impl FnMut(usize),
) -> Result<RecordedEvent, DownloadError> {
    let mut bytes = Vec::with_capacity(BANK_BYTES);
    while bytes.len() < BANK_BYTES {
        let block = block(client, bank.index, bytes.len(), &mut progress)?;
        bytes.extend(block);
        progress(bytes.len().min(BANK_BYTES));
    }
    bytes.truncate(BANK_BYTES);
    RecordedEvent::decode(&bytes, bank.layout)
        .filter(|event| event.event.number == bank.number)
        .ok_or(DownloadError::Damaged)
}

fn block(
    client: &mut TuningClient,
    bank: u8,
    at: usize,
    progress: &mut impl FnMut(usize),
) -> Result<Vec<u8>, DownloadError> {
    let left = BANK_BYTES.saturating_sub(at).min(BLOCK_BYTES);
    let count = left.div_ceil(BlockFrame::BYTES);
    for _ in 0..TRIES {
        let mut found = vec![None; count];
        let frames = client.read_block(bank, at as u16, count as u8, |received| {
            progress(BANK_BYTES.min(at + received * BlockFrame::BYTES));
        });
        let frames = frames.map_err(|error| match is_gone(&error) {
            true => DownloadError::Gone,
            false => error.into(),
        })?;
        for frame in frames {
            if let Some(place) = found.get_mut(usize::from(frame.number)) {
                *place = Some(frame.bytes);
            }
        }
        if let Some(all) = found.into_iter().collect::<Option<Vec<_>>>() {
            return Ok(all.concat());
        }
    }
    Err(DownloadError::Lost)
}

/// True if the robot refuses a request because its bank does not hold the event.
pub(super) fn is_gone(error: &TuningError) -> bool {
    matches!(error, TuningError::Refused { reason, .. } if *reason == Ok(Refusal::OutOfRange))
}
