//! The image's defmt frames as text.

use defmt_decoder::{Encoding, Table};
use robot_plant::time::Ps;

use super::{LogLine, MachineError};

/// Collects bytes into frames and decodes them with the image's string table.
pub struct DefmtLog {
    table: Table,
    frame: Vec<u8>,
    lines: Vec<LogLine>,
}

impl DefmtLog {
    /// `None` for an image that does not log.
    pub fn new(elf: &[u8]) -> Result<Option<Self>, MachineError> {
        let table = Table::parse(elf).map_err(|e| MachineError::Log(format!("{e:#}")))?;
        let Some(table) = table else { return Ok(None) };
        if table.encoding() != Encoding::Rzcobs {
            return Err(MachineError::Log(
                "defmt frames are not rzcobs-encoded".to_owned(),
            ));
        }
        Ok(Some(Self {
            table,
            frame: Vec::new(),
            lines: Vec::new(),
        }))
    }

    pub fn received(&mut self, bytes: &[u8], at: Ps) {
        const END_OF_FRAME: u8 = 0;
        for &byte in bytes {
            self.frame.push(byte);
            if byte == END_OF_FRAME {
                let frame = std::mem::take(&mut self.frame);
                // The encoder also terminates the empty data before its first frame.
                if frame.len() > 1 {
                    self.decode(&frame, at);
                }
            }
        }
    }

    fn decode(&mut self, frame: &[u8], at: Ps) {
        let mut decoder = self.table.new_stream_decoder();
        decoder.received(frame);
        let line = match decoder.decode() {
            Ok(frame) => LogLine {
                at,
                level: frame
                    .level()
                    .map_or("println", |level| level.as_str())
                    .to_owned(),
                text: frame.display_message().to_string(),
            },
            Err(_) => LogLine {
                at,
                level: "error".to_owned(),
                text: "a log frame is damaged".to_owned(),
            },
        };
        self.lines.push(line);
    }

    pub fn take(&mut self) -> Vec<LogLine> {
        std::mem::take(&mut self.lines)
    }
}
