//! `robotctl record`: records the sensors into a table, or what comes over link or CAN into an MCAP file.

mod can;
mod link;
mod progress;
mod sensors;

use std::path::PathBuf;

use anyhow::{Result, ensure};
use robotctl::transport::Transport;

use super::connection::{Connection, examples};

#[derive(clap::Args)]
#[command(
    after_help = concat!(
        "What is recorded:\n",
        "  --link PORT RUN.mcap     the robot's state, 417 times a second, armed or not\n",
        "  --can DEVICE RUN.mcap    all frames of the bus, and what the motors report in them; nothing is sent\n",
        "  any of both, RUN.csv     accelerometer, gyro and magnetometer of the disarmed robot, for `robotctl calibrate`\n",
        "`robotctl plot FILE` shows any of them; Foxglove and PlotJuggler open MCAP.\n\n",
        examples!("record", " run.mcap")
    )
)]
pub struct Record {
    #[command(flatten)]
    connection: Connection,
    /// File to write: a recording (.mcap), or a table of the sensors for calibration (.csv or any other ending)
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Length of the recording in s [default: 60 for a table, until Ctrl-C for an MCAP file]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u32).range(1..))]
    seconds: Option<u32>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

impl Record {
    pub fn run(self) -> Result<()> {
        let transport = self.connection.transport()?;
        ensure!(
            self.force || !self.file.exists(),
            "{} exists: name another file, or add --force",
            self.file.display()
        );
        if !self.is_mcap() {
            return sensors::record(&self.connection, &self.file, self.seconds);
        }
        match transport {
            Transport::Link(port) => link::record(&port, &self.file, self.seconds),
            Transport::Can(device) => can::record(&device, &self.file, self.seconds),
        }
    }

    fn is_mcap(&self) -> bool {
        let ending = self.file.extension();
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"))
    }
}
