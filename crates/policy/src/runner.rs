//! A run, cycle by cycle: it takes what is known of the robot and gives the next command. It has no clock and no port.

use robot_app::link::{Downlink, Uplink};
use robot_description::Robot;
use robotctl::drive::Obstacle;

use crate::{
    PolicyDescription,
    action::{Decoder, Target},
    fit,
    limits::{Limits, SILENT_S, STALE_S, Stop},
    machine::{Machine, Phase, Timing},
    observation::{Commands, Layout, Observer, Reading},
    robot::{LinkRobot, OtherRobot},
};

/// Computes the actions from the input. Its error says what has failed.
pub type Network = Box<dyn FnMut(&[f32], &mut [f32]) -> Result<(), String> + Send>;

/// What is known at the start of a cycle.
#[derive(Clone, Debug)]
pub struct Now<'a> {
    /// Time in s. It only has to go on.
    pub time_s: f64,
    /// The newest state of the robot.
    pub state: &'a Uplink,
    /// Time in s since it came.
    pub age_s: f64,
    /// Time in s since the robot last said whether it is safe.
    pub silence_s: f64,
    /// What keeps the robot from obeying.
    pub obstacle: Option<Obstacle>,
    /// Where to go.
    pub commands: Commands,
    /// What else ends the run.
    pub stop: Option<Stop>,
}

/// A policy in its run. Each cycle is a period of the control loop; the network runs in one of `decimation` of them.
pub struct Runner {
    period_s: f64,
    decimation: u32,
    network: Network,
    robot: LinkRobot,
    limits: Limits,
    machine: Machine,
    observer: Observer,
    decoder: Decoder,
    /// Cycles until the network runs.
    until_run: u32,
    input: Vec<f32>,
    output: Vec<f32>,
    /// As wanted, before torques are held within their limits.
    wanted: Vec<Target>,
    sent: Vec<Target>,
    /// Runs of the network, and for each joint those in which its target was moved.
    runs: u64,
    held: Vec<u64>,
    has_run: bool,
    in_the_way: Option<Stop>,
}

impl Runner {
    /// Prepares a run of a policy on a robot.
    ///
    /// # Errors
    /// The policy is another robot's, or asks for what this one cannot do ([`fit`]).
    pub fn new(
        policy: &PolicyDescription,
        robot: &Robot,
        network: Network,
        timing: Timing,
    ) -> Result<Self, OtherRobot> {
        let observer = Observer::new(policy);
        let joints = policy.joints.len();
        let link = LinkRobot::new(policy)?;
        check_fit(policy, robot)?;
        Ok(Self {
            period_s: f64::from(policy.control_period_s),
            decimation: policy.decimation,
            network,
            robot: link,
            limits: Limits::new(policy, robot),
            machine: Machine::new(policy, timing),
            decoder: Decoder::new(policy),
            until_run: 0,
            input: vec![0.0; observer.layout().len()],
            output: vec![0.0; joints],
            wanted: Vec::with_capacity(joints),
            sent: Vec::with_capacity(joints),
            runs: 0,
            held: vec![0; joints],
            has_run: false,
            in_the_way: None,
            observer,
        })
    }

    /// Returns the command of this cycle.
    pub fn cycle(&mut self, now: &Now<'_>) -> Downlink {
        self.has_run = false;
        let heard = self.hear(now);
        self.in_the_way = heard.as_ref().err().cloned();
        // A passive robot has no torque: what is in the way may go away.
        let is_active = self.machine.phase() != Phase::Passive;
        let failed = heard.as_ref().err().filter(|_| is_active);
        // What the robot suffers comes before what the user or the computer wants: it allows no getting down.
        if let Some(stop) = failed.or(now.stop.as_ref()) {
            self.stop(stop.clone(), now.time_s);
        }
        let before = self.machine.phase();
        let reading = self.robot.reading();
        let phase = self.machine.step(now.time_s, heard.is_ok(), reading);
        if phase != before {
            self.begin(phase);
        }
        if let Err(stop) = self.aim(now) {
            self.stop(stop, now.time_s);
            // Neither getting down nor being passive asks the network.
            self.machine.pose(now.time_s, &mut self.wanted);
        }
        self.send()
    }

    /// Reads the state, and checks that the robot obeys and is within its limits.
    fn hear(&mut self, now: &Now<'_>) -> Result<(), Stop> {
        let read = self.robot.read(now.state);
        if let Some(obstacle) = &now.obstacle {
            return Err(Stop::NotPermitted(obstacle.clone()));
        }
        if now.age_s > STALE_S {
            return Err(Stop::Stale { age_s: now.age_s });
        }
        if now.silence_s > SILENT_S {
            return Err(Stop::NoAnswer);
        }
        read?;
        let reading = self.robot.reading();
        self.limits.check_attitude(reading)?;
        self.limits.check_speeds(reading)?;
        if self.machine.phase().is_driven() {
            self.limits.check_positions(reading)?;
        }
        Ok(())
    }

    fn send(&mut self) -> Downlink {
        if self.machine.phase() == Phase::Passive {
            self.sent.clear();
            return self.robot.limp();
        }
        // As in training, a command stays as it is until the network runs again.
        if !self.machine.phase().is_driven() || self.has_run {
            self.sent.clone_from(&self.wanted);
            self.limits
                .hold_torques(self.robot.reading(), &mut self.sent);
        }
        if self.has_run {
            self.count();
        }
        self.robot.command(&self.sent)
    }

    fn count(&mut self) {
        self.runs += 1;
        let moved = self.wanted.iter().zip(&self.sent);
        for (held, (wanted, sent)) in self.held.iter_mut().zip(moved) {
            *held += u64::from(wanted != sent);
        }
    }

    /// Runs the network on a state, whatever the robot is at. [`wanted`](Self::wanted) then has the targets.
    ///
    /// # Errors
    /// As the stops of a run, other than limits.
    pub fn rehearse(&mut self, state: &Uplink, commands: &Commands) -> Result<(), Stop> {
        self.robot.read(state)?;
        self.run_network(commands)
    }

    fn stop(&mut self, stop: Stop, time_s: f64) {
        self.machine.stop(stop, time_s, self.robot.reading());
    }

    fn begin(&mut self, phase: Phase) {
        self.limits.reset();
        if phase == Phase::Policy {
            self.observer.reset();
            self.decoder.reset();
            self.until_run = 0;
        }
    }

    /// Computes the targets as wanted.
    fn aim(&mut self, now: &Now<'_>) -> Result<(), Stop> {
        match self.machine.phase() {
            Phase::Passive => {
                self.wanted.clear();
                return Ok(());
            }
            Phase::GetDown => {
                self.machine.pose(now.time_s, &mut self.wanted);
                return Ok(());
            }
            Phase::GetUp => self.machine.pose(now.time_s, &mut self.wanted),
            Phase::Policy => self.drive(now.time_s, &now.commands)?,
            Phase::ToDefault => self.drive(now.time_s, &Commands::default())?,
        }
        let reading = self.robot.reading();
        self.limits
            .check_torques(self.period_s, reading, &self.wanted)
    }

    /// Runs the network in one of `decimation` cycles.
    fn drive(&mut self, time_s: f64, commands: &Commands) -> Result<(), Stop> {
        if self.until_run == 0 {
            self.until_run = self.decimation;
            self.run_network(commands)?;
            self.machine.lead_to_default(time_s, &mut self.wanted);
        }
        self.until_run -= 1;
        Ok(())
    }

    fn run_network(&mut self, commands: &Commands) -> Result<(), Stop> {
        let reading = self.robot.reading();
        let input = self
            .observer
            .observe(reading, commands, self.decoder.last_actions())?;
        self.input.copy_from_slice(input);
        let ran = (self.network)(&self.input, &mut self.output);
        ran.map_err(Stop::Network)?;
        let targets = self.decoder.decode(&self.output)?;
        self.wanted.clear();
        self.wanted.extend_from_slice(targets);
        self.has_run = true;
        Ok(())
    }

    /// Returns the states of the run.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Returns what kept the robot from getting up in the last cycle, or from going on.
    pub fn in_the_way(&self) -> Option<&Stop> {
        self.in_the_way.as_ref()
    }

    /// Returns whether the network ran in the last cycle.
    pub fn has_run(&self) -> bool {
        self.has_run
    }

    /// Returns whether the network runs in the next cycle, if the policy drives.
    pub fn is_due(&self) -> bool {
        self.until_run == 0
    }

    /// Returns where each term is in the input.
    pub fn layout(&self) -> &Layout {
        self.observer.layout()
    }

    /// Returns the network's last input.
    pub fn input(&self) -> &[f32] {
        &self.input
    }

    /// Returns the last actions, clipped and not scaled.
    pub fn actions(&self) -> &[f32] {
        self.decoder.last_actions()
    }

    /// Returns the last reading.
    pub fn reading(&self) -> &Reading {
        self.robot.reading()
    }

    /// Returns the targets as wanted, before torques were held within their limits.
    pub fn wanted(&self) -> &[Target] {
        &self.wanted
    }

    /// Returns for each joint in which share of the runs its target was moved, as the torque would have been above its limit.
    pub fn held_shares(&self) -> impl Iterator<Item = f64> {
        let runs = self.runs.max(1) as f64;
        self.held.iter().map(move |held| *held as f64 / runs)
    }

    /// Returns what was sent in the last cycle, in the policy's order and sense; nothing while the robot is passive.
    pub fn sent(&self) -> &[Target] {
        &self.sent
    }
}

fn check_fit(policy: &PolicyDescription, robot: &Robot) -> Result<(), OtherRobot> {
    let faults = fit::faults(policy, robot).into_iter();
    let errors = faults.filter(|fault| fault.is_error);
    let errors: Vec<_> = errors
        .map(|fault| match fault.joint {
            Some(joint) => format!("{}: {}", policy.joints[joint].name, fault.text),
            None => fault.text,
        })
        .collect();
    if errors.is_empty() {
        Ok(())
    } else {
        Err(OtherRobot::Unfit(errors))
    }
}

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
