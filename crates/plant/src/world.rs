//! The whole world as the board sees it: one object, advanced in time, with one method per wire.

mod advance;
mod askew;
mod board_wires;
mod can_buses;
mod joint_wires;
mod power_on;
mod push;
mod scenario;
mod signals;
mod tuning_replies;

use crate::{
    bmi088::Bmi088,
    body::Body,
    can_adapter::CanAdapter,
    complaint::Complaint,
    faults::ActiveFaults,
    free,
    ist8310::Ist8310,
    joints::{JOINTS, Joint, WireState},
    m3508::C620,
    mounting::Mounting,
    pc::Pc,
    radio::Receiver,
    recording::{Playback, TrialError},
    robots,
    serial_adapter::SerialAdapter,
    supply::Battery,
    time::Ps,
    wire::CanFrame,
};
use askew::Askew;
use can_buses::Node;
use robot_description::{JointMotor, Robot};
use std::{collections::VecDeque, sync::Arc};
use tuning_replies::TuningReplies;

pub use push::Push;
pub use signals::Probe;

pub use crate::{
    body::{PlantKind, Variation},
    faults::FaultInfo,
    free::{Start, Terrain},
    pc::{PcDrive, PcInput, PcJoints},
    radio::{RadioKind, RemoteInput},
    wire::{CanBusId, SpiSelect},
};

/// What stands around the board.
#[derive(Clone, Debug)]
pub struct WorldConfig {
    /// Body and wheels.
    pub plant: PlantKind,
    /// The radio receiver.
    pub radio: RadioKind,
    /// The robot: its motors with their numbers and senses, the board's place, and the masses of the free robot.
    pub robot: Arc<Robot>,
    /// CAN time-out that somebody has set in the RS00 joints; 0 is off, as shipped.
    pub rs00_timeout: Ps,
    /// Seed of all noise: the same seed gives the same world.
    pub seed: u64,
    /// A recorded trial (`<trial>.json` beside its `.f32.gz`) that plays through the IMU and magnetometer models.
    pub imu_trial: Option<std::path::PathBuf>,
    /// Temperature of the IMU's package at power-on, °C. Unset, the board was on before and is at 40 °C.
    pub imu_temperature_c: Option<f64>,
    /// How the board sits in the robot. Unset, as the robot's file says.
    pub mounting: Option<Mounting>,
    /// How the magnetometer sits on the board, relative to the IMU's axes, which no public source proves.
    pub mag_mounting: Mounting,
    /// The ground under the free robot.
    pub terrain: Terrain,
    /// How the free robot lies or stands at power-on.
    pub start: Start,
    /// How the free robot differs from its file.
    pub variation: Variation,
}

impl Default for WorldConfig {
    /// A robot of `robots/fivebar.toml` on a stand.
    fn default() -> Self {
        Self {
            plant: PlantKind::default(),
            radio: RadioKind::default(),
            robot: robots::with_joints(JointMotor::Dm4310),
            rs00_timeout: 0,
            seed: 0,
            imu_trial: None,
            imu_temperature_c: None,
            mounting: None,
            mag_mounting: Mounting::default(),
            terrain: Terrain::default(),
            start: Start::default(),
            variation: Variation::default(),
        }
    }
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
    /// Brightness of blue, green and red, 0 … 1.
    leds_bgr: [f64; 3],
    /// Frequency; 0 while silent.
    buzzer_hz: f64,
}

/// Robot, motors, sensors, radio and PC around one board.
///
/// Every method that takes `now` first advances the world to it.
///
/// ```
/// use robot_plant::{
///     time::{MS, US},
///     wire::CanFrame,
///     world::{CanBusId, World, WorldConfig},
/// };
///
/// let mut world = World::new(WorldConfig::default()).expect("no recording to load");
///
/// // Half of the full current for the left C620, node 0 of CAN1, in bytes 0 and 1 of 0x200.
/// let command = CanFrame::with_data(0x200, [0x20, 0, 0, 0, 0, 0, 0, 0]);
/// world.can_received(CanBusId::Can1, 0, &command, 10 * MS);
/// world.advance(100 * MS);
/// assert_eq!(world.signal("can.m3508.0.current_ma"), Some(10_000.0));
/// assert!(world.signal("truth.wheel.0.speed_rps") > Some(10.0));
///
/// // The C620 feeds back once a millisecond under 0x201.
/// let feedback = world.can_pending(CanBusId::Can1, 0, 100 * MS + 500 * US);
/// assert_eq!(feedback.map(|frame| frame.id), Some(0x201));
/// ```
#[derive(Clone)]
pub struct World {
    now: Ps,
    next_step: Ps,
    body: Body,
    robot: Arc<Robot>,
    variation: Variation,
    /// Commands that the variation delays, with the time at which their motor hears them.
    late: VecDeque<(Ps, Node, CanFrame)>,
    /// The present push and its end.
    push: Option<(free::Push, Ps)>,
    /// On CAN1 and CAN2, the board's own node left out.
    nodes: [Vec<Node>; 2],
    /// Left, right wheel.
    escs: [C620; 2],
    joints: [Joint; JOINTS],
    /// State of each joint as the last wire events reported it.
    joints_reported: [WireState; JOINTS],
    /// CAN1, CAN2.
    adapters: [CanAdapter; 2],
    /// Of the PC at the 4-pin UART2.
    serial_adapter: SerialAdapter,
    tuning_replies: TuningReplies,
    battery: Battery,
    imu: Bmi088,
    mag: Ist8310,
    mounting: Mounting,
    askew: Askew,
    mag_mounting: Mounting,
    radio: Receiver,
    pc: Pc,
    playback: Option<Playback>,
    indicators: Indicators,
    faults: ActiveFaults,
    board_supply: bool,
    signal_names: Vec<String>,
    wire_events: Vec<WireEvent>,
    complaints: Vec<Complaint>,
}
