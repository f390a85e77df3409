//! One robot and its episodes.

use std::path::{Path, PathBuf};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use robot_plant::world::{Push, RemoteInput};
use robot_policy::{
    PolicyDescription,
    action::Decoder,
    limits::{Limits, Stop, TILT_RAD},
    observation::{Commands, Observer},
};

use crate::{
    GymError, Options, Truth,
    draw::{between, draw, start},
    reward::Terms,
    simulated_robot::SimulatedRobot,
    specimen::{Beginning, Specimen},
    wire::Wire,
};

/// A robot that began sitting may touch the ground with its body for so long, s.
const GETS_UP_WITHIN_S: f64 = 1.5;
/// The same for the robot's own controller.
const STANDS_UP_WITHIN_S: f64 = 3.0;
/// In so many of the draws the command is to stand still.
const STANDS_STILL_IN: f64 = 0.15;
/// Greatest product of speed and turn rate that is commanded, m/s²: more slips where friction is low.
const SIDEWAYS_MPS2: f64 = 2.5;
const TICKS_PER_S: f64 = 1e3;

/// What a step led to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// The reward.
    pub reward: f64,
    /// What it is made of.
    pub terms: Terms,
    /// Whether the robot has fallen, or its firmware or the runner's limits stopped it. The episode is over.
    pub fallen: bool,
}

/// A robot that a policy drives, in episodes. Equal seeds and equal actions give equal episodes, bit for bit.
pub struct Environment {
    options: Options,
    numbers: Pcg64Mcg,
    specimen: Specimen,
    episodes_of_robot: u32,
    robot: Box<dyn SimulatedRobot>,
    /// The shipped image that runs in place of the app.
    elf: Option<PathBuf>,
    wire: Wire,
    observer: Observer,
    decoder: Decoder,
    limits: Limits,
    stopped_by: Option<Stop>,
    commands: Commands,
    /// Commands are the caller's.
    commanded: bool,
    observation: Vec<f32>,
    before: Vec<f32>,
    /// Of the runner: it looks at the robot so often, and at each `decimation`-th time asks the network.
    cycle_ticks: u64,
    decimation: u64,
    steps: u64,
    began_sitting: bool,
    next_command_s: f64,
    next_push_s: f64,
}

impl Environment {
    /// Boots a robot, and begins an episode.
    ///
    /// # Errors
    /// The policy is for another robot, its period is none of the environment's, an option is out of range, or the robot
    /// does not arm.
    pub fn new(policy: &PolicyDescription, options: Options, seed: u64) -> Result<Self, GymError> {
        Self::of(policy, options, seed, None)
    }

    /// The same with the firmware's image `elf` in the emulated board in place of the app: the robot is booted for each
    /// episode, which takes seconds, and all episodes begin sitting.
    ///
    /// # Errors
    /// As [`new`](Self::new); this was built without the feature `board`, or the image cannot be read or is another robot's.
    pub fn on_board(
        policy: &PolicyDescription,
        options: Options,
        seed: u64,
        elf: &Path,
    ) -> Result<Self, GymError> {
        Self::of(policy, options, seed, Some(elf))
    }

    pub(crate) fn of(
        policy: &PolicyDescription,
        options: Options,
        seed: u64,
        elf: Option<&Path>,
    ) -> Result<Self, GymError> {
        options.check()?;
        let wire = Wire::new(policy)?;
        let (cycle_ticks, decimation) = cycle(policy)?;
        let mut numbers = Pcg64Mcg::seed_from_u64(seed);
        let mut specimen = draw(policy, &mut numbers, options.vary, elf)?;
        let Beginning { robot, hips_rad } = start(&mut specimen, &mut numbers, &options)?;
        let observer = Observer::new(policy);
        let mut environment = Self {
            options,
            numbers,
            episodes_of_robot: 0,
            wire,
            decoder: Decoder::new(policy),
            limits: Limits::new(policy, specimen.description()),
            stopped_by: None,
            commands: Commands::default(),
            commanded: false,
            observation: vec![0.0; observer.layout().len()],
            before: vec![0.0; policy.joints.len()],
            cycle_ticks,
            decimation,
            steps: 0,
            began_sitting: true,
            next_command_s: 0.0,
            next_push_s: 0.0,
            observer,
            specimen,
            robot,
            elf: elf.map(Path::to_owned),
        };
        environment.begin(hips_rad)?;
        Ok(environment)
    }

    /// Begins another episode, with another robot after so many as the options say.
    ///
    /// # Errors
    /// The next robot does not arm.
    pub fn reset(&mut self) -> Result<(), GymError> {
        if self.episodes_of_robot >= self.options.episodes_per_robot {
            let (policy, elf) = (self.wire.policy(), self.elf.as_deref());
            self.specimen = draw(policy, &mut self.numbers, self.options.vary, elf)?;
            self.episodes_of_robot = 0;
        }
        let Beginning { robot, hips_rad } =
            start(&mut self.specimen, &mut self.numbers, &self.options)?;
        self.robot = robot;
        self.begin(hips_rad)
    }

    /// Sets options from the next episode on.
    ///
    /// # Errors
    /// One is out of range.
    pub fn set_options(&mut self, options: Options) -> Result<(), GymError> {
        options.check()?;
        self.options = options;
        Ok(())
    }

    /// Options of the next episode.
    pub fn options(&self) -> Options {
        self.options
    }

    /// Begins an episode of a robot that has just been booted or placed. One that stands holds its hips at `hips_rad`.
    fn begin(&mut self, hips_rad: Option<[f64; 4]>) -> Result<(), GymError> {
        self.episodes_of_robot += 1;
        self.began_sitting = hips_rad.is_none();
        self.steps = 0;
        self.commanded = false;
        self.draw_command();
        let [early, late] = self.options.push_every_s;
        self.next_push_s = self.between(early, late);
        self.observer.reset();
        self.decoder.reset();
        self.limits.reset();
        self.stopped_by = None;
        if self.options.built_in {
            self.robot.remote(RemoteInput {
                stand: Some(true),
                ..RemoteInput::default()
            });
        }
        if let Some(hips_rad) = hips_rad {
            let hold = self.wire.actions_at(hips_rad);
            self.decoder.decode(&hold)?;
        }
        self.observe()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        between(&mut self.numbers, low, high)
    }

    fn draw_command(&mut self) {
        let Options {
            speed_mps,
            turn_rps,
            command_every_s: [early, late],
            ..
        } = self.options;
        let forward_mps = self.between(-speed_mps, speed_mps);
        let turn_rps = turn_rps.min(SIDEWAYS_MPS2 / forward_mps.abs().max(1e-3));
        let yaw_rps = self.between(-turn_rps, turn_rps);
        let moves = !self.numbers.random_bool(STANDS_STILL_IN);
        let share = if moves { 1.0 } else { 0.0 };
        self.commands = Commands {
            forward_mps: (share * forward_mps) as f32,
            left_mps: 0.0,
            yaw_rps: (share * yaw_rps) as f32,
        };
        self.next_command_s = self.seconds() + self.between(early, late);
    }

    /// Takes a command until the end of the episode, in place of drawing one at times. It is seen from the next observation on.
    pub fn command(&mut self, commands: Commands) {
        self.commands = commands;
        self.commanded = true;
    }

    /// The present command.
    pub fn commands(&self) -> Commands {
        self.commands
    }

    /// Pushes the robot in one instant, so that its speed forward and to the left changes by this.
    pub fn push(&mut self, change_mps: [f64; 2]) {
        let [ahead, left] = change_mps.map(|mps| mps * self.specimen.mass_kg);
        self.robot.push(Push::instant([ahead, left, 0.0]));
    }

    fn push_at_times(&mut self) {
        if self.options.push_mps <= 0.0 || self.seconds() < self.next_push_s {
            return;
        }
        let size_mps = self.between(0.0, self.options.push_mps);
        let (sin, cos) = self.between(0.0, std::f64::consts::TAU).sin_cos();
        self.push([size_mps * cos, size_mps * sin]);
        let [early, late] = self.options.push_every_s;
        self.next_push_s = self.seconds() + self.between(early, late);
    }

    /// Time in s since the episode began.
    pub fn seconds(&self) -> f64 {
        self.steps as f64 * (self.cycle_ticks * self.decimation) as f64 / TICKS_PER_S
    }

    /// Whether the episode has its full length.
    pub fn is_over(&self) -> bool {
        self.seconds() >= self.options.episode_s - 1e-9
    }

    /// The present observation, one for each step and one for the beginning.
    pub fn observation(&self) -> &[f32] {
        &self.observation
    }

    /// Number of actions.
    pub fn actions_len(&self) -> usize {
        self.before.len()
    }

    /// The robot as it is.
    pub fn truth(&self) -> Truth {
        self.robot.truth()
    }

    /// Takes an action: what the network gives.
    ///
    /// # Errors
    /// The action has the wrong length, or a value that is no number.
    pub fn step(&mut self, actions: &[f32]) -> Result<Step, GymError> {
        self.before.copy_from_slice(self.decoder.last_actions());
        let targets = self.decoder.decode(actions)?;
        self.wire.aim(targets);
        self.push_at_times();
        self.run_cycles()?;
        self.steps += 1;
        let truth = self.truth();
        let fallen = self.has_fallen(&truth);
        let wished = [self.commands.forward_mps, self.commands.yaw_rps].map(f64::from);
        let terms = Terms::new(&truth, wished, self.decoder.last_actions(), &self.before);
        if !self.commanded && self.seconds() >= self.next_command_s {
            self.draw_command();
        }
        self.observe()?;
        Ok(Step {
            reward: terms.sum(fallen),
            terms,
            fallen,
        })
    }

    /// Runs until the network is asked again, and looks at the robot as often as the runner does.
    fn run_cycles(&mut self) -> Result<(), GymError> {
        let cycle_s = self.cycle_ticks as f64 / TICKS_PER_S;
        for cycle in 0..self.decimation {
            // The runner judges torques when it sends, and the rest when it has heard.
            if cycle > 0 {
                self.wire.read(&self.robot.uplink())?;
            }
            self.judge(|limits, wire| {
                let reading = wire.reading();
                limits.check_attitude(reading)?;
                limits.check_speeds(reading)?;
                limits.check_positions(reading)?;
                limits.check_torques(cycle_s, reading, wire.wanted())
            });
            let frame = if self.options.built_in {
                self.wire.drive(&self.commands)
            } else {
                self.wire.command()
            };
            self.robot.send(&frame);
            self.robot.run_ticks(self.cycle_ticks)?;
        }
        Ok(())
    }

    /// Keeps the first reason to stop. The robot's own controller has no runner.
    fn judge(&mut self, check: impl FnOnce(&mut Limits, &Wire) -> Result<(), Stop>) {
        if !self.options.built_in && self.stopped_by.is_none() {
            self.stopped_by = check(&mut self.limits, &self.wire).err();
        }
    }

    /// What ended the episode, if it was a limit of the runner.
    pub fn stopped_by(&self) -> Option<&Stop> {
        self.stopped_by.as_ref()
    }

    fn has_fallen(&self, truth: &Truth) -> bool {
        let within_s = if self.options.built_in {
            STANDS_UP_WITHIN_S
        } else {
            GETS_UP_WITHIN_S
        };
        let gets_up = self.began_sitting && self.seconds() < within_s;
        let lies = truth.tilt_rad() > f64::from(TILT_RAD) || truth.body_n > 0.0;
        !truth.armed || self.stopped_by.is_some() || (lies && !gets_up)
    }

    fn observe(&mut self) -> Result<(), GymError> {
        let state = self.robot.uplink();
        self.wire.read(&state)?;
        let last_actions = self.decoder.last_actions();
        let input = self
            .observer
            .observe(self.wire.reading(), &self.commands, last_actions)?;
        self.observation.copy_from_slice(input);
        Ok(())
    }
}

/// Ticks of a cycle of the runner, and its cycles in a step.
fn cycle(policy: &PolicyDescription) -> Result<(u64, u64), GymError> {
    let exact = f64::from(policy.control_period_s) * TICKS_PER_S;
    let (ticks, decimation) = (exact.round() as u64, u64::from(policy.decimation));
    let is_whole = ticks > 0 && (exact - exact.round()).abs() < 1e-3;
    if is_whole && decimation > 0 && (ticks * decimation).is_multiple_of(10) {
        return Ok((ticks, decimation));
    }
    let period_s = policy.period_s();
    Err(GymError::Period { period_s })
}
