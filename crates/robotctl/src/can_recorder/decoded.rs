//! What the motors of this robot say in their frames, in the motors' own coordinates.

use std::collections::BTreeMap;

use robot_app::{
    domain::{CanFrame, MotorCurrent},
    motor::{
        layout::{JointMotor, MotorLayout, ROBOT_LAYOUT, RS00_LAYOUT},
        m3508::{self, EscId},
    },
    tuning::JOINTS,
};
use serde_json::{Value, json};

use crate::mcap_file::{McapFile, McapFileError, Topic};

const ROTOR_COUNTS: f64 = 8192.0;
const ESC_COUNTS: f64 = 16_384.0;
const MA_IN_A: f64 = 1000.0;

/// Adds a topic for each motor that is heard.
#[derive(Default)]
pub(super) struct Decoder {
    topics: BTreeMap<String, Topic>,
}

impl Decoder {
    pub fn write(
        &mut self,
        file: &mut McapFile,
        frame: &CanFrame,
        time_ns: u64,
    ) -> Result<(), McapFileError> {
        let Some((name, message)) = decode(frame) else {
            return Ok(());
        };
        let topic = match self.topics.get(&name) {
            Some(topic) => *topic,
            None => {
                let topic = file.add_topic(&name, schema_name(&name), &schema(&message))?;
                self.topics.insert(name, topic);
                topic
            }
        };
        file.write(topic, time_ns, &message)
    }
}

fn schema_name(topic: &str) -> &'static str {
    match topic {
        "/esc/command" => "jiling.EscCommand",
        _ if topic.starts_with("/esc/") => "jiling.EscFeedback",
        _ => "jiling.JointFeedback",
    }
}

/// All values are numbers.
fn schema(message: &Value) -> Value {
    let fields = message.as_object().into_iter().flatten();
    let fields: serde_json::Map<String, Value> = fields
        .map(|(name, _)| (name.clone(), json!({ "type": "number" })))
        .collect();
    json!({ "type": "object", "properties": fields })
}

/// Returns the topic and the message, or `None` for a frame of anything else.
fn decode(frame: &CanFrame) -> Option<(String, Value)> {
    esc_feedback(frame)
        .or_else(|| esc_command(frame))
        .or_else(|| joint(frame, &ROBOT_LAYOUT))
        .or_else(|| joint(frame, &RS00_LAYOUT))
}

fn esc_feedback(frame: &CanFrame) -> Option<(String, Value)> {
    let number = (1..=4)
        .find(|number| EscId::new(*number).is_some_and(|esc| esc.feedback_id() == frame.id()))?;
    let feedback = m3508::decode_feedback(frame, 0)?;
    let message = json!({
        "rotor_deg": f64::from(feedback.rotor_angle) * 360.0 / ROTOR_COUNTS,
        "rotor_rpm": feedback.rpm,
        "current_a": f64::from(feedback.current_ma) / MA_IN_A,
        "temperature_c": feedback.temperature_c,
    });
    Some((format!("/esc/{number}"), message))
}

fn esc_command(frame: &CanFrame) -> Option<(String, Value)> {
    if frame.id() != m3508::COMMAND_ID {
        return None;
    }
    let bytes = frame.full_payload()?;
    let mut message = serde_json::Map::new();
    for (number, counts) in (1..).zip(bytes.chunks_exact(2)) {
        let counts = i16::from_be_bytes([counts[0], counts[1]]);
        let current_ma = f64::from(counts) / ESC_COUNTS * f64::from(MotorCurrent::FULL_SCALE_MA);
        message.insert(format!("current_{number}_a"), json!(current_ma / MA_IN_A));
    }
    Some(("/esc/command".to_owned(), message.into()))
}

fn joint(frame: &CanFrame, layout: &MotorLayout) -> Option<(String, Value)> {
    for (name, slot) in JOINTS.iter().zip(layout.joints()) {
        let (motion, temperature_c) = match &slot.motor {
            JointMotor::Dm4310(motor) => match motor.decode(frame) {
                Some(feedback) => (feedback.motion, f64::from(feedback.winding_c)),
                None => continue,
            },
            JointMotor::Rs00(motor) => match motor.decode(frame) {
                Some(feedback) => (feedback.motion, f64::from(feedback.temperature_c)),
                None => continue,
            },
        };
        let message = json!({
            "angle_rad": motion.pos_rad,
            "speed_rps": motion.vel_rps,
            "torque_nm": motion.torque_nm,
            "temperature_c": temperature_c,
        });
        return Some((format!("/joint/{name}"), message));
    }
    None
}
