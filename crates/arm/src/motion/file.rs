//! Motions as JSON and as MCAP, which Foxglove and PlotJuggler show.

use std::{
    collections::BTreeMap,
    fs::{self, File},
    io::{BufWriter, Cursor},
    path::Path,
};

use mcap::{MessageStream, WriteOptions, records::MessageHeader};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::{Motion, MotionError, Sample};

const TOPIC: &str = "/joints";

/// A message of the topic.
#[derive(Serialize, Deserialize)]
struct Message {
    time_s: f64,
    steps: BTreeMap<String, i32>,
}

impl Motion {
    /// Reads a file; its ending, `.json` or `.mcap`, says what it is.
    pub fn load(path: &Path) -> Result<Self, MotionError> {
        let bytes = fs::read(path).map_err(|source| MotionError::Read {
            path: path.to_owned(),
            source,
        })?;
        let read = match ending(path)? {
            Ending::Json => serde_json::from_slice(&bytes).map_err(|source| MotionError::Json {
                path: path.to_owned(),
                source,
            })?,
            Ending::Mcap => read_mcap(&bytes, path)?,
        };
        // What was read is put together again, which checks it.
        checked(read).map_err(|source| MotionError::Content {
            path: path.to_owned(),
            source: Box::new(source),
        })
    }

    /// Writes a file; its ending, `.json` or `.mcap`, says what it is.
    pub fn save(&self, path: &Path) -> Result<(), MotionError> {
        let failed = |source| MotionError::Write {
            path: path.to_owned(),
            source,
        };
        match ending(path)? {
            Ending::Json => {
                let text = serde_json::to_vec(self).map_err(|error| failed(error.into()))?;
                fs::write(path, text).map_err(failed)
            }
            Ending::Mcap => {
                let file = File::create(path).map_err(failed)?;
                write_mcap(self, file).map_err(|source| MotionError::Mcap {
                    path: path.to_owned(),
                    source,
                })
            }
        }
    }
}

enum Ending {
    Json,
    Mcap,
}

fn ending(path: &Path) -> Result<Ending, MotionError> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    match ending.map(str::to_ascii_lowercase).as_deref() {
        Some("json") => Ok(Ending::Json),
        Some("mcap") => Ok(Ending::Mcap),
        _ => Err(MotionError::Ending {
            path: path.to_owned(),
        }),
    }
}

fn checked(read: Motion) -> Result<Motion, MotionError> {
    let mut motion = Motion::new(read.joints);
    for sample in read.samples {
        motion.push(sample)?;
    }
    if motion.samples.is_empty() {
        return Err(MotionError::Empty);
    }
    Ok(motion)
}

fn write_mcap(motion: &Motion, file: File) -> Result<(), mcap::McapError> {
    let options = WriteOptions::new()
        .compression(None)
        .library(concat!("armctl ", env!("CARGO_PKG_VERSION")));
    let mut writer = options.create(BufWriter::new(file))?;
    let number = json!({ "type": "integer" });
    let steps: BTreeMap<&str, _> = motion
        .joints
        .iter()
        .map(|j| (j.as_str(), &number))
        .collect();
    let schema = json!({
        "type": "object",
        "properties": {
            "time_s": { "type": "number" },
            "steps": { "type": "object", "properties": steps },
        },
    });
    let schema = writer.add_schema(
        "robot_arm.JointSteps",
        "jsonschema",
        schema.to_string().as_bytes(),
    )?;
    let channel_id = writer.add_channel(schema, TOPIC, "json", &BTreeMap::new())?;
    for (sequence, sample) in (0..).zip(&motion.samples) {
        let steps = motion
            .joints
            .iter()
            .cloned()
            .zip(sample.steps.iter().copied());
        let message = Message {
            time_s: sample.time_s,
            steps: steps.collect(),
        };
        let data =
            serde_json::to_vec(&message).map_err(|e| std::io::Error::other(e.to_string()))?;
        // A conversion of floats that cannot fail: it ends at the integer's limits.
        let time_ns = (sample.time_s * 1e9) as u64;
        let header = MessageHeader {
            channel_id,
            sequence,
            log_time: time_ns,
            publish_time: time_ns,
        };
        writer.write_to_known_channel(&header, &data)?;
    }
    writer.finish()?;
    Ok(())
}

fn read_mcap(bytes: &[u8], path: &Path) -> Result<Motion, MotionError> {
    let failed = |source| MotionError::Mcap {
        path: path.to_owned(),
        source,
    };
    let mut joints: Vec<String> = Vec::new();
    let mut samples = Vec::new();
    for message in MessageStream::new(Cursor::new(bytes).into_inner()).map_err(failed)? {
        let message = message.map_err(failed)?;
        if message.channel.topic != TOPIC {
            continue;
        }
        let Message { time_s, mut steps } =
            serde_json::from_slice(&message.data).map_err(|source| MotionError::Json {
                path: path.to_owned(),
                source,
            })?;
        if joints.is_empty() {
            joints = steps.keys().cloned().collect();
        }
        let number = samples.len() + 1;
        let of = |joint: &String| {
            steps.remove(joint).ok_or_else(|| MotionError::Joint {
                number,
                joint: joint.clone(),
            })
        };
        let steps = joints.iter().map(of).collect::<Result<_, _>>()?;
        samples.push(Sample { time_s, steps });
    }
    Ok(Motion { joints, samples })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion() -> Motion {
        let mut motion = Motion::new(vec!["a".to_owned(), "b".to_owned()]);
        for (time_s, a) in [(0.0, 2048), (0.02, 2050), (0.04, -3)] {
            let steps = vec![a, 100];
            motion.push(Sample { time_s, steps }).unwrap();
        }
        motion
    }

    fn file(name: &str) -> std::path::PathBuf {
        std::env::temp_dir().join(format!("robot-arm-{}-{name}", std::process::id()))
    }

    #[test]
    fn a_motion_is_the_same_after_both_kinds_of_file() {
        for name in ["motion.json", "motion.mcap"] {
            let path = file(name);
            motion().save(&path).unwrap();
            assert_eq!(Motion::load(&path).unwrap(), motion(), "{name}");
            fs::remove_file(path).unwrap();
        }
        assert!(matches!(
            motion().save(&file("motion.csv")),
            Err(MotionError::Ending { .. })
        ));
    }

    #[test]
    fn what_is_no_motion_is_refused_with_its_place() {
        let path = file("bad.json");
        for (text, said) in [
            (r#"{"joints": ["a"], "samples": []}"#, "no sample"),
            (
                r#"{"joints": ["a"], "samples": [{"time_s": 0, "steps": [1, 2]}]}"#,
                "sample 1 has 2 positions for 1 joints",
            ),
            (
                r#"{"joints": ["a"], "samples": [{"time_s": 1, "steps": [1]}, {"time_s": 0, "steps": [1]}]}"#,
                "sample 2 is at 0 s",
            ),
            (
                r#"{"joints": ["a"], "samples": [{"time_s": 0, "steps": [9999999999]}]}"#,
                "is no recorded motion",
            ),
            ("{", "is no recorded motion"),
        ] {
            fs::write(&path, text).unwrap();
            let error = Motion::load(&path).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
        fs::remove_file(path).unwrap();
    }
}
