//! The loop of a drive: 100 commands a second, until the user ends it or something fails.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use robot_app::link::Heard;
use robotctl::{
    drive::{Obstacle, RobotView, Wish},
    pc_link::{self, PcLink},
    tuning::LiveQuestion,
};

use super::{
    controls::{Controls, Said},
    pilot::Pilot,
    screen::Screen,
    signed::signed,
};
use crate::command::{interrupt::Interrupt, output::say};

const PERIOD: Duration = Duration::from_millis(10);
/// A question for a live page goes out every so many commands.
const QUESTION_EVERY: u64 = 10;
const REPAINT_EVERY: u64 = 10;
/// The robot's state comes 417 times a second. Without one for this long, the link is down.
const UPLINK_LOST: Duration = Duration::from_millis(300);
/// The first state must come within this time.
const FIRST_STATE: Duration = Duration::from_secs(2);
/// Commands from rest at the end.
const LAST_COMMANDS: u32 = 10;

pub struct Session {
    port: String,
    link: PcLink,
    pilot: Pilot,
    controls: Controls,
    screen: Screen,
    interrupt: Interrupt,
    robot: RobotView,
    started: Instant,
    heard: Option<Instant>,
    states_before: u64,
    commands: u64,
    rate_hz: f64,
    questions: [LiveQuestion; 3],
    wish: Wish,
}

impl Session {
    pub fn new(port: String, link: PcLink, pilot: Pilot, controls: Controls) -> Result<Self> {
        let states_before = link.traffic().states;
        Ok(Self {
            port,
            link,
            pilot,
            screen: Screen::open(controls.has_terminal())?,
            controls,
            interrupt: Interrupt::catch()?,
            robot: RobotView::default(),
            started: Instant::now(),
            heard: None,
            states_before,
            commands: 0,
            rate_hz: 0.0,
            questions: ["safety", "arming", "balance"].map(LiveQuestion::new),
            wish: Wish::NONE,
        })
    }

    pub fn run(mut self) -> Result<()> {
        let ended = self.drive();
        let rested = self.end();
        let Self {
            controls, screen, ..
        } = self;
        // The terminal is restored before anything is said.
        drop(screen);
        drop(controls);
        ended.context("the drive has ended")?;
        rested?;
        say!("ended: without commands the robot gives its motors no torque while its mode is PC")?;
        Ok(())
    }

    fn drive(&mut self) -> Result<()> {
        let mut next = Instant::now();
        while !self.interrupt.is_caught() {
            next += PERIOD;
            self.listen(next)?;
            let now = Instant::now();
            if now > next + PERIOD {
                // The computer was busy: what was missed is not made up for.
                next = now;
            }
            self.check_uplink(now)?;
            self.wish = match self.controls.read(self.started.elapsed())? {
                Said::Wish(wish) => wish,
                Said::End => return Ok(()),
            };
            if self.heard.is_some() {
                self.send()?;
            }
            self.paint()?;
        }
        Ok(())
    }

    fn listen(&mut self, until: Instant) -> Result<()> {
        while let Some(heard) = self.link.next(until)? {
            match heard {
                Heard::Uplink(state) => {
                    self.robot.state = state;
                    self.heard = Some(Instant::now());
                }
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

    fn check_uplink(&self, now: Instant) -> Result<()> {
        let why = || pc_link::why_silent(&self.port, &self.link.traffic());
        match self.heard {
            None if self.started.elapsed() > FIRST_STATE => {
                bail!("no state of the robot comes: {}", why())
            }
            Some(heard) if now.saturating_duration_since(heard) > UPLINK_LOST => bail!(
                "the robot's state no longer comes through {}: is the cable in, and is the robot on?",
                self.port
            ),
            _ => Ok(()),
        }
    }

    fn send(&mut self) -> Result<()> {
        let dt_s = PERIOD.as_secs_f64();
        self.pilot
            .step(&mut self.link, dt_s, self.wish, &self.robot)?;
        self.commands += 1;
        if self.commands.is_multiple_of(QUESTION_EVERY) {
            let number = (self.commands / QUESTION_EVERY) as usize % self.questions.len();
            let asked = self.questions.get(number).map(LiveQuestion::frame);
            if let Some(frame) = asked {
                robotctl::can_link::CanLink::send(&mut self.link, &frame)?;
            }
        }
        Ok(())
    }

    /// Sends commands from rest. If the link has failed, the robot stops by itself.
    fn end(&mut self) -> Result<()> {
        if self.heard.is_none() {
            return Ok(());
        }
        for _ in 0..LAST_COMMANDS {
            self.pilot.rest(&mut self.link, &self.robot)?;
            self.listen(Instant::now() + PERIOD)?;
        }
        Ok(())
    }

    fn paint(&mut self) -> Result<()> {
        if !self.commands.is_multiple_of(REPAINT_EVERY) {
            return Ok(());
        }
        let states = self.link.traffic().states;
        let seconds = PERIOD.as_secs_f64() * REPAINT_EVERY as f64;
        let rate_hz = (states - self.states_before) as f64 / seconds;
        self.rate_hz += 0.2 * (rate_hz - self.rate_hz);
        self.states_before = states;
        let headline = self.headline();
        let lines = self.lines();
        self.screen.show(&headline, &lines)
    }

    fn headline(&self) -> String {
        match self.robot.obstacle() {
            _ if self.heard.is_none() => "waiting for the robot's state".to_owned(),
            Some(Obstacle::PcAwaited)
                if self.robot.stands() && self.pilot.needs_a_sitting_robot() =>
            {
                "cannot move: the robot stands, and takes --sticks only".to_owned()
            }
            Some(Obstacle::PcAwaited) if self.robot.lies() => {
                "cannot move: the robot lies; put the stand switch down first".to_owned()
            }
            Some(Obstacle::PcAwaited) => "ready in a moment".to_owned(),
            Some(obstacle) => format!("cannot move: {obstacle}"),
            None if self.wish.is_held && self.pilot.must_let_go() => {
                "let go of the dead-man once: it was held through a stop".to_owned()
            }
            None if self.wish.is_held => "driving".to_owned(),
            None => "ready: hold the dead-man to drive".to_owned(),
        }
    }

    fn lines(&self) -> Vec<String> {
        let state = &self.robot.state;
        let [_, _, joints @ ..] = state.motors;
        let joints = joints.map(|joint| signed(joint.pos_rad.into()));
        let traffic = self.link.traffic();
        let mode = self.robot.mode();
        let mode = mode.map_or("unknown".to_owned(), |mode| mode.to_string());
        let armed = if self.robot.is_armed() {
            "armed"
        } else {
            "disarmed"
        };
        let balance = self.robot.balance().unwrap_or("unknown");
        let mut lines = vec![
            String::new(),
            format!("robot     mode {mode}, {armed}, balance {balance}"),
        ];
        lines.extend(self.pilot.lines(&self.robot));
        lines.extend([
            format!("joints    {} rad", joints.join("  ")),
            format!(
                "battery   {:.1} V   microcontroller {} °C",
                state.battery_v, state.mcu_c
            ),
            format!(
                "link      {:.0} states/s, {} commands sent, {} CRC errors",
                self.rate_hz, self.commands, traffic.counters.crc_errors
            ),
            String::new(),
        ]);
        lines.extend(self.controls.help());
        lines
    }
}
