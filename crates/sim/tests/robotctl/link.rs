//! The tool at the PC link of the shipped image.

mod pad;

use std::{
    path::PathBuf,
    time::{Duration, Instant},
};

use anyhow::{Context, bail};
use pad::Pad;
use robot_app::{link::Heard, tuning::Refusal};
use robot_plant::time::{Ps, SECOND};
use robot_sim::{
    job::{Job, Outcome},
    scenario::Scenario,
};
use robotctl::{
    drive::{Driver, Gains, Joystick, JoystickMap, Limits, RobotView, SticksDriver, Wheels, Wish},
    link_recorder::{LinkRecorder, LinkSummary},
    pc_link::PcLink,
    settings,
    status::Status,
    tuning::{LiveQuestion, TuningClient, TuningError},
};

use crate::{
    clean_flash, support,
    tool::{TIMEOUT, Tool},
};

/// On a busy computer the board may rest for long.
const PATIENCE: Duration = Duration::from_secs(20);
const TRACK: &str = "wheel-geometry.track-m";
/// The tool ends its work long before, also on a busy computer.
const MOST_TIME: Ps = 180 * SECOND;

fn job(name: &str, text: &str) -> Job {
    let mut job = support::job(Scenario::parse(text, name).expect("it parses"));
    job.pc.link_on_pty = true;
    let flash = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("link-{name}.bin"));
    std::fs::write(&flash, clean_flash()).expect("a file for its flash");
    job.flash_file = Some(flash);
    job
}

/// Runs the board until the tool's work is done.
fn run<T: Send + 'static>(mut job: Job, tool: Tool<T>) -> (T, Outcome) {
    job.scenario.length = MOST_TIME;
    let mut tool = tool.ending_the_run();
    let outcome = job.run(&mut [&mut tool]).expect("the machine starts");
    let result = tool.result().expect("the robot does as it is told");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(outcome.summary.control.missed, 0);
    (result, outcome)
}

#[test]
fn status_and_settings_go_through_the_link() {
    let job = job("tune", "name = \"tune\"\nseconds = 3\nplant = \"stand\"\n");
    let tool = Tool::at_link(|port| {
        let mut client = TuningClient::new(Box::new(PcLink::open(port)?), TIMEOUT);
        let status = Status::read(&mut client)?;
        let track = settings::find(TRACK)?;
        client.write(track, 0.37)?;
        Ok((status.to_string(), client.read(track)?))
    });
    let ((status, track), outcome) = run(job, tool);
    assert!(status.contains("disarmed"), "{status}");
    assert_eq!(track, 0.37);
    assert_eq!(outcome.result.value("diag.tuning.refused"), Some(0.0));
}

/// Records the first states, whatever time the board takes for them.
fn record(port: &str, path: PathBuf, states: u64) -> anyhow::Result<LinkSummary> {
    let mut link = PcLink::open(port)?;
    let mut recorder = LinkRecorder::create(&path)?;
    while recorder.summary().states < states {
        match link.next(Instant::now() + PATIENCE)? {
            Some(Heard::Uplink(state)) => recorder.add(&state, &link.traffic())?,
            Some(Heard::Tunnel(frame)) => bail!("nobody has asked for {frame:?}"),
            None => bail!("the board sends no more"),
        }
    }
    Ok(recorder.finish()?)
}

#[test]
fn the_state_of_the_image_is_recorded_and_shown() {
    const STATES: u64 = 400;
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("image.mcap");
    let job = job(
        "record",
        "name = \"record\"\nseconds = 3\nplant = \"stand\"\n",
    );
    let file = path.clone();
    let tool = Tool::at_link(move |port| record(port, file, STATES));
    let (summary, _) = run(job, tool);
    assert_eq!(summary.counters.crc_errors, 0, "{summary:?}");
    assert_eq!((summary.implausible, summary.restarts), (0, 0));
    // A busy computer reads too slowly for some frames, so gaps do not count here.
    let sent_s = summary.duration_s - summary.missing_s;
    let rate_hz = summary.states as f64 / sent_s;
    assert!((400.0..=420.0).contains(&rate_hz), "{rate_hz} {summary:?}");
    let page = robotctl::plot::page(&path).expect("a page");
    assert!(page.contains("Attitude") && page.contains("Wheel speeds"));
}

/// What the drive found.
struct Driven {
    /// Wheel speed at which the dead-man was let go.
    fastest_rps: f32,
    /// Wheel speed some time after the dead-man was let go.
    after_rps: f32,
    link: PcLink,
}

/// Sends a command for every four states, which is some 10 ms of the robot's time.
const STATES_A_COMMAND: u32 = 4;
/// Speed that the wheels must reach; asked is 0.3 m/s of wheels of 0.075 m, so 4 rad/s.
const TURNING_RPS: f32 = 2.0;
/// Wheel speed of a robot that balances on the spot, some 1 rad/s right after a stop; one that drives on has 10 rad/s.
const BALANCING_RPS: f32 = 2.0;
/// States from letting go to the end.
const STOPPING: u32 = 400;
/// Three minutes of the robot's time: something is wrong.
const MOST_STATES: u32 = 75_000;

/// One of the two ways to steer.
trait Pilot {
    fn send(&mut self, link: &mut PcLink, wish: Wish, robot: &RobotView) -> anyhow::Result<()>;
    /// Whether the dead-man counts, as soon as it is held.
    fn is_ready(&self, robot: &RobotView) -> bool;
}

impl Pilot for Driver {
    fn send(&mut self, link: &mut PcLink, wish: Wish, robot: &RobotView) -> anyhow::Result<()> {
        Ok(link.command(&self.step(0.01, wish, robot))?)
    }

    fn is_ready(&self, robot: &RobotView) -> bool {
        robot.obstacle().is_none() && !self.must_let_go()
    }
}

/// It drives only while the robot stands.
impl Pilot for SticksDriver {
    fn send(&mut self, link: &mut PcLink, wish: Wish, robot: &RobotView) -> anyhow::Result<()> {
        Ok(link.drive(&self.step(0.01, wish, robot))?)
    }

    fn is_ready(&self, robot: &RobotView) -> bool {
        robot.obstacle().is_none() && robot.stands() && !self.must_let_go()
    }
}

/// Pushes the stick until the wheels turn, and lets go.
fn drive(port: &str, pad: &str, mut pilot: impl Pilot) -> anyhow::Result<Driven> {
    let mut pad = Pad::plug_in(pad)?;
    let mut joystick = Joystick::open(pad.path(), JoystickMap::default())?;
    let mut link = PcLink::open(port)?;
    let questions = ["safety", "arming", "balance"].map(LiveQuestion::new);
    let mut robot = RobotView::default();
    let mut fastest_rps = 0.0_f32;
    let mut let_go_at = None;
    for n in 0..MOST_STATES {
        robot.state = next_state(&mut link, &questions, &mut robot)?;
        if let_go_at.is_some_and(|at| n > at + STOPPING) {
            let after_rps = robot.state.motors[0].vel_rps;
            pilot.send(&mut link, Wish::NONE, &robot)?;
            return Ok(Driven {
                fastest_rps,
                after_rps,
                link,
            });
        }
        if !n.is_multiple_of(STATES_A_COMMAND) {
            continue;
        }
        if let_go_at.is_none() && pilot.is_ready(&robot) {
            fastest_rps = fastest_rps.max(robot.state.motors[0].vel_rps);
        }
        if fastest_rps > TURNING_RPS {
            let_go_at.get_or_insert(n);
        }
        pad.forward()?;
        pad.dead_man(let_go_at.is_none() && pilot.is_ready(&robot))?;
        let wish = joystick.wish(|_| {})?;
        pilot.send(&mut link, wish, &robot)?;
        if n.is_multiple_of(10 * STATES_A_COMMAND) {
            let number = (n / (10 * STATES_A_COMMAND)) as usize % questions.len();
            robotctl::can_link::CanLink::send(&mut link, &questions[number].frame())?;
        }
    }
    bail!("the wheels never turned: {:?}", robot.obstacle())
}

fn driver() -> Driver {
    let wheels = Wheels {
        radius_m: 0.075,
        track_m: 0.4,
    };
    let limits = Limits {
        speed_mps: 0.3,
        turn_rps: 1.0,
        accel_mps2: 0.5,
        turn_accel_rps2: 2.0,
    };
    let gains = Gains {
        wheel_kd: 1.0,
        joint_kp: 20.0,
        joint_kd: 1.0,
    };
    Driver::new(wheels, limits, gains)
}

fn next_state(
    link: &mut PcLink,
    questions: &[LiveQuestion],
    robot: &mut RobotView,
) -> anyhow::Result<robot_app::link::Uplink> {
    loop {
        let heard = link.next(Instant::now() + PATIENCE)?;
        match heard.context("the board sends no more")? {
            Heard::Uplink(state) => return Ok(state),
            Heard::Tunnel(frame) => {
                let answers = questions.iter().filter_map(|asked| asked.answer(&frame));
                answers.for_each(|answer| robot.take(&answer));
            }
        }
    }
}

/// The radio arms in mode PC. While the robot is armed, settings are refused through the link too.
#[test]
fn a_joystick_drives_the_image_through_the_link() {
    let text = "name = \"drive\"\nseconds = 12\nplant = \"stand\"\n\
                [[at]]\nt = 0.1\nremote = { mode = 1 }\n\
                [[at]]\nt = 2.5\nremote = { enable = true }\n";
    let tool = Tool::at_link(|port| {
        let driven = drive(port, "drive-image.fifo", driver())?;
        let mut client = TuningClient::new(Box::new(driven.link), TIMEOUT);
        let write = client.write(settings::find(TRACK)?, 0.37);
        Ok((driven.fastest_rps, driven.after_rps, write))
    });
    let ((fastest_rps, after_rps, write), outcome) = run(job("drive", text), tool);
    assert!(fastest_rps > TURNING_RPS, "{fastest_rps}");
    assert!(after_rps.abs() < 0.5, "{after_rps}");
    let refused = matches!(
        write,
        Err(TuningError::Refused {
            reason: Ok(Refusal::Armed),
            ..
        })
    );
    assert!(refused, "{write:?}");
    assert_eq!(outcome.result.value("diag.link.crc_errors"), Some(0.0));
}

/// Only the pilot's switch makes it stand up.
#[test]
fn in_place_of_the_sticks_a_joystick_drives_the_standing_image() {
    let text = "name = \"sticks\"\nseconds = 12\nplant = \"free\"\n\
                [[at]]\nt = 0.1\nremote = { mode = 1 }\n\
                [[at]]\nt = 2.5\nremote = { enable = true }\n\
                [[at]]\nt = 3.0\nremote = { stand = true }\n";
    let tool = Tool::at_link(|port| {
        let driven = drive(port, "sticks-image.fifo", SticksDriver::new(0.4))?;
        Ok((driven.fastest_rps, driven.after_rps))
    });
    let ((fastest_rps, after_rps), outcome) = run(job("sticks", text), tool);
    assert!(fastest_rps > TURNING_RPS, "{fastest_rps}");
    assert!(after_rps.abs() < BALANCING_RPS, "{after_rps}");
    let height_m = outcome.result.value("truth.body.z").expect("a body");
    assert!(
        height_m > 0.18,
        "it stands: sitting it is at 0.12 m, now {height_m}"
    );
    assert_eq!(outcome.result.value("diag.link.crc_errors"), Some(0.0));
}
