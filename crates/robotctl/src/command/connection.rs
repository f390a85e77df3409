//! The option that names the CAN bus.

use anyhow::{Context, Result};
use robotctl::{
    can_link::CanDevice,
    tuning::{Timeouts, TuningClient},
};

#[derive(clap::Args)]
pub struct Connection {
    /// Serial port of an slcan adapter (Windows: COM3, macOS: /dev/cu.usbmodem1101, Linux: /dev/ttyACM0, emulated board:
    /// /dev/pts/N) or, on Linux, a CAN interface (can0)
    #[arg(long, value_name = "DEVICE", global = true)]
    can: Option<CanDevice>,
}

impl Connection {
    pub fn is_given(&self) -> bool {
        self.can.is_some()
    }

    pub fn open(&self) -> Result<TuningClient> {
        let device = self.can.as_ref().context(
            "say where the CAN bus is: --can /dev/ttyACM0 or --can COM3 (slcan adapter) or, on Linux, --can can0",
        )?;
        Ok(TuningClient::new(device.open()?, Timeouts::default()))
    }
}
