//! The commands of the tool; `--help` lists them.

mod answer;
mod black_box;
mod calibrate;
mod connection;
mod drive;
mod first_board;
mod interrupt;
mod joint;
mod mounting;
pub mod output;
mod plot;
mod radio;
mod record;
mod status;
mod tune;

/// The end of the tool's help.
pub const EXAMPLES: &str = connection::examples!("status");

#[derive(clap::Subcommand)]
pub enum Command {
    /// Show what the robot is doing, and what keeps it from being armed
    Status(status::Status),
    /// Find a sensor's offsets and scales from recorded samples
    Calibrate {
        #[command(subcommand)]
        sensor: calibrate::Sensor,
    },
    /// Tilt the robot to find out how board and magnetometer are mounted (docs/mounting.md)
    Mounting(mounting::Mounting),
    /// Move the controls of an SBUS transmitter to find out their channels (docs/bring-up.md)
    Radio(radio::Radio),
    /// Record the robot's state (PC link), a CAN bus, or the sensors for calibration
    Record(record::Record),
    /// Show a recording as a page with plots
    Plot(plot::Plot),
    /// Drive the robot from the keyboard or with a joystick, over the PC link
    Drive(drive::Drive),
    /// Show what happened before and after a stop that nobody asked for (docs/black-box.md)
    #[command(name = "blackbox")]
    BlackBox(black_box::BlackBox),
    /// Read and change the robot's settings
    Tune(tune::Tune),
    /// Set a joint's zero
    Joint(joint::JointCommand),
    /// Walk through the checks of a first board, and write a report (docs/first-board.md)
    FirstBoard(first_board::FirstBoard),
}

impl Command {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Status(status) => status.run(),
            Self::Calibrate { sensor } => sensor.run(),
            Self::Mounting(mounting) => mounting.run(),
            Self::Radio(radio) => radio.run(),
            Self::Record(record) => record.run(),
            Self::Plot(plot) => plot.run(),
            Self::Drive(drive) => drive.run(),
            Self::BlackBox(black_box) => black_box.run(),
            Self::Tune(tune) => tune.run(),
            Self::Joint(joint) => joint.run(),
            Self::FirstBoard(first_board) => first_board.run(),
        }
    }
}
