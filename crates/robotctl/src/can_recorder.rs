//! Records all frames of a CAN bus, and what the motors report in them, as MCAP.

mod decoded;

use std::{collections::BTreeMap, path::Path, time::Duration};

use robot_app::domain::CanFrame;
use serde::Serialize;
use serde_json::json;

use crate::mcap_file::{McapFile, McapFileError, Topic};
use decoded::Decoder;

/// Bits of a data frame without its payload, with the space after it.
const FRAME_BITS: u32 = 47;
/// Stuff bits make a frame longer by about this factor.
const STUFFING: f64 = 1.1;
const BITS_A_SECOND: f64 = 1e6;

/// A frame as the recording has it.
#[derive(Serialize)]
struct Message<'a> {
    id: u16,
    data: &'a [u8],
    /// In the notation of `candump`: `201#1FFFFE0C`.
    text: String,
}

/// Writes the frames of a bus to a file.
pub struct CanRecorder {
    file: McapFile,
    frames: Topic,
    decoder: Decoder,
    summary: CanSummary,
    first_ns: Option<u64>,
    last_ns: u64,
}

/// What was recorded.
#[derive(Clone, Debug, Default)]
pub struct CanSummary {
    pub frames: u64,
    /// Number of frames of each identifier.
    pub of_id: BTreeMap<u16, u64>,
    pub duration: Duration,
    pub longest_gap: Duration,
    bits: u64,
}

impl CanSummary {
    pub fn rate_hz(&self) -> f64 {
        self.frames as f64 / self.duration.as_secs_f64().max(1e-9)
    }

    /// Returns the share of time, of 1, in which the bus was busy at 1 Mbit/s. It is an estimate, because the number of
    /// stuff bits is not known.
    pub fn load(&self) -> f64 {
        let busy_s = self.bits as f64 * STUFFING / BITS_A_SECOND;
        busy_s / self.duration.as_secs_f64().max(1e-9)
    }
}

impl CanRecorder {
    pub fn create(path: &Path) -> Result<Self, McapFileError> {
        let mut file = McapFile::create(path)?;
        let schema = json!({
            "type": "object",
            "properties": {
                "id": { "type": "integer" },
                "data": { "type": "array", "items": { "type": "integer" } },
                "text": { "type": "string" },
            },
        });
        let frames = file.add_topic("/can", "jiling.CanFrame", &schema)?;
        Ok(Self {
            file,
            frames,
            decoder: Decoder::default(),
            summary: CanSummary::default(),
            first_ns: None,
            last_ns: 0,
        })
    }

    /// Records a frame that arrived at this time, in ns since 1970.
    pub fn add(&mut self, frame: &CanFrame, time_ns: u64) -> Result<(), McapFileError> {
        self.count(frame, time_ns);
        let hex: String = frame.payload().iter().map(|b| format!("{b:02X}")).collect();
        let id = frame.id().raw();
        let message = Message {
            id,
            data: frame.payload(),
            text: format!("{id:03X}#{hex}"),
        };
        self.file.write(self.frames, time_ns, &message)?;
        self.decoder.write(&mut self.file, frame, time_ns)
    }

    fn count(&mut self, frame: &CanFrame, time_ns: u64) {
        let summary = &mut self.summary;
        let first_ns = *self.first_ns.get_or_insert(time_ns);
        if summary.frames > 0 {
            let gap = Duration::from_nanos(time_ns.saturating_sub(self.last_ns));
            summary.longest_gap = summary.longest_gap.max(gap);
        }
        self.last_ns = time_ns;
        summary.frames += 1;
        *summary.of_id.entry(frame.id().raw()).or_default() += 1;
        summary.bits += u64::from(FRAME_BITS) + 8 * frame.payload().len() as u64;
        summary.duration = Duration::from_nanos(time_ns.saturating_sub(first_ns));
    }

    pub fn summary(&self) -> &CanSummary {
        &self.summary
    }

    /// Completes the file.
    pub fn finish(self) -> Result<CanSummary, McapFileError> {
        self.file.finish()?;
        Ok(self.summary)
    }
}

#[cfg(test)]
mod tests;
