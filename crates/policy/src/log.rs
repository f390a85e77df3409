//! The log of a run as MCAP, for Foxglove and PlotJuggler.

use std::path::Path;

use robotctl::mcap_file::{McapFile, McapFileError, Topic};

use crate::{
    PolicyDescription,
    messages::{Entry, Messages},
};

/// Writes a log. It is complete only after [`finish`](Self::finish).
pub struct Log {
    file: McapFile,
    messages: Messages,
    topics: Vec<Topic>,
}

impl Log {
    /// Creates the file, or empties it if it exists.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn create(path: &Path, policy: &PolicyDescription) -> Result<Self, McapFileError> {
        let messages = Messages::new(policy);
        let mut file = McapFile::create(path)?;
        let topics = messages.topics().iter();
        let topics = topics.map(|it| file.add_topic(it.name, it.schema_name, &it.schema));
        Ok(Self {
            topics: topics.collect::<Result<_, _>>()?,
            file,
            messages,
        })
    }

    /// Writes a cycle.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, entry: &Entry<'_>) -> Result<(), McapFileError> {
        let time_ns = (entry.time_s.max(0.0) * 1e9) as u64;
        for (topic, message) in self.messages.of(entry) {
            self.file.write(self.topics[topic], time_ns, &message)?;
        }
        Ok(())
    }

    /// Writes the index and the end.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self) -> Result<(), McapFileError> {
        self.file.finish()
    }
}

#[cfg(test)]
mod tests;
