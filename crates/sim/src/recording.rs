//! `run.mcap`: every signal at 100 Hz, the firmware's log and the free robot's shape, as JSON with schemas, for Foxglove and
//! PlotJuggler.

mod scene;

use std::{
    collections::BTreeMap,
    fs::File,
    io::BufWriter,
    path::{Path, PathBuf},
    sync::Arc,
};

use mcap::{McapError, WriteOptions, Writer, records::MessageHeader};
use robot_description::Robot;
use robot_plant::{
    time::{MS, NS, Ps, SECOND},
    world::Terrain,
};
use serde::Serialize;
use serde_json::{Value, json};

use super::{
    runner::Observer,
    signals::{SignalTable, Values},
    tree::Tree,
};
use crate::machine::LogLine;
use scene::{SHAPES_PERIOD, Scene};

const PERIOD: Ps = 10 * MS;

#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    #[error("cannot write {path}: {source}")]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("cannot write the recording: {0}")]
    Mcap(#[from] McapError),
}

/// One topic for each first part of the signals' names: `/truth`, `/can`, `/radio`, `/diag`, `/emu`.
struct Topic {
    channel: u16,
    tree: Tree,
}

pub struct Recording {
    writer: Writer<BufWriter<File>>,
    topics: Vec<Topic>,
    /// What the robot is drawn from.
    robot: (Arc<Robot>, Terrain),
    /// Channels of transforms and shapes.
    scene: Option<(Scene, [u16; 2])>,
    log_channel: Option<u16>,
    sequence: u32,
    /// The first error; nothing is written after it.
    failed: Option<McapError>,
}

impl Recording {
    /// A recording of this robot on this ground.
    pub fn create(
        path: &Path,
        robot: Arc<Robot>,
        terrain: Terrain,
    ) -> Result<Self, RecordingError> {
        let file = File::create(path).map_err(|source| RecordingError::File {
            path: path.to_owned(),
            source,
        })?;
        let options = WriteOptions::new()
            .compression(None)
            .library("robot-emulator");
        Ok(Self {
            writer: options.create(BufWriter::new(file))?,
            topics: Vec::new(),
            robot: (robot, terrain),
            scene: None,
            log_channel: None,
            sequence: 0,
            failed: None,
        })
    }

    pub fn finish(mut self) -> Result<(), RecordingError> {
        match self.failed.take() {
            Some(error) => Err(error.into()),
            None => {
                self.writer.finish()?;
                Ok(())
            }
        }
    }

    fn attempt(&mut self, step: impl FnOnce(&mut Self) -> Result<(), McapError>) {
        if self.failed.is_none() {
            self.failed = step(self).err();
        }
    }

    fn add_channel(&mut self, topic: &str, schema: &str, json: &Value) -> Result<u16, McapError> {
        let data = json.to_string();
        let schema = self
            .writer
            .add_schema(schema, "jsonschema", data.as_bytes())?;
        self.writer
            .add_channel(schema, topic, "json", &BTreeMap::new())
    }

    fn open_topics(&mut self, table: &SignalTable) -> Result<(), McapError> {
        let mut groups: BTreeMap<&str, Vec<(&str, usize)>> = BTreeMap::new();
        for (place, name) in table.names().iter().enumerate() {
            let (group, rest) = name.split_once('.').unwrap_or(("signals", name));
            groups.entry(group).or_default().push((rest, place));
        }
        for (group, names) in groups {
            let tree = Tree::new(names.into_iter());
            let schema = format!("robot.{group}");
            let channel = self.add_channel(&format!("/{group}"), &schema, &tree.schema())?;
            self.topics.push(Topic { channel, tree });
        }
        let (robot, terrain) = &self.robot;
        if let Some(scene) = Scene::new(table, robot, *terrain) {
            let transforms = scene::transforms_schema();
            let shapes = scene::shapes_schema();
            let channels = [
                self.add_channel("/tf", "foxglove.FrameTransforms", &transforms)?,
                self.add_channel("/scene", "foxglove.SceneUpdate", &shapes)?,
            ];
            self.scene = Some((scene, channels));
        }
        Ok(())
    }

    fn write(
        &mut self,
        channel_id: u16,
        at: Ps,
        message: &impl Serialize,
    ) -> Result<(), McapError> {
        let header = MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time: at / NS,
            publish_time: at / NS,
        };
        self.sequence += 1;
        // Numbers, texts and string keys: nothing that JSON refuses.
        let data = serde_json::to_vec(message).unwrap_or_default();
        self.writer.write_to_known_channel(&header, &data)
    }

    fn write_sample(&mut self, at: Ps, values: &Values) -> Result<(), McapError> {
        let topics = std::mem::take(&mut self.topics);
        for topic in &topics {
            if topic.tree.has_value(values) {
                self.write(topic.channel, at, &topic.tree.with(values))?;
            }
        }
        self.topics = topics;
        self.write_scene(at, values)
    }

    fn write_scene(&mut self, at: Ps, values: &Values) -> Result<(), McapError> {
        let Some((scene, [transforms, shapes])) = self.scene.take() else {
            return Ok(());
        };
        if at.is_multiple_of(SHAPES_PERIOD) {
            self.write(shapes, at, &scene.shapes(at))?;
        }
        if let Some(message) = scene.transforms(at, values) {
            self.write(transforms, at, &message)?;
        }
        self.scene = Some((scene, [transforms, shapes]));
        Ok(())
    }

    fn write_log(&mut self, line: &LogLine) -> Result<(), McapError> {
        let channel = match self.log_channel {
            Some(channel) => channel,
            None => self.add_channel("/log", "foxglove.Log", &log_schema())?,
        };
        self.log_channel = Some(channel);
        let message = json!({
            "timestamp": { "sec": line.at / SECOND, "nsec": line.at % SECOND / NS },
            "level": foxglove_level(&line.level),
            "message": line.text,
            "name": "firmware",
            "file": "",
            "line": 0,
        });
        self.write(channel, line.at, &message)
    }
}

impl Observer for Recording {
    fn sample(&mut self, at: Ps, table: &SignalTable, values: &Values) {
        if self.topics.is_empty() {
            self.attempt(|r| r.open_topics(table));
        }
        if at.is_multiple_of(PERIOD) {
            self.attempt(|r| r.write_sample(at, values));
        }
    }

    fn log(&mut self, line: &LogLine) {
        self.attempt(|r| r.write_log(line));
    }
}

/// Levels of the `foxglove.Log` schema.
fn foxglove_level(level: &str) -> u8 {
    match level.to_ascii_lowercase().as_str() {
        "trace" | "debug" => 1,
        "info" => 2,
        "warn" => 3,
        "error" => 4,
        _ => 0,
    }
}

fn log_schema() -> Value {
    json!({
        "type": "object",
        "properties": {
            "timestamp": {
                "type": "object",
                "title": "time",
                "properties": { "sec": { "type": "integer" }, "nsec": { "type": "integer" } },
            },
            "level": { "type": "integer" },
            "message": { "type": "string" },
            "name": { "type": "string" },
            "file": { "type": "string" },
            "line": { "type": "integer" },
        },
    })
}
