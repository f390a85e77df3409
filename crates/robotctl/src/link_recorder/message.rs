//! The messages of a recording, and their schemas.

use std::fmt;

use robot_app::{
    link::{Keys, MotorState, Sticks, Uplink},
    tuning::JOINTS,
};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use super::LinkSummary;

/// The lowest code of the battery's voltage, which also stands for "not measured".
const NOT_MEASURED_V: f32 = 20.0;

/// One state frame.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct State {
    /// The robot's time, as on the recording's axis.
    pub time_s: f64,
    pub armed: bool,
    /// The mode chosen on the radio; `None` if the radio is lost.
    pub mode: Option<Mode>,
    /// `None` if it is not measured.
    pub battery_v: Option<f32>,
    pub mcu_c: i8,
    pub accel_mps2: [f32; 3],
    pub gyro_rps: [f32; 3],
    pub attitude: Attitude,
    pub wheels: Wheels,
    pub joints: Joints,
    pub radio: Radio,
}

/// The mode of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    Manual,
    Pc,
    Custom,
}

/// Body to world. The angles are those about z, then y, then x.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Attitude {
    pub q_xyzw: [f32; 4],
    pub roll_deg: f32,
    pub pitch_deg: f32,
    pub yaw_deg: f32,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Motor {
    pub angle_rad: f32,
    pub speed_rps: f32,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Wheels<T = Motor> {
    pub left: T,
    pub right: T,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Joints<T = Motor> {
    pub left_front: T,
    pub left_rear: T,
    pub right_front: T,
    pub right_rear: T,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Radio {
    pub lost: bool,
    pub enable: bool,
    pub estop: bool,
    pub dead_man: bool,
    /// All keys as they came.
    pub keys: u16,
    pub lx: f32,
    pub ly: f32,
    pub rx: f32,
    pub ry: f32,
    pub l2: f32,
}

impl State {
    pub(super) fn new(state: &Uplink, time_s: f64) -> Self {
        let [left, right, left_front, left_rear, right_front, right_rear] =
            state.motors.map(Motor::new);
        let keys = state.keys;
        Self {
            time_s,
            armed: keys.contains(Keys::F1),
            mode: Mode::chosen(keys),
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

impl Mode {
    /// Returns the mode chosen on the radio; `None` if the radio is lost.
    pub fn chosen(keys: Keys) -> Option<Self> {
        let modes = [
            (Keys::A, Self::Manual),
            (Keys::B, Self::Pc),
            (Keys::X, Self::Custom),
        ];
        let chosen = modes.into_iter().find(|(key, _)| keys.contains(*key));
        chosen.map(|(_, mode)| mode)
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Manual => "manual",
            Self::Pc => "PC",
            Self::Custom => "custom",
        })
    }
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
    /// Returns the attitude of a quaternion with w first.
    pub fn of_wxyz([w, x, y, z]: [f32; 4]) -> Self {
        Self::new([x, y, z, w])
    }

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
pub fn transform(q_xyzw: [f32; 4], time_ns: u64) -> Value {
    const NS: u64 = 1_000_000_000;
    let [x, y, z, w] = q_xyzw;
    json!({
        "timestamp": { "sec": time_ns / NS, "nsec": time_ns % NS },
        "parent_frame_id": "world",
        "child_frame_id": "body",
        "translation": { "x": 0.0, "y": 0.0, "z": 0.0 },
        "rotation": { "x": x, "y": y, "z": z, "w": w },
    })
}

/// The link's counters since the first good frame.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub struct LinkCounters {
    pub states: u64,
    pub crc_errors: u32,
    pub resyncs: u32,
    pub discarded_bytes: u32,
    pub implausible: u64,
    pub gaps: u64,
}

impl LinkCounters {
    pub(super) fn new(summary: &LinkSummary) -> Self {
        Self {
            states: summary.states,
            crc_errors: summary.counters.crc_errors,
            resyncs: summary.counters.resyncs,
            discarded_bytes: summary.counters.discarded_bytes,
            implausible: summary.implausible,
            gaps: summary.gaps,
        }
    }
}

/// A time without state frames, which ends with the message's time.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Gap {
    pub seconds: f64,
    /// The robot has restarted, so its length is not known.
    pub restarted: bool,
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
