//! `robotctl drive`: steers the robot over the PC link.

mod controls;
mod pilot;
mod screen;
mod session;
mod signed;

use std::{cell::RefCell, path::PathBuf, rc::Rc};

use anyhow::{Context, Result, ensure};
use robotctl::{
    drive::{Driver, Gains, JoystickMap, Limits, SticksDriver, Wheels},
    pc_link::{PcLink, SharedLink},
    settings,
    tuning::{Timeouts, TuningClient},
};

use super::connection::serial_port;
use controls::Controls;
use pilot::Pilot;
use session::Session;

#[derive(clap::Args)]
#[command(after_help = "\
The robot follows only while the radio's mode switch is at PC and the radio has armed it. Enable switch and e-stop of \
the radio stop it at any time, and so does every error here.

Keys: W, S, A, D or the arrows drive and turn, Q and E do both; the key itself is the dead-man. Space stops, Esc or \
Ctrl-C ends. Terminals that report when a key is let go (kitty, foot, WezTerm, Ghostty, the console of Windows) stop the \
robot at once and let keys combine. In all others a key counts as let go when it repeats no more: up to 0.2 s later, 0.7 s \
after a short tap.

A robot that stands takes no commands for its motors: --sticks sends what the sticks would say, to the robot's own \
controller, standing or sitting. It still stands up and sits down by the radio's stand switch alone. Keys: R and F lengthen \
and shorten the legs, Z and C tilt to the left and to the right, J jumps.

Examples:
  robotctl drive --link /dev/ttyUSB0
      from the keyboard (Windows: COM4)
  robotctl drive --link /dev/ttyUSB0 --joystick /dev/input/js0
      with a gamepad: left stick drives, right stick turns, left shoulder button (button 4) is the dead-man
  robotctl drive --link /dev/ttyUSB0 --joystick /dev/input/js0 --map forward=1-,turn=0-,dead-man=5
      with another joystick; the screen shows the numbers of what you move
  robotctl drive --link /dev/ttyUSB0 --sticks --share 0.3
      a standing robot, at up to 30 % of its highest speed and turn; with a gamepad (--joystick) the cross sets height and \
roll, and the lowest button (button 0) jumps")]
pub struct Drive {
    /// PC link: the serial port (/dev/ttyUSB0, COM4, the emulated board's /dev/pts/N) at UART2 of the C board
    #[arg(long, value_name = "PORT", value_parser = serial_port)]
    link: Option<String>,
    /// CAN carries no commands of a PC.
    #[arg(long, hide = true)]
    can: Option<String>,
    /// Joystick of Linux, such as /dev/input/js0
    #[arg(long, value_name = "DEVICE")]
    joystick: Option<PathBuf>,
    /// Axes and buttons of the joystick by number; `-` reverses an axis [default: forward=1-,turn=3-,dead-man=4,height=7-,roll=6,jump=0]
    #[arg(long, requires = "joystick")]
    map: Option<JoystickMap>,
    /// Send what the sticks would say, in place of speeds for the wheels: steers a robot that stands, and one that sits
    #[arg(long, conflicts_with_all = ["speed", "turn", "ramp", "wheel_kd"])]
    sticks: bool,
    /// With --sticks: most of the robot's highest speed and turn, up to 1
    #[arg(long, value_name = "SHARE", requires = "sticks", default_value_t = 0.2)]
    share: f64,
    /// Highest speed in m/s
    #[arg(long, value_name = "M/S", default_value_t = 0.3)]
    speed: f64,
    /// Highest rate of turn in rad/s
    #[arg(long, value_name = "RAD/S", default_value_t = 1.0)]
    turn: f64,
    /// Acceleration in m/s²; that of the turn is in proportion
    #[arg(long, value_name = "M/S2", default_value_t = 0.5)]
    ramp: f64,
    /// Damping of the wheels in N·m·s/rad: torque for each rad/s that a wheel is off its target
    #[arg(long, value_name = "KD", default_value_t = 1.0)]
    wheel_kd: f32,
}

impl Drive {
    pub fn run(self) -> Result<()> {
        ensure!(
            self.can.is_none(),
            "driving needs the PC link: --link PORT instead of --can"
        );
        let port = self.link.clone().context(
            "say where the robot is: --link /dev/ttyUSB0 or --link COM4, the port of the PC link",
        )?;
        for (name, value) in [
            ("speed", self.speed),
            ("turn", self.turn),
            ("ramp", self.ramp),
        ] {
            ensure!(value.is_finite() && value > 0.0, "--{name} must be above 0");
        }
        ensure!(
            (0.0..=1000.0).contains(&self.wheel_kd),
            "--wheel-kd must be 0 to 1000"
        );
        ensure!(
            self.share > 0.0 && self.share <= 1.0,
            "--share must be above 0, and at most 1"
        );
        let link = PcLink::open(&port)?;
        let (link, pilot) = if self.sticks {
            (link, Pilot::Sticks(SticksDriver::new(self.share)))
        } else {
            self.prepare(link)?
        };
        let map = self.map.unwrap_or_default();
        let controls = Controls::open(self.joystick.as_deref(), map, self.sticks)?;
        Session::new(port, link, pilot, controls)?.run()
    }

    /// Reads geometry and gains from the robot.
    fn prepare(&self, link: PcLink) -> Result<(PcLink, Pilot)> {
        let link = Rc::new(RefCell::new(link));
        let mut client = TuningClient::new(Box::new(SharedLink(link.clone())), Timeouts::default());
        let mut read = |name: &str| -> Result<f32> { Ok(client.read(settings::find(name)?)?) };
        let wheels = Wheels {
            radius_m: read("wheel-geometry.radius-m")?.into(),
            track_m: read("wheel-geometry.track-m")?.into(),
        };
        let gains = Gains {
            wheel_kd: self.wheel_kd,
            joint_kp: read("joint-controller.hold-kp")?,
            joint_kd: read("joint-controller.hold-kd")?,
        };
        drop(client);
        let limits = Limits {
            speed_mps: self.speed,
            turn_rps: self.turn,
            accel_mps2: self.ramp,
            turn_accel_rps2: self.ramp * self.turn / self.speed,
        };
        let link = Rc::into_inner(link).context("nobody else has the link")?;
        let driver = Driver::new(wheels, limits, gains);
        Ok((link.into_inner(), Pilot::Motors(driver)))
    }
}
