//! The commands of the tool; `--help` lists them.

mod calibrate;
mod mounting;
mod tune;

#[derive(clap::Subcommand)]
pub enum Command {
    /// Find a sensor's offsets and scales from recorded samples
    Calibrate {
        #[command(subcommand)]
        sensor: calibrate::Sensor,
    },
    /// Find out how board and magnetometer sit, by tilting the robot (docs/mounting.md)
    Mounting(mounting::Mounting),
    /// Read and change the robot's settings over CAN
    Tune(tune::Tune),
}

impl Command {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Calibrate { sensor } => sensor.run(),
            Self::Mounting(mounting) => mounting.run(),
            Self::Tune(tune) => tune.run(),
        }
    }
}
