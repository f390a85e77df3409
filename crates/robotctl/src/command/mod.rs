//! The commands of the tool; `--help` lists them.

mod calibrate;

#[derive(clap::Subcommand)]
pub enum Command {
    /// Find a sensor's offsets and scales from recorded samples
    Calibrate {
        #[command(subcommand)]
        sensor: calibrate::Sensor,
    },
}

impl Command {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Calibrate { sensor } => sensor.run(),
        }
    }
}
