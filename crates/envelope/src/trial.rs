//! One run of the robot: the pilot's moves, and what is seen of it.

use robot_app::safety::SafetyFlags;
use robot_host_loop::Robot;
use robot_plant::world::{PlantKind, Probe, Push, RemoteInput, Start, Terrain, World, WorldConfig};

use crate::Robots;

/// The pilot arms at this time, when sensors are calibrated and motors set up.
pub(crate) const ENABLE_AT_S: f64 = 3.0;
/// The pilot asks for standing up at this time.
pub(crate) const STAND_AT_S: f64 = 3.3;
/// A robot that stands by now may be given a task.
pub(crate) const READY_AT_S: f64 = 7.0;
/// A body tilted by more has fallen, rad.
const FALLEN_RAD: f64 = 1.0;
/// Samples are kept each so many ticks.
const KEEP_EVERY: u64 = 5;

/// Why a run did not end well.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Time in the run, s.
    pub at_s: f64,
    /// What happened.
    pub what: String,
}

/// What is seen of the robot in one tick. Pairs are left, right.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// Time since power-on, s.
    pub t_s: f64,
    /// East, north and up of the hip centre, m.
    pub place_m: [f64; 3],
    /// Roll, pitch and yaw, rad.
    pub rpy_rad: [f64; 3],
    /// Forward speed of the body, m/s.
    pub forward_mps: f64,
    /// Turn rate, rad/s.
    pub yaw_rps: f64,
    /// Leg lengths, m.
    pub leg_m: [f64; 2],
    /// Force of the ground on body and links, N.
    pub body_n: f64,
    /// Torques of the wheels, N·m.
    pub wheel_nm: [f64; 2],
}

impl Sample {
    /// Angle between the body's z axis and the vertical, rad.
    pub fn tilt_rad(&self) -> f64 {
        let [roll, pitch, _] = self.rpy_rad;
        (roll.cos() * pitch.cos()).clamp(-1.0, 1.0).acos()
    }
}

/// The signals of a [`Sample`], found once.
struct Probes {
    place: [Probe; 3],
    rpy: [Probe; 3],
    forward: Probe,
    yaw: Probe,
    leg: [Probe; 2],
    body: Probe,
    torque: [Probe; 2],
}

impl Probes {
    fn new(world: &World) -> Self {
        let find = |name: &str| world.probe(name).expect(name);
        Self {
            place: ["truth.body.x", "truth.body.y", "truth.body.z"].map(find),
            rpy: ["truth.body.roll", "truth.body.pitch", "truth.body.yaw"].map(find),
            forward: find("truth.body.vx"),
            yaw: find("truth.body.wz"),
            leg: ["truth.leg.0.length_m", "truth.leg.1.length_m"].map(find),
            body: find("truth.body.contact_n"),
            torque: ["truth.wheel.0.torque_nm", "truth.wheel.1.torque_nm"].map(find),
        }
    }

    fn read(&self, robot: &Robot) -> Sample {
        let world = robot.world();
        Sample {
            t_s: robot.seconds(),
            place_m: self.place.map(|probe| probe.read(world)),
            rpy_rad: self.rpy.map(|probe| probe.read(world)),
            forward_mps: self.forward.read(world),
            yaw_rps: self.yaw.read(world),
            leg_m: self.leg.map(|probe| probe.read(world)),
            body_n: self.body.read(world),
            wheel_nm: self.torque.map(|probe| probe.read(world)),
        }
    }
}

/// A run under way.
pub(crate) struct Trial {
    robot: Robot,
    probes: Probes,
    mass_kg: f64,
    now: Sample,
    kept: Vec<Sample>,
    ticks: u64,
    /// What stopped the robot when it was last disarmed.
    stopped_by: SafetyFlags,
    was_armed: bool,
}

impl Trial {
    /// Switches on specimen `seed`, which lies or stands as `start` says.
    ///
    /// # Panics
    /// A sensor does not answer, or this program was not built with the robot's file.
    pub fn new(robots: &Robots, seed: u64, terrain: Terrain, start: Start) -> Self {
        let world = WorldConfig {
            plant: PlantKind::Free,
            robot: robots.robot.clone(),
            seed,
            terrain,
            start,
            variation: robots.variation(seed),
            ..WorldConfig::default()
        };
        let robot = Robot::in_world(world, robots.settings()).expect("no recording to load");
        let probes = Probes::new(robot.world());
        let now = probes.read(&robot);
        Self {
            robot,
            probes,
            mass_kg: robots.mass_kg(seed),
            now,
            kept: Vec::new(),
            ticks: 0,
            stopped_by: SafetyFlags::NONE,
            was_armed: false,
        }
    }

    /// A robot that sat and has stood up.
    ///
    /// # Errors
    /// It does not stand.
    pub fn standing(
        robots: &Robots,
        seed: u64,
        terrain: Terrain,
    ) -> Result<Self, Box<(Failure, Self)>> {
        let mut trial = Self::new(robots, seed, terrain, Start::Sitting);
        trial.ask_to_stand();
        trial.run_until(READY_AT_S);
        match trial.require_upright() {
            Ok(()) => Ok(trial),
            Err(failure) => Err(Box::new((failure, trial))),
        }
    }

    /// Arms and asks for standing up, at the times for that.
    pub fn ask_to_stand(&mut self) {
        self.run_until(ENABLE_AT_S);
        self.enable();
        self.run_until(STAND_AT_S);
        self.stand();
    }

    /// Asks for standing up and then arms, as a robot that lies may be armed only for that.
    pub fn ask_to_get_up(&mut self) {
        self.run_until(ENABLE_AT_S);
        self.stand();
        self.run_until(STAND_AT_S);
        self.enable();
    }

    fn enable(&mut self) {
        self.pilot(RemoteInput {
            enable: Some(true),
            ..RemoteInput::default()
        });
    }

    fn stand(&mut self) {
        self.pilot(RemoteInput {
            stand: Some(true),
            ..RemoteInput::default()
        });
    }

    /// Puts the stand switch down.
    pub fn ask_to_sit(&mut self) {
        self.pilot(RemoteInput {
            stand: Some(false),
            ..RemoteInput::default()
        });
    }

    /// Moves sticks and switches.
    pub fn pilot(&mut self, input: RemoteInput) {
        self.robot.remote(input);
    }

    /// Moves the drive sticks, −1 … 1.
    pub fn sticks(&mut self, forward: f64, left: f64) {
        self.pilot(RemoteInput {
            vx: Some(forward),
            wz: Some(left),
            ..RemoteInput::default()
        });
    }

    /// Pushes the robot in one instant so that its speed changes by this: forward, left, up, m/s.
    pub fn push(&mut self, change_mps: [f64; 3]) {
        let impulse_ns = change_mps.map(|mps| mps * self.mass_kg);
        self.robot.world_mut().push(Push::instant(impulse_ns));
    }

    /// Runs until `t_s` after power-on.
    pub fn run_until(&mut self, t_s: f64) {
        self.watch_until(t_s, |_| ());
    }

    /// Runs until `t_s` after power-on, and shows each tick to `look`.
    pub fn watch_until(&mut self, t_s: f64, mut look: impl FnMut(&Sample)) {
        let Self {
            robot,
            probes,
            now,
            kept,
            ticks,
            stopped_by,
            was_armed,
            ..
        } = self;
        robot.run_until(t_s, |robot| {
            *now = probes.read(robot);
            if ticks.is_multiple_of(KEEP_EVERY) {
                kept.push(*now);
            }
            *ticks += 1;
            if *was_armed && !robot.armed() {
                *stopped_by = robot.diagnostics().safety.flags;
            }
            *was_armed = robot.armed();
            look(now);
        });
    }

    /// Runs for another `seconds` and shows each tick to `look`.
    pub fn watch(&mut self, seconds: f64, look: impl FnMut(&Sample)) {
        self.watch_until(self.now.t_s + seconds, look);
    }

    /// The robot as of now.
    pub fn now(&self) -> &Sample {
        &self.now
    }

    /// The robot with its firmware.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The samples kept, each 5 ms.
    pub fn kept(&self) -> &[Sample] {
        &self.kept
    }

    /// Fails if the robot does not stand on its wheels now.
    ///
    /// # Errors
    /// Why it does not.
    pub fn require_upright(&self) -> Result<(), Failure> {
        let now = &self.now;
        if !self.robot.armed() {
            return Err(self.failed(self.stopped_by()));
        }
        if now.tilt_rad() > FALLEN_RAD {
            return Err(self.failed(format!("tilted by {:.0}°", now.tilt_rad().to_degrees())));
        }
        if now.body_n > 0.0 {
            return Err(self.failed("the body is on the ground".to_owned()));
        }
        Ok(())
    }

    /// What stopped the robot when it was last disarmed, in words.
    pub fn stopped_by(&self) -> String {
        let names: Vec<_> = self.stopped_by.names().collect();
        format!("stopped by {}", names.join(", "))
    }

    /// A failure as of now.
    pub fn failed(&self, what: String) -> Failure {
        Failure {
            at_s: self.now.t_s,
            what,
        }
    }
}
