//! `policy check`: are the policy's joints those of the robot?

use std::{
    process::ExitCode,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use anyhow::{Context, bail};
use robot_app::link::Heard;
use robot_description::{Robot, path_of};
use robot_policy::{
    PolicyDescription,
    check::{self, HandTurns, Row},
    fit,
    robot::LinkRobot,
};
use robotctl::pc_link::{self, PcLink};

use super::place::Place;

/// The first state must come within this time.
const FIRST_STATE: Duration = Duration::from_secs(2);
/// The state must go on within this time.
const SILENCE: Duration = Duration::from_millis(500);

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Check {
    #[command(flatten)]
    place: Place,
    /// PC link: the serial port (/dev/ttyUSB0, COM4, the emulated board's /dev/pts/N) at UART2 of the C board
    #[arg(long, value_name = "PORT")]
    link: String,
    /// The robot's description, the name of a file in robots/ or a path [default: that of --robot]
    #[arg(long, value_name = "ROBOT")]
    description: Option<String>,
    /// Only the table
    #[arg(long)]
    table: bool,
}

const EXAMPLES: &str = "\
It sends nothing. Disarm the robot, so that its joints can be turned by hand. The table has each joint of the policy beside \
the motor that it is mapped to. Then turn one joint after the other: its name and sign appear, and what the robot's part did. \
The exit code is 0 if the table has no error.

Example:
  policy check --robot fivebar --config flat --link /dev/ttyUSB0";

impl Check {
    pub fn run(self) -> anyhow::Result<ExitCode> {
        let policy = match self.place.described()? {
            Some(policy) => policy,
            None => self.place.load()?.0,
        };
        let description = self.description.as_ref().unwrap_or(&self.place.robot);
        let description = Robot::read(&path_of(description))?;
        let mut robot = LinkRobot::new(&policy)?;
        let mut link = PcLink::open(&self.link)?;
        if !next(&mut link, &mut robot, FIRST_STATE)? {
            let why = pc_link::why_silent(&self.link, &link.traffic());
            bail!("no state of the robot comes: {why}");
        }
        let rows = check::rows(&policy, &description, robot.reading());
        print(&rows);
        let faults = fit::faults(&policy, &description);
        for fault in faults.iter().filter(|it| it.joint.is_none()) {
            println!("✗ {}", fault.text);
        }
        let has_error = faults.iter().any(|fault| fault.is_error);
        if !self.table {
            watch(&policy, &mut link, &mut robot)?;
        }
        Ok(if has_error {
            ExitCode::FAILURE
        } else {
            ExitCode::SUCCESS
        })
    }
}

/// Reads the next state. Returns false if none comes in time.
fn next(link: &mut PcLink, robot: &mut LinkRobot, within: Duration) -> anyhow::Result<bool> {
    let until = Instant::now() + within;
    while let Some(heard) = link.next(until)? {
        if let Heard::Uplink(state) = heard {
            robot.read(&state)?;
            return Ok(true);
        }
    }
    Ok(false)
}

fn print(rows: &[Row]) {
    println!("joint of the policy     motor of the link       sense   default   measured   range");
    for (index, row) in rows.iter().enumerate() {
        let sense = if row.is_reversed { "-" } else { "+" };
        let default = row
            .default_rad
            .map_or("-".to_owned(), |rad| format!("{rad:+.3}"));
        let range = row.range_rad.map_or("-".to_owned(), |[low, high]| {
            format!("{low:+.2} … {high:+.2}")
        });
        println!(
            "{index:>2} {:<20} {:>2} {:<20} {sense:^6} {default:>8} {:>+10.3}   {range}",
            row.joint, row.motor, row.motor_name, row.measured_rad
        );
        for error in &row.errors {
            println!("   ✗ {error}");
        }
        for hint in &row.hints {
            println!("   ! {hint}");
        }
    }
    if rows.iter().all(|row| row.errors.is_empty()) {
        println!("✓ names and motors agree");
    }
}

/// Names each joint that is turned by hand, until all were.
fn watch(
    policy: &PolicyDescription,
    link: &mut PcLink,
    robot: &mut LinkRobot,
) -> anyhow::Result<()> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let caught = interrupted.clone();
    ctrlc::set_handler(move || caught.store(true, Ordering::Relaxed))
        .context("cannot catch Ctrl-C")?;
    println!("\nTurn one joint after the other by hand, by a hand's breadth; Ctrl-C ends.");
    let mut turns = HandTurns::new(policy);
    let mut is_seen = vec![false; policy.joints.len()];
    while !interrupted.load(Ordering::Relaxed) && is_seen.contains(&false) {
        if !next(link, robot, SILENCE)? {
            bail!("the robot's state no longer comes: is the cable in, and is the robot on?");
        }
        let Some(turned) = turns.take(robot.reading()) else {
            continue;
        };
        is_seen[turned.joint] = true;
        let name = &policy.joints[turned.joint].name;
        let left = is_seen.iter().filter(|seen| !**seen).count();
        println!(
            "{name:<20} {:+.2} rad: {}, is that so?   ({left} joints left)",
            turned.by_rad, turned.seen
        );
    }
    Ok(())
}
