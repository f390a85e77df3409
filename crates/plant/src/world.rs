//! The whole world as the board sees it: one object, advanced in time, with one method per wire.

mod advance;
mod board_wires;
mod can_buses;
mod joint_wires;
mod power_on;
mod scenario;
mod signals;
mod tuning_replies;

use crate::{
    bmi088::Bmi088,
    body::{Body, Legs, Tilt},
    can_adapter::CanAdapter,
    complaint::Complaint,
    faults::ActiveFaults,
    ist8310::Ist8310,
    joints::{JOINTS, Joint, WireState},
    m3508::C620,
    mounting::Mounting,
    radio::Receiver,
    recording::{Playback, TrialError},
    supply::Battery,
    time::Ps,
};
use tuning_replies::TuningReplies;

pub use crate::{
    body::PlantKind,
    faults::FaultInfo,
    joints::JointKind,
    radio::{RadioKind, RemoteInput},
    wire::{CanBusId, SpiSelect},
};

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

/// Why the world cannot be made or changed.
#[derive(Debug, thiserror::Error)]
pub enum WorldError {
    /// A scenario names a fault that does not exist.
    #[error("no fault is named `{0}`; `cargo xtask sim --list-faults` lists them")]
    UnknownFault(String),
    /// The recorded trial cannot be read.
    #[error(transparent)]
    Trial(#[from] TrialError),
}

/// A value that changed on a wire, at the instant it changed.
#[derive(Clone, Copy, Debug)]
pub struct WireEvent {
    /// When it changed.
    pub at: Ps,
    /// Index into [`World::signal_names`].
    pub signal: usize,
    /// The new value, in the unit of the signal.
    pub value: f64,
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
    /// State of each joint as the last wire events reported it.
    joints_reported: [WireState; JOINTS],
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
