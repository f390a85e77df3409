//! The world at time 0.

use std::collections::VecDeque;

use super::{
    Indicators, World, WorldConfig, WorldError, askew::Askew, can_buses, signals,
    tuning_replies::TuningReplies,
};
use crate::{
    bmi088::Bmi088,
    body::{Body, PlantKind},
    faults::ActiveFaults,
    free::FreeSetup,
    ist8310::Ist8310,
    joints,
    m3508::C620,
    motion::MotionSource,
    mounting::Mounting,
    pc::Pc,
    physics::PHYSICS_STEP,
    radio::Receiver,
    random::{Random, Stream},
    recording::Playback,
    serial_adapter::SerialAdapter,
    supply::Battery,
};

impl World {
    /// Everything is powered on at time 0, with sticks centred and switches off.
    ///
    /// # Errors
    /// The recorded trial cannot be read.
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
        let robot = config.robot;
        let setup = FreeSetup {
            variation: config.variation.body,
            start: config.start,
            terrain: config.terrain,
            ..FreeSetup::default()
        };
        let [left, right] = robot.wheels.escs;
        Ok(Self {
            now: 0,
            next_step: PHYSICS_STEP,
            body: Body::new(config.plant, &robot, &setup),
            escs: [
                C620::new(left, &robot.wheels, Random::new(seed, Stream::LeftMotor)),
                C620::new(right, &robot.wheels, Random::new(seed, Stream::RightMotor)),
            ],
            joints: joints::drives(&robot.joints, config.rs00_timeout),
            joints_reported: Default::default(),
            adapters: Default::default(),
            serial_adapter: SerialAdapter::default(),
            tuning_replies: TuningReplies::default(),
            battery: Battery::default(),
            imu: Bmi088::new(seed, source, config.imu_temperature_c),
            mag: Ist8310::new(seed, source),
            askew: Askew::new(config.variation.imu_rad),
            mounting: config.mounting.unwrap_or_else(|| Mounting::of(&robot.imu)),
            mag_mounting: config.mag_mounting,
            radio: Receiver::new(config.radio, seed),
            pc: Pc::new(seed),
            nodes: can_buses::nodes(&robot),
            robot,
            variation: config.variation,
            late: VecDeque::new(),
            push: None,
            signal_names: signals::names(signals::Extra {
                recording: playback.is_some(),
                free: config.plant == PlantKind::Free,
            }),
            playback,
            indicators: Indicators::default(),
            faults: ActiveFaults::default(),
            board_supply: true,
            wire_events: Vec::new(),
            complaints: Vec::new(),
        })
    }
}
