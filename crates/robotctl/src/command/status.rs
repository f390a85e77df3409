//! `robotctl status`: shows the robot's state once or repeatedly.

use std::{thread, time::Duration};

use anyhow::{Result, ensure};
use robotctl::{status::Status as RobotStatus, tuning::TuningClient};

use super::{
    connection::{Connection, examples},
    output::{self, begin, say},
};

#[derive(clap::Args)]
#[command(after_help = examples!("status"))]
pub struct Status {
    #[command(flatten)]
    connection: Connection,
    /// Print all live values as one line of JSON
    #[arg(long)]
    json: bool,
    /// Repeat until Ctrl-C
    #[arg(long)]
    watch: bool,
    /// Pause between repetitions in ms
    #[arg(long, value_name = "MS", default_value_t = 500, requires = "watch")]
    every: u64,
}

impl Status {
    pub fn run(self) -> Result<()> {
        let mut client = self.connection.open()?;
        loop {
            self.show(&mut client)?;
            if !self.watch {
                return Ok(());
            }
            thread::sleep(Duration::from_millis(self.every));
        }
    }

    fn show(&self, client: &mut TuningClient) -> Result<()> {
        let status = RobotStatus::read(client)?;
        ensure!(
            !status.is_empty(),
            "this firmware shows no live values: it is older than this robotctl"
        );
        if self.json {
            say!("{}", status.to_json())?;
            return Ok(());
        }
        if self.watch {
            output::clear()?;
        }
        begin!("{status}")?;
        Ok(())
    }
}
