//! What the pilot does, and what befalls the robot: it stands up, stands, drives, stops, and is pushed.

use std::collections::HashMap;

use robot_plant::{
    time::{MS, Ps},
    world::{PlantKind, Push, RemoteInput, World, WorldConfig, WorldError},
};

/// Something that happens to the world.
pub enum Event {
    Pilot(RemoteInput),
    Push(Push),
}

impl Event {
    pub fn happen(&self, world: &mut World) {
        match self {
            Self::Pilot(input) => world.set_remote(*input),
            Self::Push(push) => world.push(*push),
        }
    }
}

/// The robot stands from here on.
pub const STANDS_AT: Ps = 5_500 * MS;
const DRIVES_AT: Ps = 6_000 * MS;
const STOPS_AT: Ps = 7_000 * MS;
const PUSHED_AT: Ps = 8_500 * MS;
pub const ENDS_AT: Ps = 10_500 * MS;
/// Moments are kept this often.
const MOMENT: Ps = 10 * MS;

/// When the moment of this number is.
pub fn moment_at(number: usize) -> Ps {
    (number as Ps + 1) * MOMENT
}

/// What is true of the robot at some time.
pub struct Moment(HashMap<&'static str, f64>);

const SIGNALS: [&str; 6] = [
    "truth.body.x",
    "truth.body.vx",
    "truth.body.z",
    "truth.body.roll",
    "truth.body.pitch",
    "truth.body.yaw",
];

impl Moment {
    pub fn of(world: &World) -> Self {
        let signals = SIGNALS.map(|name| (name, world.signal(name).expect(name)));
        Self(signals.into_iter().collect())
    }

    pub fn get(&self, signal: &str) -> f64 {
        self.0[signal]
    }
}

pub fn world() -> Result<World, WorldError> {
    World::new(config())
}

pub fn config() -> WorldConfig {
    WorldConfig {
        plant: PlantKind::Free,
        seed: 7,
        ..WorldConfig::default()
    }
}

/// In the order of time.
pub fn events() -> [(Ps, Event); 5] {
    let pilot = RemoteInput::default;
    let enable = Some(true);
    let stand = Some(true);
    let [drive, stop] = [0.4, 0.0].map(Some);
    [
        (2_500 * MS, Event::Pilot(RemoteInput { enable, ..pilot() })),
        (3_000 * MS, Event::Pilot(RemoteInput { stand, ..pilot() })),
        (
            DRIVES_AT,
            Event::Pilot(RemoteInput {
                vx: drive,
                ..pilot()
            }),
        ),
        (
            STOPS_AT,
            Event::Pilot(RemoteInput {
                vx: stop,
                ..pilot()
            }),
        ),
        (PUSHED_AT, Event::Push(Push::instant([4.0, 0.0, 0.0]))),
    ]
}
