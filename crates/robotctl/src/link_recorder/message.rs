//! The messages of a recording, and their schemas.

use robot_app::{
    link::{Keys, MotorState, Sticks, Uplink},
    tuning::JOINTS,
};
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::LinkSummary;

/// The lowest code of the battery's voltage, which also stands for "not measured".
const NOT_MEASURED_V: f32 = 20.0;

/// One state frame.
#[derive(Serialize)]
pub(super) struct State {
    time_s: f64,
    armed: bool,
    mode: Option<&'static str>,
    battery_v: Option<f32>,
    mcu_c: i8,
    accel_mps2: [f32; 3],
    gyro_rps: [f32; 3],
    attitude: Attitude,
    wheels: Wheels,
    joints: Joints,
    radio: Radio,
}

#[derive(Serialize)]
struct Attitude {
    q_xyzw: [f32; 4],
    roll_deg: f32,
    pitch_deg: f32,
    yaw_deg: f32,
}

#[derive(Serialize)]
struct Motor {
    angle_rad: f32,
    speed_rps: f32,
}

#[derive(Serialize)]
struct Wheels {
    left: Motor,
    right: Motor,
}

#[derive(Serialize)]
struct Joints {
    left_front: Motor,
    left_rear: Motor,
    right_front: Motor,
    right_rear: Motor,
}

#[derive(Serialize)]
struct Radio {
    lost: bool,
    enable: bool,
    estop: bool,
    dead_man: bool,
    keys: u16,
    lx: f32,
    ly: f32,
    rx: f32,
    ry: f32,
    l2: f32,
}

impl State {
    pub fn new(state: &Uplink, time_s: f64) -> Self {
        let [left, right, left_front, left_rear, right_front, right_rear] =
            state.motors.map(Motor::new);
        let keys = state.keys;
        Self {
            time_s,
            armed: keys.contains(Keys::F1),
            mode: mode(keys),
            battery_v: (state.battery_v > NOT_MEASURED_V).then_some(state.battery_v),
            mcu_c: state.mcu_c,
            accel_mps2: state.accel_mps2,
            gyro_rps: state.gyro_rps,
            attitude: Attitude::new(state.q_xyzw),
            wheels: Wheels { left, right },
            joints: Joints {
                left_front,
                left_rear,
                right_front,
                right_rear,
            },
            radio: Radio::new(keys, state.sticks),
        }
    }
}

/// Returns the mode chosen on the radio; `None` if the radio is lost.
pub(super) fn mode(keys: Keys) -> Option<&'static str> {
    let modes = [(Keys::A, "manual"), (Keys::B, "pc"), (Keys::X, "custom")];
    let chosen = modes.into_iter().find(|(key, _)| keys.contains(*key));
    chosen.map(|(_, name)| name)
}

impl Motor {
    fn new(motor: MotorState) -> Self {
        Self {
            angle_rad: motor.pos_rad,
            speed_rps: motor.vel_rps,
        }
    }
}

impl Attitude {
    fn new(q_xyzw: [f32; 4]) -> Self {
        let [x, y, z, w] = q_xyzw;
        let roll = (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y));
        let pitch = (2.0 * (w * y - z * x)).clamp(-1.0, 1.0).asin();
        let yaw = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
        Self {
            q_xyzw,
            roll_deg: roll.to_degrees(),
            pitch_deg: pitch.to_degrees(),
            yaw_deg: yaw.to_degrees(),
        }
    }
}

impl Radio {
    fn new(keys: Keys, sticks: Sticks) -> Self {
        let Sticks { lx, rx, ly, l2, ry } = sticks;
        Self {
            lost: keys.contains(Keys::F2),
            enable: keys.contains(Keys::START),
            estop: keys.contains(Keys::SELECT),
            dead_man: keys.contains(Keys::Y),
            keys: keys.bits(),
            lx,
            ly,
            rx,
            ry,
            l2,
        }
    }
}

/// Returns the body's attitude as `foxglove.FrameTransform`.
pub(super) fn transform(state: &Uplink, time_ns: u64) -> Value {
    const NS: u64 = 1_000_000_000;
    let [x, y, z, w] = state.q_xyzw;
    json!({
        "timestamp": { "sec": time_ns / NS, "nsec": time_ns % NS },
        "parent_frame_id": "world",
        "child_frame_id": "body",
        "translation": { "x": 0.0, "y": 0.0, "z": 0.0 },
        "rotation": { "x": x, "y": y, "z": z, "w": w },
    })
}

/// Returns the link's counters.
pub(super) fn link(summary: &LinkSummary) -> Value {
    json!({
        "states": summary.states,
        "crc_errors": summary.counters.crc_errors,
        "resyncs": summary.counters.resyncs,
        "discarded_bytes": summary.counters.discarded_bytes,
        "implausible": summary.implausible,
        "gaps": summary.gaps,
    })
}

fn object(fields: &[(&str, Value)]) -> Value {
    let fields = fields
        .iter()
        .map(|(name, schema)| ((*name).to_owned(), schema.clone()));
    json!({ "type": "object", "properties": fields.collect::<Map<_, _>>() })
}

fn numbers(names: &[&str]) -> Value {
    let fields: Vec<_> = names
        .iter()
        .map(|name| (*name, json!({ "type": "number" })))
        .collect();
    object(&fields)
}

pub(super) fn state_schema() -> Value {
    let number = || json!({ "type": "number" });
    let flag = || json!({ "type": "boolean" });
    let vector = || json!({ "type": "array", "items": { "type": "number" } });
    let motor = || numbers(&["angle_rad", "speed_rps"]);
    let joints = JOINTS.map(|name| (name.replace('-', "_"), motor()));
    let joints: Vec<_> = joints
        .iter()
        .map(|(name, schema)| (name.as_str(), schema.clone()))
        .collect();
    let attitude = [
        ("q_xyzw", vector()),
        ("roll_deg", number()),
        ("pitch_deg", number()),
        ("yaw_deg", number()),
    ];
    let flags = ["lost", "enable", "estop", "dead_man"].map(|name| (name, flag()));
    let sticks = ["keys", "lx", "ly", "rx", "ry", "l2"].map(|name| (name, number()));
    object(&[
        ("time_s", number()),
        ("armed", flag()),
        ("mode", json!({ "type": "string" })),
        ("battery_v", number()),
        ("mcu_c", number()),
        ("accel_mps2", vector()),
        ("gyro_rps", vector()),
        ("attitude", object(&attitude)),
        ("wheels", object(&[("left", motor()), ("right", motor())])),
        ("joints", object(&joints)),
        ("radio", object(&[&flags[..], &sticks[..]].concat())),
    ])
}

pub(super) fn link_schema() -> Value {
    numbers(&[
        "states",
        "crc_errors",
        "resyncs",
        "discarded_bytes",
        "implausible",
        "gaps",
    ])
}

pub(super) fn gap_schema() -> Value {
    object(&[
        ("seconds", json!({ "type": "number" })),
        ("restarted", json!({ "type": "boolean" })),
    ])
}

pub(super) fn transform_schema() -> Value {
    let whole = || json!({ "type": "integer" });
    let text = || json!({ "type": "string" });
    let time = json!({
        "type": "object",
        "title": "time",
        "properties": { "sec": whole(), "nsec": whole() },
    });
    object(&[
        ("timestamp", time),
        ("parent_frame_id", text()),
        ("child_frame_id", text()),
        ("translation", numbers(&["x", "y", "z"])),
        ("rotation", numbers(&["x", "y", "z", "w"])),
    ])
}
