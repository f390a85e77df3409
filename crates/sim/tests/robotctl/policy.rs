//! A policy drives the shipped image through the PC link. The run's clock is the robot's, so a busy computer changes nothing.

use std::{
    cell::RefCell,
    path::{Path, PathBuf},
    rc::Rc,
    time::{Duration, Instant},
};

use anyhow::{Context, bail};
use robot_app::link::{Heard, Uplink};
use robot_description::Robot;
use robot_plant::time::SECOND;
use robot_policy::{
    config,
    limits::Stop,
    machine::{Phase, Timing},
    observation::Commands,
    pages::Pages,
    runner::{Network, Now, Runner},
};
use robot_sim::scenario::Scenario;
use robotctl::{
    can_link::CanLink,
    drive::RobotView,
    pc_link::{PcLink, SharedLink},
    settings,
    tuning::TuningClient,
};

use crate::{
    clean_flash, support,
    tool::{TIMEOUT, Tool},
};

/// On a busy computer the board may rest for long.
const PATIENCE: Duration = Duration::from_secs(20);
/// A cycle for every two states is one in 4.8 ms of the robot's time.
const STATES_A_CYCLE: u64 = 2;
/// A minute of the robot's time: something is wrong.
const MOST_STATES: u64 = 25_000;
/// The longest that the robot allows: on a busy computer this program may rest while the board goes on.
const PC_TIMEOUT_US: f32 = 500_000.0;
/// Wheel targets are 5 and −2.5 rad/s; friction takes 0.15 N·m, which are 0.5 rad/s at a Kd of 0.3.
const ACTIONS: [f32; 6] = [0.0, 0.0, 0.0, 0.0, 1.0, -0.5];

fn folder() -> PathBuf {
    robot_test_support::repository()
}

fn runner() -> anyhow::Result<Runner> {
    let policies = folder().join("crates/policy/tests/vectors/policies");
    let policy = config::read(&policies, "fivebar", "flat")?;
    let robot = Robot::read(&folder().join("robots/fivebar.toml"))?;
    let network: Network = Box::new(|_, output| {
        output.copy_from_slice(&ACTIONS);
        Ok(())
    });
    Ok(Runner::new(&policy, &robot, network, Timing::default())?)
}

/// A program at the link.
struct Session {
    link: PcLink,
    robot: RobotView,
    pages: Pages,
    states: u64,
}

/// What a run of a policy did.
struct Ran {
    ended_by: String,
    /// Angles of the hips where it began, when the policy took over, and at the end.
    hips_rad: [[f32; 4]; 3],
    /// Speeds of the wheels a second after the policy took over.
    wheels_rps: [f32; 2],
    got_down: bool,
}

fn hips_rad(state: &Uplink) -> [f32; 4] {
    let [_, _, hips @ ..] = state.motors;
    hips.map(|hip| hip.pos_rad)
}

impl Session {
    fn next_state(&mut self) -> anyhow::Result<()> {
        loop {
            let heard = self.link.next(Instant::now() + PATIENCE)?;
            match heard.context("the board sends no more")? {
                Heard::Uplink(state) => {
                    self.robot.state = state;
                    self.states += 1;
                    return Ok(());
                }
                Heard::Tunnel(frame) => {
                    let time_s = f64::from(self.robot.state.time_s);
                    self.pages.take(&frame, time_s, &mut self.robot);
                }
            }
        }
    }

    /// Runs a policy to its end. `asked_s` after the policy took over, the user ends it.
    fn run(&mut self, asked_s: Option<f64>) -> anyhow::Result<Ran> {
        let mut runner = runner()?;
        let mut ran = Ran {
            ended_by: String::new(),
            hips_rad: [[0.0; 4]; 3],
            wheels_rps: [0.0; 2],
            got_down: false,
        };
        let last = self.states + MOST_STATES;
        let mut before = Phase::Passive;
        while self.states < last {
            self.next_state()?;
            if let Some(question) = self.pages.question(f64::from(self.robot.state.time_s)) {
                CanLink::send(&mut self.link, &question)?;
            }
            if !self.states.is_multiple_of(STATES_A_CYCLE) {
                continue;
            }
            let state = self.robot.state;
            let time_s = f64::from(state.time_s);
            let policy_s = runner.machine().elapsed_s(time_s);
            let drives = runner.machine().phase() == Phase::Policy;
            let stop = asked_s.filter(|at_s| drives && policy_s > *at_s);
            let command = runner.cycle(&Now {
                time_s,
                state: &state,
                age_s: 0.0,
                // On a busy computer the board may go on for long before it hears a question.
                silence_s: 0.0,
                obstacle: self.robot.obstacle(),
                commands: Commands::default(),
                stop: stop.map(|_| Stop::Asked),
            });
            self.link.command(&command)?;
            let phase = runner.machine().phase();
            match phase {
                Phase::GetUp if before != phase => ran.hips_rad[0] = hips_rad(&state),
                Phase::Policy if before != phase => ran.hips_rad[1] = hips_rad(&state),
                Phase::Policy if policy_s < 1.0 => {
                    ran.wheels_rps = [state.motors[0].vel_rps, state.motors[1].vel_rps];
                }
                Phase::GetDown => ran.got_down = true,
                _ => {}
            }
            before = phase;
            if runner.machine().is_over() {
                ran.hips_rad[2] = hips_rad(&state);
                ran.ended_by = runner.machine().ended_by().context("a stop")?.to_string();
                return Ok(ran);
            }
        }
        bail!("the run has no end: {:?}", runner.in_the_way())
    }
}

fn be_patient(link: PcLink) -> anyhow::Result<PcLink> {
    let link = Rc::new(RefCell::new(link));
    let mut client = TuningClient::new(Box::new(SharedLink(link.clone())), TIMEOUT);
    client.write(settings::find("safety.pc-timeout-us")?, PC_TIMEOUT_US)?;
    drop(client);
    let link = Rc::into_inner(link).context("nobody else has the link")?;
    Ok(link.into_inner())
}

fn near(found: [f32; 4], wanted: [f32; 4], most: f32) -> bool {
    let mut pairs = found.into_iter().zip(wanted);
    pairs.all(|(found, wanted)| (found - wanted).abs() < most)
}

/// Wheels in the air. The user ends the first run, which gets down; in the second the pilot leaves mode PC.
#[test]
fn a_policy_drives_the_image_until_the_user_or_the_pilot_ends_it() {
    let text = "name = \"policy\"\nseconds = 60\nplant = \"stand\"\n\
                [[at]]\nt = 0.1\nremote = { mode = 1 }\n\
                [[at]]\nt = 2.5\nremote = { enable = true }\n\
                [[at]]\nt = 14.0\nremote = { mode = 0 }\n";
    let mut job = support::job(Scenario::parse(text, "policy").expect("it parses"));
    job.pc.link_on_pty = true;
    let flash = Path::new(env!("CARGO_TARGET_TMPDIR")).join("policy.bin");
    std::fs::write(&flash, clean_flash()).expect("a file for its flash");
    job.flash_file = Some(flash);
    job.scenario.length = 60 * SECOND;
    let mut tool = Tool::at_link(|port| {
        let mut session = Session {
            link: be_patient(PcLink::open(port)?)?,
            robot: RobotView::default(),
            pages: Pages::default(),
            states: 0,
        };
        Ok([session.run(Some(1.5))?, session.run(None)?])
    })
    .ending_the_run();
    let outcome = job.run(&mut [&mut tool]).expect("the machine starts");
    let [asked, left] = tool.result().expect("the policy runs");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);

    for ran in [&asked, &left] {
        let [_, up_rad, _] = ran.hips_rad;
        assert!(near(up_rad, [-0.3, -0.2, -0.1, 0.0], 0.05), "{up_rad:?}");
        let [left_rps, right_rps] = ran.wheels_rps;
        assert!((left_rps - 4.5).abs() < 0.5, "{left_rps}");
        assert!((right_rps + 2.0).abs() < 0.5, "{right_rps}");
    }
    assert_eq!(asked.ended_by, "ended as asked");
    let [rest_rad, _, end_rad] = asked.hips_rad;
    assert!(
        asked.got_down && near(end_rad, rest_rad, 0.05),
        "{rest_rad:?} {end_rad:?}"
    );
    assert!(
        left.ended_by.contains("the radio's mode is manual, not PC"),
        "{}",
        left.ended_by
    );
    assert!(!left.got_down);
}
