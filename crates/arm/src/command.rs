//! The commands of the tool; `--help` lists them.

mod bench;
mod calibrate;
mod cartesian;
mod connection;
mod convert;
mod home;
mod joints;
mod look;
mod monitor;
mod output;
mod ping;
mod play;
mod read;
mod record;
mod recover;
mod release;
mod scan;
mod screen;
mod set_id;
mod sim;
mod stop;
mod teleoperate;

/// The end of the tool's help.
pub const EXAMPLES: &str = "Examples:
  armctl scan --port /dev/ttyACM0                 who is on the bus (Windows: --port COM5)
  armctl set-id --port /dev/ttyACM0 --from 1 --to 3
  armctl calibrate --port /dev/ttyACM0 --out left_arm.json
  armctl joints --port /dev/ttyACM0 --arm left_arm.json
  armctl sim --at /tmp/arm                        emulated servos, to try all of this without hardware
See docs/arm.md for the first hour.";

#[derive(clap::Subcommand)]
pub enum Command {
    /// List the servos on the bus, whatever their speed
    Scan(scan::Scan),
    /// Ask servos whether they are there
    Ping(ping::Ping),
    /// Read registers of a servo
    Read(read::Read),
    /// Show positions, loads, voltages and temperatures of all joints
    Monitor(monitor::Monitor),
    /// Give a servo its id
    SetId(set_id::SetId),
    /// Record homes and ranges of all joints, and store them
    Calibrate(calibrate::Calibrate),
    /// Turn a calibration file into one of the other format
    Convert(convert::Convert),
    /// Move all joints home
    Home(home::Home),
    /// Switch the torque off: the arm falls
    Release(release::Release),
    /// Bring joints back after an overload, heat or a wrong voltage
    Recover(recover::Recover),
    /// Move joints with the keys
    Joints(joints::Joints),
    /// Move the tool with the keys
    Cartesian(cartesian::Cartesian),
    /// Record a motion that is made by hand
    Record(record::Record),
    /// Play a recorded motion
    Play(play::Play),
    /// Let one arm follow another
    Teleoperate(teleoperate::Teleoperate),
    /// Start an arm of emulated servos behind a serial port of its own
    Sim(sim::Sim),
    /// Measure the bus, and the speed of inverse kinematics
    Bench(bench::Bench),
}

impl Command {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Scan(command) => command.run(),
            Self::Ping(command) => command.run(),
            Self::Read(command) => command.run(),
            Self::Monitor(command) => command.run(),
            Self::SetId(command) => command.run(),
            Self::Calibrate(command) => command.run(),
            Self::Convert(command) => command.run(),
            Self::Home(command) => command.run(),
            Self::Release(command) => command.run(),
            Self::Recover(command) => command.run(),
            Self::Joints(command) => command.run(),
            Self::Cartesian(command) => command.run(),
            Self::Record(command) => command.run(),
            Self::Play(command) => command.run(),
            Self::Teleoperate(command) => command.run(),
            Self::Sim(command) => command.run(),
            Self::Bench(command) => command.run(),
        }
    }
}
