//! Writes an event as MCAP. Its time is that of the recorded run; units and names are those of `robotctl record`.

use std::path::Path;

use robot_app::black_box::{BalanceSample, BlackBoxSample};
use serde::Serialize;
use serde_json::{Value, json};

use super::{
    event::RecordedEvent,
    json::summary,
    names::{bus_name, mode_name, phase_name, request_name, source_name, state_name},
};
use crate::{
    link_recorder::{Attitude, Joints, Wheels, transform},
    mcap_file::{McapFile, McapFileError},
};

/// Topic of the samples.
pub const SAMPLE_TOPIC: &str = "/blackbox";
/// Topic of the one message that says what happened, at the time of the event.
pub const EVENT_TOPIC: &str = "/blackbox/event";
const TRANSFORM_TOPIC: &str = "/tf";
const NS_A_SECOND: f64 = 1e9;

/// Writes a file, or replaces it if it exists.
pub fn write(event: &RecordedEvent, path: &Path) -> Result<(), McapFileError> {
    let mut file = McapFile::create(path)?;
    // Any object: the messages name their fields.
    let object = json!({ "type": "object" });
    let samples = file.add_topic(SAMPLE_TOPIC, "jiling.BlackBox", &sample_schema())?;
    let events = file.add_topic(EVENT_TOPIC, "jiling.BlackBoxEvent", &object)?;
    let transforms = file.add_topic(TRANSFORM_TOPIC, "foxglove.FrameTransform", &object)?;
    let mut is_told = false;
    for sample in &event.samples {
        if !is_told && sample.time >= event.event.time {
            is_told = true;
            file.write(events, nanoseconds(event.seconds()), &summary(event))?;
        }
        let time_ns = nanoseconds(sample.seconds());
        file.write(samples, time_ns, &Message::of(sample, event))?;
        let [w, x, y, z] = sample.q_wxyz;
        file.write(transforms, time_ns, &transform([x, y, z, w], time_ns))?;
    }
    file.finish()
}

fn nanoseconds(seconds: f64) -> u64 {
    (seconds * NS_A_SECOND).round() as u64
}

#[derive(Serialize)]
struct Message {
    time_s: f64,
    /// Time after the event; it is negative before.
    after_s: f64,
    armed: bool,
    enable: bool,
    mode: &'static str,
    source: &'static str,
    drive: f32,
    turn: f32,
    command_age_ms: u8,
    radio_age_ms: u8,
    /// `None` if it is not measured.
    battery_v: Option<f32>,
    accel_mps2: [f32; 3],
    gyro_rps: [f32; 3],
    attitude: Attitude,
    attitude_valid: bool,
    wheels: Wheels<Wheel>,
    joints: Joints<Joint>,
    flags: Vec<&'static str>,
    flag_bits: u32,
    can1: &'static str,
    can2: &'static str,
    missed_ticks_mod_16: u8,
    /// `None` if the firmware was older than this.
    balance: Option<Balance>,
}

#[derive(Serialize)]
struct Balance {
    state: &'static str,
    request: &'static str,
    phase: &'static str,
    airborne: bool,
    slipping: bool,
    left: Leg,
    right: Leg,
}

#[derive(Serialize)]
struct Leg {
    length_m: f32,
    lean_rad: f32,
    contact_n: f32,
}

impl Balance {
    fn of(sample: &BalanceSample) -> Self {
        let status = &sample.status;
        let [left, right] = [0, 1].map(|leg: usize| Leg {
            length_m: status.leg_m[leg],
            lean_rad: status.lean_rad[leg],
            contact_n: status.contact_n[leg],
        });
        Self {
            state: state_name(status.state),
            request: request_name(sample.stand),
            phase: phase_name(status.phase),
            airborne: status.airborne,
            slipping: status.slipping,
            left,
            right,
        }
    }
}

#[derive(Serialize)]
struct Wheel {
    speed_rps: f32,
    sent_a: f32,
    measured_a: f32,
}

#[derive(Serialize)]
struct Joint {
    angle_rad: f32,
    torque_nm: f32,
}

impl Message {
    fn of(sample: &BlackBoxSample, event: &RecordedEvent) -> Self {
        let [left, right] = [0, 1].map(|wheel: usize| Wheel {
            speed_rps: sample.wheel_rps[wheel],
            sent_a: sample.sent_ma[wheel] / 1e3,
            measured_a: sample.measured_ma[wheel] / 1e3,
        });
        let [left_front, left_rear, right_front, right_rear] =
            [0, 1, 2, 3].map(|joint: usize| Joint {
                angle_rad: sample.joint_rad[joint],
                torque_nm: sample.joint_nm[joint],
            });
        Self {
            time_s: sample.seconds(),
            after_s: event.after_s(sample),
            armed: sample.armed,
            enable: sample.enabled,
            mode: mode_name(sample),
            source: source_name(sample),
            drive: sample.drive,
            turn: sample.turn,
            command_age_ms: sample.command_age_ms,
            radio_age_ms: sample.radio_age_ms,
            battery_v: (sample.battery_v > 0.0).then_some(sample.battery_v),
            accel_mps2: sample.accel_mps2,
            gyro_rps: sample.gyro_dps.map(f32::to_radians),
            attitude: Attitude::of_wxyz(sample.q_wxyz),
            attitude_valid: sample.estimate_valid,
            wheels: Wheels { left, right },
            joints: Joints {
                left_front,
                left_rear,
                right_front,
                right_rear,
            },
            flags: sample.flags.names().collect(),
            flag_bits: sample.flags.bits(),
            can1: bus_name(sample.can[0]),
            can2: bus_name(sample.can[1]),
            missed_ticks_mod_16: sample.missed_ticks,
            balance: sample.balance.as_ref().map(Balance::of),
        }
    }
}

fn sample_schema() -> Value {
    let number = || json!({ "type": "number" });
    let vector = || json!({ "type": "array", "items": { "type": "number" } });
    let of = |names: &[&str], schema: Value| {
        let fields = names
            .iter()
            .map(|name| ((*name).to_owned(), schema.clone()));
        json!({ "type": "object", "properties": fields.collect::<serde_json::Map<_, _>>() })
    };
    let wheel = of(&["speed_rps", "sent_a", "measured_a"], number());
    let joint = of(&["angle_rad", "torque_nm"], number());
    let leg = || of(&["length_m", "lean_rad", "contact_n"], number());
    json!({
        "type": "object",
        "properties": {
            "time_s": number(),
            "after_s": number(),
            "armed": { "type": "boolean" },
            "enable": { "type": "boolean" },
            "mode": { "type": "string" },
            "source": { "type": "string" },
            "drive": number(),
            "turn": number(),
            "command_age_ms": number(),
            "radio_age_ms": number(),
            "battery_v": number(),
            "accel_mps2": vector(),
            "gyro_rps": vector(),
            "attitude": {
                "type": "object",
                "properties": {
                    "q_xyzw": vector(),
                    "roll_deg": number(),
                    "pitch_deg": number(),
                    "yaw_deg": number(),
                },
            },
            "attitude_valid": { "type": "boolean" },
            "wheels": of(&["left", "right"], wheel),
            "joints": of(&["left_front", "left_rear", "right_front", "right_rear"], joint),
            "flags": { "type": "array", "items": { "type": "string" } },
            "flag_bits": number(),
            "can1": { "type": "string" },
            "can2": { "type": "string" },
            "missed_ticks_mod_16": number(),
            "balance": {
                "type": "object",
                "properties": {
                    "state": { "type": "string" },
                    "request": { "type": "string" },
                    "phase": { "type": "string" },
                    "airborne": { "type": "boolean" },
                    "slipping": { "type": "boolean" },
                    "left": leg(),
                    "right": leg(),
                },
            },
        },
    })
}
