//! `policy run`: a policy drives the robot.

mod session;

use std::{
    cell::RefCell,
    net::SocketAddr,
    path::PathBuf,
    process::ExitCode,
    rc::Rc,
    time::{Duration, Instant},
};

use anyhow::{Context, bail, ensure};
use robot_description::{Robot, path_of};
use robot_policy::{
    PolicyDescription,
    command_source::{CommandFile, CommandSource, Speeds},
    fit,
    live::Live,
    log::Log,
    machine::Timing,
    runner::Runner,
};
use robotctl::{
    drive::JoystickMap,
    pc_link::{PcLink, SharedLink},
    settings,
    tuning::{Timeouts, TuningClient},
};
use session::{Beat, FIRST_STATE, Session};

use super::place::Place;

/// Speeds of full sticks where neither the user nor the policy says any.
const FORWARD_MPS: f32 = 0.3;
const YAW_RPS: f32 = 1.0;

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Run {
    #[command(flatten)]
    place: Place,
    /// PC link: the serial port (/dev/ttyUSB0, COM4, the emulated board's /dev/pts/N) at UART2 of the C board
    #[arg(long, value_name = "PORT")]
    link: String,
    /// The robot's description, the name of a file in robots/ or a path [default: that of --robot]
    #[arg(long, value_name = "ROBOT")]
    description: Option<String>,
    /// Send nothing: print what the policy sees and would command, whatever the radio says
    #[arg(long)]
    dry_run: bool,
    /// Answer each state of an emulated board that waits for that (`sim --link pty --lockstep`), and go by its clock: for a computer
    /// that is too slow for real time
    #[arg(long, conflicts_with = "dry_run")]
    lockstep: bool,
    /// Where to go
    #[arg(long, value_enum, default_value_t = Source::Radio)]
    commands: Source,
    /// Joystick of Linux, such as /dev/input/js0
    #[arg(long, value_name = "DEVICE", required_if_eq("commands", "joystick"))]
    joystick: Option<PathBuf>,
    /// Axes and buttons of the joystick by number; `-` reverses an axis [default: forward=1-,turn=3-,dead-man=4]
    #[arg(long, requires = "joystick", conflicts_with = "map_file")]
    map: Option<JoystickMap>,
    /// File with such a map
    #[arg(long, requires = "joystick", value_name = "FILE")]
    map_file: Option<PathBuf>,
    /// File of commands, lines of `t vx vy wz`: s since the policy took over, m/s, m/s, rad/s
    #[arg(long, value_name = "FILE", required_if_eq("commands", "file"))]
    file: Option<PathBuf>,
    /// Speed of a full stick in m/s [default: the policy's range, else 0.3]
    #[arg(long, value_name = "M/S")]
    speed: Option<f32>,
    /// Turn rate of a full stick in rad/s [default: the policy's range, else 1.0]
    #[arg(long, value_name = "RAD/S")]
    turn: Option<f32>,
    /// Time in s to get from the measured pose to the default pose
    #[arg(long, value_name = "S", default_value_t = Timing::default().get_up_s)]
    get_up: f64,
    /// Time in s in the default pose before the policy takes over
    #[arg(long, value_name = "S", default_value_t = Timing::default().hold_s)]
    hold: f64,
    /// Get down after so many s of the policy
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Log, an MCAP file for Foxglove or PlotJuggler
    #[arg(long, value_name = "FILE.mcap")]
    log: Option<PathBuf>,
    /// Show the same live: Foxglove opens ws://ADDRESS as a Foxglove WebSocket
    #[arg(long, value_name = "ADDRESS", num_args = 0..=1, default_missing_value = "127.0.0.1:8765")]
    live: Option<SocketAddr>,
}

/// Where commands come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Source {
    /// The radio's right stick
    Radio,
    /// A joystick; its dead-man has to be held
    Joystick,
    /// W S A D or arrows; Space stops, Esc ends
    Keyboard,
    /// Lines of a file
    File,
}

const EXAMPLES: &str = "\
The robot obeys only while the radio's mode is PC, its pilot has armed, and the stand switch is down. Then it gets up, the \
policy drives, and it gets down again at Ctrl-C. Enable switch and e-stop of the radio stop it at any time. Lift it off the \
ground for the first run.

The exit code is 0 if the user ended the run.

Examples:
  policy run --robot fivebar --config flat --link /dev/ttyUSB0 --dry-run
      prints observations and targets, and sends nothing
  policy run --robot fivebar --config flat --link /dev/ttyUSB0 --log run.mcap
      the right stick of the radio drives
  policy run --robot fivebar --config flat --link /dev/ttyUSB0 --commands joystick --joystick /dev/input/js0
  policy run --robot fivebar --config flat --link /dev/ttyUSB0 --commands file --file drive.txt --seconds 60";

/// Puts the current that the robot's wheels may have into its description. A robot that does not answer leaves it as it is: the
/// run will say what is wrong.
fn read_current_limit(mut link: PcLink, robot: &mut Robot) -> anyhow::Result<PcLink> {
    // One that has just been switched on has to boot.
    if link.next(Instant::now() + FIRST_STATE)?.is_none() {
        return Ok(link);
    }
    let setting = settings::find("wheel-controller.current-limit-ma")?;
    let shared = SharedLink(Rc::new(RefCell::new(link)));
    let mut client = TuningClient::new(Box::new(shared.clone()), Timeouts::default());
    if let Ok(limit_ma) = client.read(setting) {
        robot.wheels.current_limit_a = f64::from(limit_ma) / 1e3;
    }
    drop(client);
    let link = Rc::into_inner(shared.0).context("the link has another user")?;
    Ok(link.into_inner())
}

impl Run {
    pub fn run(self) -> anyhow::Result<ExitCode> {
        for (name, seconds) in [("get-up", self.get_up), ("hold", self.hold)] {
            ensure!(
                seconds.is_finite() && seconds >= 0.0,
                "--{name} must be 0 or more"
            );
        }
        let (policy, mut model) = self.place.load()?;
        let description = self.description.as_ref().unwrap_or(&self.place.robot);
        let mut robot = Robot::read(&path_of(description))?;
        let timing = Timing {
            get_up_s: self.get_up,
            hold_s: self.hold,
            ..Timing::default()
        };
        let network = Box::new(move |input: &[f32], output: &mut [f32]| {
            let ran = model.run(input, output);
            ran.map_err(|error| error.to_string())
        });
        let runner = Runner::new(&policy, &robot, network, timing)?;
        let log = self
            .log
            .as_ref()
            .map(|path| Log::create(path, &policy))
            .transpose()?;
        let live = self
            .live
            .map(|address| Live::listen(address, &policy))
            .transpose()?;
        if let Some(live) = &live {
            println!("live: open ws://{} in Foxglove", live.address());
        }
        let period = Duration::from_secs_f32(policy.control_period_s);
        let beat = (!self.dry_run).then(|| Beat::new(period, self.lockstep));
        let mut link = PcLink::open(&self.link)?;
        // A dry run sends no question either.
        if let Some(beat) = &beat {
            println!("{}", beat.prepare());
            link = read_current_limit(link, &mut robot)?;
        }
        for fault in fit::faults(&policy, &robot) {
            let joint = fault.joint.map_or("", |it| &policy.joints[it].name);
            println!("note: {joint}: {}", fault.text);
        }
        let source = self.source(&policy)?;
        let mut session = Session::new(self.link.clone(), link, runner, source, &policy)?;
        session.seconds = self.seconds;
        session.log = log;
        session.live = live;
        match beat {
            Some(beat) => session.run(beat),
            None => session.rehearse(period),
        }
    }

    fn source(&self, policy: &PolicyDescription) -> anyhow::Result<CommandSource> {
        let [forward, _, yaw] = policy.command_ranges.map(|[_, high]| high);
        // A policy that states no range has the largest number there is.
        let stated = |value: f32, other| if value < f32::MAX { value } else { other };
        let speeds = Speeds {
            forward_mps: self.speed.unwrap_or(stated(forward, FORWARD_MPS)),
            yaw_rps: self.turn.unwrap_or(stated(yaw, YAW_RPS)),
        };
        Ok(match self.commands {
            Source::Radio => CommandSource::Radio(speeds),
            Source::Keyboard => CommandSource::keyboard(speeds)?,
            Source::Joystick => {
                let device = self
                    .joystick
                    .as_ref()
                    .context("name the joystick: --joystick /dev/input/js0")?;
                CommandSource::joystick(device, self.joystick_map()?, speeds)?
            }
            Source::File => {
                let file = self
                    .file
                    .as_ref()
                    .context("name the file: --file drive.txt")?;
                CommandSource::File(CommandFile::read(file)?)
            }
        })
    }

    fn joystick_map(&self) -> anyhow::Result<JoystickMap> {
        let Some(path) = &self.map_file else {
            return Ok(self.map.unwrap_or_default());
        };
        let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
        let parts = text
            .lines()
            .map(|line| line.split('#').next().unwrap_or("").trim());
        let parts: Vec<_> = parts.filter(|part| !part.is_empty()).collect();
        if parts.is_empty() {
            bail!("{}: it names no axis, such as forward=1-", path.display());
        }
        let map: Result<JoystickMap, _> = parts.join(",").parse();
        map.with_context(|| path.display().to_string())
    }
}
