//! The loop of a run, in real time: states in, commands out, one cycle after the other.

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
use robot_app::link::{Heard, Uplink};
use robot_policy::{
    PolicyDescription,
    action::Target,
    command_source::{CommandSource, Said},
    limits::{STALE_S, Stop},
    live::Live,
    log::Log,
    machine::Phase,
    messages::Entry,
    observation::Commands,
    pace::{Lateness, Pace},
    runner::{Now, Runner},
};
use robotctl::{
    can_link::{CanLink, CanLinkError},
    drive::RobotView,
    pc_link::{self, PcLink},
    tuning::LiveQuestion,
};

use super::priority;

/// The first state must come within this time.
const FIRST_STATE: Duration = Duration::from_secs(2);
/// Time for a cycle that is late to read the states that have come.
const CATCHES_UP: Duration = Duration::from_millis(1);
/// Commands without torque at the end.
const LAST_COMMANDS: u32 = 10;
/// A live page is asked for in one of so many cycles.
const QUESTION_EVERY: u64 = 20;
/// A rehearsal prints one of so many runs of the network.
const PRINT_EVERY: u64 = 25;

pub struct Session {
    port: String,
    link: PcLink,
    runner: Runner,
    source: CommandSource,
    names: Vec<String>,
    /// Cycles from one run of the network to the next.
    decimation: u64,
    pace: Pace,
    lateness: Lateness,
    /// The latest cycle since the last run of the network.
    late: Duration,
    started: Instant,
    interrupted: Arc<AtomicBool>,
    robot: RobotView,
    /// When the newest state came; `None` before the first.
    heard: Option<Instant>,
    questions: [LiveQuestion; 3],
    cycles: u64,
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
        let now = Instant::now();
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
            pace: Pace::new(Duration::from_secs_f32(policy.control_period_s), now),
            lateness: Lateness::new(policy.period_s()),
            late: Duration::ZERO,
            started: now,
            interrupted,
            robot: RobotView::default(),
            heard: None,
            questions: ["safety", "arming", "balance"].map(LiveQuestion::new),
            cycles: 0,
            said: String::new(),
            stop: None,
            seconds: None,
            log: None,
            live: None,
        })
    }

    /// Runs until the robot has got down, and says why it did.
    pub fn run(mut self) -> Result<ExitCode> {
        self.say(&priority::raise());
        self.wait_for_robot()?;
        let driven = self.drive();
        self.finish()?;
        driven?;
        self.verdict()
    }

    fn drive(&mut self) -> Result<()> {
        while !self.runner.machine().is_over() {
            self.cycle()?;
        }
        for _ in 0..LAST_COMMANDS {
            self.cycle()?;
        }
        Ok(())
    }

    fn cycle(&mut self) -> Result<()> {
        self.listen(self.pace.due())?;
        let begun = Instant::now();
        let late = self.pace.begin(begun);
        let phase = self.runner.machine().phase();
        // A cycle between two runs that is late delays the next one.
        self.late = self.late.max(late);
        if phase != Phase::Policy {
            self.late = Duration::ZERO;
        } else if self.runner.is_due() {
            let kept = self.lateness.add(mem::take(&mut self.late));
            self.stop = self.stop.take().or(kept.err());
        }
        let time_s = begun.duration_since(self.started).as_secs_f64();
        let commands = self.commands(time_s, phase);
        let state = self.robot.state;
        let age_s = self
            .heard
            .map_or(f64::INFINITY, |heard| (begun - heard).as_secs_f64());
        let command = self.runner.cycle(&Now {
            time_s,
            state: &state,
            age_s,
            obstacle: self.robot.obstacle(),
            commands,
            stop: self.stop.take(),
        });
        self.link.command(&command).map_err(link_failed)?;
        self.ask()?;
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
            self.stop = Some(Stop::Asked);
        }
        match self
            .source
            .read(self.started.elapsed(), policy_s, &self.robot.state.sticks)
        {
            Ok(Said::Commands(commands)) => return commands,
            Ok(Said::End) => self.stop = Some(Stop::Asked),
            // The user may want to end getting down at once.
            Err(error) => {
                self.stop
                    .get_or_insert_with(|| Stop::NoCommands(error.to_string()));
            }
        }
        Commands::default()
    }

    fn wait_for_robot(&mut self) -> Result<()> {
        let until = Instant::now() + FIRST_STATE;
        while self.heard.is_none()
            && Instant::now() < until
            && !self.interrupted.load(Ordering::Relaxed)
        {
            self.listen(Instant::now() + Duration::from_millis(10))?;
        }
        if self.heard.is_none() {
            let why = pc_link::why_silent(&self.port, &self.link.traffic());
            bail!("no state of the robot comes: {why}");
        }
        Ok(())
    }

    fn listen(&mut self, until: Instant) -> Result<()> {
        // A cycle that is late reads what has come meanwhile all the same.
        let now = Instant::now();
        let until = if until > now { until } else { now + CATCHES_UP };
        while let Some(heard) = self.link.next(until).map_err(link_failed)? {
            match heard {
                // A state that is sent again is not a new one.
                Heard::Uplink(state) if state.time_s != self.robot.state.time_s => {
                    self.robot.state = state;
                    self.heard = Some(Instant::now());
                }
                Heard::Uplink(_) => {}
                Heard::Tunnel(frame) => {
                    let answers = self
                        .questions
                        .iter()
                        .filter_map(|asked| asked.answer(&frame));
                    for answer in answers {
                        self.robot.take(&answer);
                    }
                }
            }
        }
        Ok(())
    }

    /// Asks for a live page: flags of safety are on the tuning channel only.
    fn ask(&mut self) -> Result<()> {
        self.cycles += 1;
        if self.cycles.is_multiple_of(QUESTION_EVERY) {
            let number = (self.cycles / QUESTION_EVERY) as usize % self.questions.len();
            let frame = self.questions[number].frame();
            CanLink::send(&mut self.link, &frame).map_err(link_failed)?;
        }
        Ok(())
    }

    /// Prints a line whenever something changes.
    fn tell(&mut self) {
        let machine = self.runner.machine();
        let headline = match (machine.phase(), machine.ended_by()) {
            (Phase::Passive, Some(_)) => "passive: no torque".to_owned(),
            (Phase::Passive, None) if self.robot.stands() => {
                "waits: the robot stands by itself; put the stand switch down".to_owned()
            }
            (Phase::Passive, None) => match self.runner.in_the_way() {
                Some(stop) => format!("waits: {stop}"),
                None => "waits: ready in a moment".to_owned(),
            },
            (Phase::GetUp, _) => "gets up".to_owned(),
            (Phase::Policy, _) => "the policy drives".to_owned(),
            (Phase::GetDown, Some(stop)) => format!("gets down: {stop}"),
            (Phase::GetDown, None) => "gets down".to_owned(),
        };
        if headline != self.said {
            self.say(&headline);
            self.said = headline;
        }
    }

    /// With the terminal's keys taken, a line needs its own return.
    fn say(&self, line: &str) {
        match self.source {
            CommandSource::Keyboard(..) => print!("{line}\r\n"),
            _ => println!("{line}"),
        }
    }

    /// Completes the log, and says how regular the runs were.
    fn finish(&mut self) -> Result<()> {
        if let Some(log) = self.log.take() {
            log.finish()?;
        }
        if let Some(jitter) = self.lateness.summary() {
            self.say(&format!(
                "{} runs of the network: late by min {:.0} µs, mean {:.0} µs, p99 {:.0} µs, max {:.0} µs; {} missed",
                jitter.runs, jitter.min_us, jitter.mean_us, jitter.p99_us, jitter.max_us, jitter.misses
            ));
        }
        Ok(())
    }

    fn verdict(&self) -> Result<ExitCode> {
        let Some(stop) = self.runner.machine().ended_by() else {
            bail!("the run has no end");
        };
        self.say(&format!("ended by {}: {stop}", stop.name()));
        Ok(if stop.is_wanted() {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        })
    }

    /// Prints what the policy sees and would command, and sends nothing.
    pub fn rehearse(mut self) -> Result<ExitCode> {
        self.wait_for_robot()?;
        let started = Instant::now();
        let is_over = |seconds: f64| started.elapsed().as_secs_f64() >= seconds;
        while !self.interrupted.load(Ordering::Relaxed) && !self.seconds.is_some_and(is_over) {
            self.listen(self.pace.due())?;
            let late = self.pace.begin(Instant::now());
            if self.cycles.is_multiple_of(self.decimation) && !self.rehearse_run(started, late)? {
                break;
            }
            self.cycles += 1;
        }
        self.finish()?;
        Ok(ExitCode::SUCCESS)
    }

    /// Runs the network once. Returns false if the user ends it.
    fn rehearse_run(&mut self, started: Instant, late: Duration) -> Result<bool> {
        let time_s = started.elapsed().as_secs_f64();
        let said = self
            .source
            .read(self.started.elapsed(), time_s, &self.robot.state.sticks)?;
        let Said::Commands(commands) = said else {
            return Ok(false);
        };
        let state = self.robot.state;
        self.runner.rehearse(&state, &commands)?;
        // Nobody waits for a command that is late.
        let _ = self.lateness.add(late);
        if (self.cycles / self.decimation).is_multiple_of(PRINT_EVERY) {
            self.print(&state);
        }
        self.record(time_s, commands, late);
        Ok(true)
    }

    fn print(&self, state: &Uplink) {
        self.say(&format!("t = {:.2} s", state.time_s));
        for block in self.runner.layout().blocks() {
            let values = self.runner.input()[block.offset..].iter().take(block.len);
            let values = block.values.iter().zip(values);
            let values: Vec<_> = values
                .map(|(name, value)| format!("{name} {value:+.3}"))
                .collect();
            self.say(&format!(
                "  {:>4} {:<16} {:>2}  {}",
                block.offset,
                block.term,
                block.age,
                values.join("  ")
            ));
        }
        for (name, target) in self.names.iter().zip(self.runner.wanted()) {
            self.say(&match target {
                Target::Position { rad, kp, kd } => {
                    format!("       {name:<16} {rad:+.3} rad, Kp {kp} Kd {kd}")
                }
                Target::Speed { rps, kd } => format!("       {name:<16} {rps:+.3} rad/s, Kd {kd}"),
            });
        }
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
