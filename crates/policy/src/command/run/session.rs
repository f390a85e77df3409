//! The loop of a run: states in, commands out, one cycle after the other.

mod beat;
mod lines;
mod rehearsal;

use std::{
    mem,
    process::ExitCode,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail};
use robot_app::link::{Downlink, Heard};
use robot_policy::{
    PolicyDescription,
    command_source::{CommandSource, Said, Wishes},
    limits::{STALE_S, Stop},
    live::Live,
    log::Log,
    machine::Phase,
    messages::Entry,
    observation::Commands,
    pace::Lateness,
    pages::Pages,
    runner::{Now, Runner},
};
use robotctl::{
    can_link::{CanLink, CanLinkError},
    drive::RobotView,
    pc_link::{self, PcLink},
};

pub use beat::Beat;
use beat::Begun;

/// The first state must come within this time.
pub const FIRST_STATE: Duration = Duration::from_secs(2);
/// Time for a cycle that is late to read the states that have come.
const CATCHES_UP: Duration = Duration::from_millis(1);
/// Commands without torque at the end.
const LAST_COMMANDS: u32 = 10;

pub struct Session {
    port: String,
    link: PcLink,
    runner: Runner,
    source: CommandSource,
    names: Vec<String>,
    /// Cycles from one run of the network to the next.
    decimation: u64,
    lateness: Lateness,
    /// The latest cycle since the last run of the network.
    late: Duration,
    started: Instant,
    /// When the last cycle began, by the clock that counts.
    time_s: f64,
    interrupted: Arc<AtomicBool>,
    wishes: Wishes,
    robot: RobotView,
    pages: Pages,
    /// When the newest state came; `None` before the first.
    heard: Option<Instant>,
    /// The last command.
    command: Downlink,
    said: String,
    /// What ends the run and is not yet told to it.
    stop: Option<Stop>,
    pub seconds: Option<f64>,
    pub log: Option<Log>,
    pub live: Option<Live>,
}

impl Session {
    pub fn new(
        port: String,
        link: PcLink,
        runner: Runner,
        source: CommandSource,
        policy: &PolicyDescription,
    ) -> Result<Self> {
        let interrupted = Arc::new(AtomicBool::new(false));
        let caught = interrupted.clone();
        ctrlc::set_handler(move || caught.store(true, Ordering::Relaxed))
            .context("cannot catch Ctrl-C")?;
        Ok(Self {
            port,
            link,
            runner,
            source,
            names: policy
                .joints
                .iter()
                .map(|joint| joint.name.clone())
                .collect(),
            decimation: policy.decimation.into(),
            lateness: Lateness::new(policy.period_s()),
            late: Duration::ZERO,
            started: Instant::now(),
            time_s: 0.0,
            interrupted,
            wishes: Wishes::default(),
            robot: RobotView::default(),
            pages: Pages::default(),
            heard: None,
            command: Downlink::default(),
            said: String::new(),
            stop: None,
            seconds: None,
            log: None,
            live: None,
        })
    }

    /// Runs until the robot has got down, and says why it did.
    pub fn run(mut self, mut beat: Beat) -> Result<ExitCode> {
        self.wait_for_robot()?;
        self.say("the robot is heard");
        let driven = self.drive(&mut beat);
        self.finish()?;
        driven?;
        self.verdict()
    }

    fn drive(&mut self, beat: &mut Beat) -> Result<()> {
        while !self.runner.machine().is_over() {
            self.cycle(beat)?;
        }
        for _ in 0..LAST_COMMANDS {
            self.cycle(beat)?;
        }
        Ok(())
    }

    fn cycle(&mut self, beat: &mut Beat) -> Result<()> {
        let begun = beat.begin(self)?;
        let Begun { time_s, late, .. } = begun;
        self.time_s = time_s;
        let phase = self.runner.machine().phase();
        // A cycle between two runs that is late delays the next one.
        self.late = self.late.max(late);
        if phase != Phase::Policy {
            self.late = Duration::ZERO;
        } else if self.runner.is_due() {
            let kept = self.lateness.add(mem::take(&mut self.late));
            self.stop = self.stop.take().or(kept.err());
        }
        let commands = self.commands(time_s, phase);
        let state = self.robot.state;
        self.command = self.runner.cycle(&Now {
            time_s,
            state: &state,
            age_s: begun.age_s,
            silence_s: self.pages.silence_s(time_s),
            obstacle: self.robot.obstacle(),
            commands,
            stop: self.stop.take(),
        });
        // A robot in lockstep goes on as soon as the command comes.
        self.ask(time_s)?;
        self.link.command(&self.command).map_err(link_failed)?;
        self.tell();
        self.record(time_s, commands, late);
        Ok(())
    }

    fn record(&mut self, time_s: f64, commands: Commands, late: Duration) {
        let entry = Entry {
            time_s,
            runner: &self.runner,
            commands,
            late_s: late.as_secs_f64(),
            state: &self.robot.state,
        };
        if let Some(live) = &self.live {
            live.add(&entry);
        }
        // A disk that is full fells no robot.
        if let Some(log) = &mut self.log
            && let Err(error) = log.add(&entry)
        {
            eprintln!("the log ends here: {error}");
            self.log = None;
        }
    }

    /// Returns where to go, and notes what the user or the source ends.
    fn commands(&mut self, time_s: f64, phase: Phase) -> Commands {
        let policy_s = match phase {
            Phase::Policy => self.runner.machine().elapsed_s(time_s),
            _ => 0.0,
        };
        let is_over = self
            .seconds
            .filter(|seconds| phase == Phase::Policy && policy_s >= *seconds);
        if let Some(seconds) = is_over {
            self.stop = Some(Stop::TimeOver { seconds });
        }
        if self.interrupted.swap(false, Ordering::Relaxed) {
            self.end();
        }
        match self
            .source
            .read(self.started.elapsed(), policy_s, &self.robot.state.sticks)
        {
            Ok(Said::Commands(commands)) => return commands,
            Ok(Said::End) => self.end(),
            // The user may want to end getting down at once.
            Err(error) => {
                self.stop
                    .get_or_insert_with(|| Stop::NoCommands(error.to_string()));
            }
        }
        Commands::default()
    }

    /// The user wants to end. A key that is held says it again and again.
    fn end(&mut self) {
        if self.wishes.is_new(self.started.elapsed()) {
            self.stop = Some(Stop::Asked);
        }
    }

    fn wait_for_robot(&mut self) -> Result<()> {
        if !self.next_state(Instant::now() + FIRST_STATE)? {
            let why = pc_link::why_silent(&self.port, &self.link.traffic());
            bail!("no state of the robot comes: {why}");
        }
        Ok(())
    }

    /// Takes what comes until then. A cycle that is late reads what has come meanwhile all the same.
    fn listen(&mut self, until: Instant) -> Result<()> {
        let now = Instant::now();
        let until = if until > now { until } else { now + CATCHES_UP };
        while self.hear(until)? {}
        Ok(())
    }

    /// Waits for a state that is new. Returns false if none comes until then.
    fn next_state(&mut self, until: Instant) -> Result<bool> {
        let before = self.heard;
        while self.heard == before {
            if !self.hear(until)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Takes the next frame of the robot. Returns false if none comes until then.
    fn hear(&mut self, until: Instant) -> Result<bool> {
        let Some(heard) = self.link.next(until).map_err(link_failed)? else {
            return Ok(false);
        };
        match heard {
            // A state that is sent again is not a new one.
            Heard::Uplink(state) if state.time_s != self.robot.state.time_s => {
                self.robot.state = state;
                self.heard = Some(Instant::now());
            }
            Heard::Uplink(_) => {}
            Heard::Tunnel(frame) => {
                self.pages.take(&frame, self.time_s, &mut self.robot);
            }
        }
        Ok(true)
    }

    /// Asks for a live page: flags of safety are on the tuning channel only.
    fn ask(&mut self, time_s: f64) -> Result<()> {
        if let Some(question) = self.pages.question(time_s) {
            CanLink::send(&mut self.link, &question).map_err(link_failed)?;
        }
        Ok(())
    }
}

/// Names the stop; nothing can be sent any more.
fn link_failed(error: CanLinkError) -> anyhow::Error {
    let stop = Stop::LinkFailed(format!(
        "{error}; the robot has no torque {STALE_S} s after the last command"
    ));
    let name = stop.name();
    anyhow::Error::from(stop).context(format!("ended by {name}"))
}
