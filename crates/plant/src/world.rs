//! The whole world as the board sees it: one object, advanced in time, with one method a wire.

mod advance;
mod board_wires;
mod can_buses;
mod joint_wires;
mod scenario;
mod signals;
mod tuning_replies;

use crate::{
    bmi088::{Bmi088, MotionSource},
    body::{Body, Legs, Tilt},
    can_adapter::CanAdapter,
    complaint::Complaint,
    faults::ActiveFaults,
    ist8310::Ist8310,
    joints::{self, JOINTS, Joint, WireState},
    m3508::C620,
    mounting::Mounting,
    radio::Receiver,
    random::{Random, Stream},
    recording::Playback,
    supply::Battery,
    time::{Ps, US, to_seconds},
};
use tuning_replies::TuningReplies;

pub use crate::joints::JointKind;

/// Mechanics and analogue signals move on this grid; a command takes effect at its next point.
pub(crate) const PHYSICS_STEP: Ps = 250 * US;

pub(crate) const STANDARD_GRAVITY_MPS2: f64 = 9.80665;

pub(crate) fn physics_step_s() -> f64 {
    to_seconds(PHYSICS_STEP)
}

/// Which robot stands around the board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlantKind {
    /// Body fixed, wheels in the air.
    #[default]
    Stand,
    /// Upright body rolling on flat ground.
    Rolling,
}

/// Which radio is plugged into the DBUS connector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RadioKind {
    #[default]
    Sbus,
    Dbus,
}

#[derive(Clone, Debug, Default)]
pub struct WorldConfig {
    pub plant: PlantKind,
    pub radio: RadioKind,
    pub joints: JointKind,
    /// What somebody has set as the RS00's CAN time-out; 0 = off, as shipped.
    pub rs00_timeout: Ps,
    pub seed: u64,
    /// A recorded trial (`<trial>.json` beside its `.f32.gz`) played through the IMU and magnetometer models.
    pub imu_trial: Option<std::path::PathBuf>,
    /// Package of the IMU at power-on, °C; unset, the board has been on before and is at 40 °C.
    pub imu_temperature_c: Option<f64>,
    /// The board in the robot.
    pub mounting: Mounting,
    /// The magnetometer on the board, as if the IMU's axes were the robot's: nobody has proven how it sits.
    pub mag_mounting: Mounting,
}

#[derive(Debug, thiserror::Error)]
pub enum WorldError {
    #[error("no fault is named `{0}`; `cargo xtask sim --list-faults` lists them")]
    UnknownFault(String),
    #[error("cannot read the recorded trial {path}: {why}")]
    Trial {
        path: std::path::PathBuf,
        why: String,
    },
}

/// Sticks and switches of the pilot; an unset field keeps its value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RemoteInput {
    pub enable: Option<bool>,
    pub e_stop: Option<bool>,
    /// −1 … 1, forward positive.
    pub vx: Option<f64>,
    /// −1 … 1, left turn (counter-clockwise from above) positive.
    pub wz: Option<f64>,
    /// Three-position switch: 0, 1, 2.
    pub mode: Option<u8>,
    /// Left stick, −1 … 1, right positive.
    pub left_x: Option<f64>,
    /// Left stick, −1 … 1, up positive.
    pub left_y: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
pub struct FaultInfo {
    pub name: &'static str,
    pub what: &'static str,
}

/// A value that changed on a wire, at the instant it changed.
#[derive(Clone, Copy, Debug)]
pub struct WireEvent {
    pub at: Ps,
    /// Index into `World::signal_names`.
    pub signal: usize,
    pub value: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpiSelect {
    Accel,
    Gyro,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanBusId {
    Can1,
    Can2,
}

/// What the board drives beside its buses.
#[derive(Clone, Copy, Debug, Default)]
struct Indicators {
    /// Blue, green, red, 0 … 1.
    leds_bgr: [f64; 3],
    /// 0 = silent.
    buzzer_hz: f64,
}

pub struct World {
    now: Ps,
    next_step: Ps,
    body: Body,
    tilt: Tilt,
    /// Left, right.
    escs: [C620; 2],
    joints: [Joint; JOINTS],
    /// What the wire events have told so far.
    joints_told: [WireState; JOINTS],
    legs: Legs,
    /// CAN1, CAN2.
    adapters: [CanAdapter; 2],
    tuning_replies: TuningReplies,
    battery: Battery,
    imu: Bmi088,
    mag: Ist8310,
    mounting: Mounting,
    mag_mounting: Mounting,
    radio: Receiver,
    playback: Option<Playback>,
    indicators: Indicators,
    faults: ActiveFaults,
    board_supply: bool,
    signal_names: Vec<String>,
    wire_events: Vec<WireEvent>,
    complaints: Vec<Complaint>,
}

impl World {
    /// Everything powered on at time 0, sticks centred, switches off.
    pub fn new(config: WorldConfig) -> Result<Self, WorldError> {
        let playback = match &config.imu_trial {
            Some(path) => Some(Playback::open(path)?),
            None => None,
        };
        let source = match playback {
            Some(_) => MotionSource::Recording,
            None => MotionSource::Physics,
        };
        let seed = config.seed;
        Ok(Self {
            now: 0,
            next_step: PHYSICS_STEP,
            body: Body::new(config.plant),
            tilt: Tilt::default(),
            escs: [
                C620::new(1, Random::new(seed, Stream::LeftMotor)),
                C620::new(2, Random::new(seed, Stream::RightMotor)),
            ],
            joints: joints::drives(config.joints, config.rs00_timeout),
            joints_told: Default::default(),
            legs: Legs::default(),
            adapters: Default::default(),
            tuning_replies: TuningReplies::default(),
            battery: Battery::default(),
            imu: Bmi088::new(seed, source, config.imu_temperature_c),
            mag: Ist8310::new(seed, source),
            mounting: config.mounting,
            mag_mounting: config.mag_mounting,
            radio: Receiver::new(config.radio, seed),
            signal_names: signals::names(playback.is_some()),
            playback,
            indicators: Indicators::default(),
            faults: ActiveFaults::default(),
            board_supply: true,
            wire_events: Vec::new(),
            complaints: Vec::new(),
        })
    }
}
