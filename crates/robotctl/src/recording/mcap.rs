//! Reads samples from the firmware's diagnostics in a `run.mcap`, which are JSON in the topic `/diag`.

use mcap::MessageStream;
use nalgebra::Vector3;
use serde_json::Value;

use super::sample::{Sample, Sensor};

/// A recording cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum McapError {
    #[error(transparent)]
    Format(#[from] mcap::McapError),
    #[error(transparent)]
    Message(#[from] serde_json::Error),
}

const TOPIC: &str = "/diag";
const NS_A_SECOND: f64 = 1e9;

/// Returns each new measurement once, because the recorder repeats the last one until the next comes.
pub(super) fn samples(bytes: &[u8], sensor: Sensor) -> Result<Vec<Sample>, McapError> {
    let mut samples: Vec<Sample> = Vec::new();
    for message in MessageStream::new(bytes)? {
        let message = message?;
        if message.channel.topic != TOPIC {
            continue;
        }
        let json: Value = serde_json::from_slice(&message.data)?;
        let Some(value) = vector(json.pointer(sensor.diagnostics_field())) else {
            continue;
        };
        let t_s = message.log_time as f64 / NS_A_SECOND;
        // All zero stands for "not measured yet".
        if value != Vector3::zeros() && samples.last().is_none_or(|last| last.value != value) {
            samples.push(Sample { t_s, value });
        }
    }
    Ok(samples)
}

fn vector(json: Option<&Value>) -> Option<Vector3<f64>> {
    let [x, y, z] = json?.as_array()?.as_slice() else {
        return None;
    };
    Some(Vector3::new(x.as_f64()?, y.as_f64()?, z.as_f64()?))
}

#[cfg(test)]
mod tests {
    use std::{collections::BTreeMap, io::Cursor};

    use mcap::{WriteOptions, records::MessageHeader};

    use super::*;

    /// Returns a recording of messages (topic, time in ms, JSON), which the format's own library writes.
    fn recording(messages: &[(&str, u64, &str)]) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let options = WriteOptions::new().compression(None);
        let mut writer = options.create(&mut bytes).unwrap();
        for (sequence, (topic, at_ms, json)) in messages.iter().enumerate() {
            let channel_id = writer
                .add_channel(0, topic, "json", &BTreeMap::new())
                .unwrap();
            let time = at_ms * 1_000_000;
            let header = MessageHeader {
                channel_id,
                sequence: sequence as u32,
                log_time: time,
                publish_time: time,
            };
            writer
                .write_to_known_channel(&header, json.as_bytes())
                .unwrap();
        }
        writer.finish().unwrap();
        drop(writer);
        bytes.into_inner()
    }

    #[test]
    fn each_new_measurement_is_read_once_with_its_time() {
        let file = recording(&[
            ("/diag", 10, r#"{"sensors":{"mag":{"mag_ut":[0,0,0]}}}"#),
            ("/truth", 20, r#"{"sensors":{"mag":{"mag_ut":[9,9,9]}}}"#),
            (
                "/diag",
                20,
                r#"{"sensors":{"mag":{"mag_ut":[20,-1.5,-40]}}}"#,
            ),
            (
                "/diag",
                30,
                r#"{"sensors":{"mag":{"mag_ut":[20,-1.5,-40]}}}"#,
            ),
            (
                "/diag",
                40,
                r#"{"sensors":{"mag":{"mag_ut":[21,-1.5,-40]}}}"#,
            ),
            (
                "/diag",
                50,
                r#"{"sensors":{"imu":{"accel_mps2":[0,0,9.81]}}}"#,
            ),
        ]);
        let found = samples(&file, Sensor::Magnetometer).unwrap();
        let at = |t_s, x| Sample {
            t_s,
            value: Vector3::new(x, -1.5, -40.0),
        };
        assert_eq!(found, [at(0.02, 20.0), at(0.04, 21.0)]);
    }

    #[test]
    fn a_file_that_is_no_recording_is_refused() {
        assert!(samples(b"t,ax,ay,az\n", Sensor::Accelerometer).is_err());
    }
}
