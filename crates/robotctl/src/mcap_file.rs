//! Writes MCAP files of JSON messages, for Foxglove and PlotJuggler.

use std::{
    collections::BTreeMap,
    fs::File,
    io::BufWriter,
    path::{Path, PathBuf},
};

use mcap::{WriteOptions, Writer, records::MessageHeader};
use serde::Serialize;
use serde_json::Value;

#[derive(Debug, thiserror::Error)]
pub enum McapFileError {
    #[error("cannot write {path}")]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("cannot write {path}")]
    Mcap {
        path: PathBuf,
        source: mcap::McapError,
    },
    #[error("cannot write {path}")]
    Message {
        path: PathBuf,
        source: serde_json::Error,
    },
}

/// A topic of one file.
#[derive(Clone, Copy, Debug)]
pub struct Topic {
    channel: u16,
}

/// An MCAP file that is being written. It is complete only after [`finish`](Self::finish).
pub struct McapFile {
    path: PathBuf,
    writer: Writer<BufWriter<File>>,
    sequence: u32,
}

impl McapFile {
    /// Creates the file, or empties it if it exists.
    pub fn create(path: &Path) -> Result<Self, McapFileError> {
        let file = File::create(path).map_err(|source| McapFileError::File {
            path: path.to_owned(),
            source,
        })?;
        let options = WriteOptions::new()
            .compression(None)
            .library(concat!("robotctl ", env!("CARGO_PKG_VERSION")));
        let writer = options.create(BufWriter::new(file));
        Ok(Self {
            path: path.to_owned(),
            writer: writer.map_err(|source| Self::failed(path, source))?,
            sequence: 0,
        })
    }

    /// Adds a topic of JSON messages. `schema` is a JSON Schema, and `schema_name` what viewers know it by, such as
    /// `foxglove.FrameTransform`.
    pub fn add_topic(
        &mut self,
        name: &str,
        schema_name: &str,
        schema: &Value,
    ) -> Result<Topic, McapFileError> {
        let schema = schema.to_string();
        let added = self
            .writer
            .add_schema(schema_name, "jsonschema", schema.as_bytes())
            .and_then(|schema| {
                self.writer
                    .add_channel(schema, name, "json", &BTreeMap::new())
            });
        let channel = added.map_err(|source| Self::failed(&self.path, source))?;
        Ok(Topic { channel })
    }

    /// Writes a message at a time in ns.
    pub fn write(
        &mut self,
        topic: Topic,
        time_ns: u64,
        message: &impl Serialize,
    ) -> Result<(), McapFileError> {
        let data = serde_json::to_vec(message).map_err(|source| McapFileError::Message {
            path: self.path.clone(),
            source,
        })?;
        let header = MessageHeader {
            channel_id: topic.channel,
            sequence: self.sequence,
            log_time: time_ns,
            publish_time: time_ns,
        };
        self.sequence = self.sequence.wrapping_add(1);
        let written = self.writer.write_to_known_channel(&header, &data);
        written.map_err(|source| Self::failed(&self.path, source))
    }

    /// Writes the index and the end.
    pub fn finish(mut self) -> Result<(), McapFileError> {
        let finished = self.writer.finish();
        finished.map_err(|source| Self::failed(&self.path, source))?;
        Ok(())
    }

    fn failed(path: &Path, source: mcap::McapError) -> McapFileError {
        McapFileError::Mcap {
            path: path.to_owned(),
            source,
        }
    }
}
