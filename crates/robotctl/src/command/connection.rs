//! The options that say where the robot is.

use anyhow::{Context, Result, ensure};
use robotctl::{
    can_link::{CanDevice, GatewayAddress},
    transport::Transport,
    tuning::{Timeouts, TuningClient},
};

const HEADING: &str = "Where the robot is (one of the two)";

/// One of the two is needed.
#[derive(clap::Args)]
pub struct Connection {
    /// CAN bus: an interface of Linux (can0), the serial port of an slcan adapter (/dev/ttyACM0, COM3,
    /// /dev/cu.usbmodem1101, the emulated board's /dev/pts/N), or a CAN-to-Ethernet gateway
    /// (tcp:192.168.0.7:20001, udp:192.168.0.7:20001)
    #[arg(long, value_name = "DEVICE", global = true, conflicts_with = "link", help_heading = HEADING)]
    can: Option<CanDevice>,
    /// PC link: the serial port (/dev/ttyUSB0, COM4, the emulated board's /dev/pts/N) at UART2 of the C board
    #[arg(long, value_name = "PORT", global = true, value_parser = serial_port, help_heading = HEADING)]
    link: Option<String>,
}

/// Takes the name of a serial port.
pub fn serial_port(text: &str) -> Result<String, String> {
    if GatewayAddress::parse(text).is_some() {
        return Err("a gateway carries CAN, not the PC link: use --can".to_owned());
    }
    Ok(text.to_owned())
}

impl Connection {
    pub fn is_given(&self) -> bool {
        self.can.is_some() || self.link.is_some()
    }

    /// Returns the way to the robot.
    pub fn transport(&self) -> Result<Transport> {
        let given = (self.can.clone(), self.link.clone());
        // Global options before and after a subcommand do not see each other's conflicts.
        ensure!(
            !matches!(given, (Some(_), Some(_))),
            "--can and --link exclude each other: name one of them"
        );
        let can = given.0.map(Transport::Can);
        can.or(given.1.map(Transport::Link)).context(
            "say where the robot is: --can can0 (SocketCAN), --can /dev/ttyACM0 or --can COM3 (slcan adapter), --can \
             tcp:192.168.0.7:20001 (gateway), or --link /dev/ttyUSB0 or --link COM4 (PC link)",
        )
    }

    pub fn open(&self) -> Result<TuningClient> {
        let link = self.transport()?.open()?;
        Ok(TuningClient::new(link, Timeouts::default()))
    }

    /// Returns the options to type for the same robot.
    pub fn words(&self) -> String {
        match (&self.can, &self.link) {
            (Some(device), _) => format!("--can {device}"),
            (None, Some(port)) => format!("--link {port}"),
            (None, None) => "--can DEVICE".to_owned(),
        }
    }
}

/// The end of a command's help: an example for each way to the robot.
macro_rules! examples {
    ($command:literal) => {
        $crate::command::connection::examples!($command, "")
    };
    ($command:literal, $rest:literal) => {
        concat!(
            "Examples:\n  robotctl ",
            $command,
            " --can can0",
            $rest,
            "\n      through a CAN interface (SocketCAN, Linux)\n  robotctl ",
            $command,
            " --can /dev/ttyACM0",
            $rest,
            "\n      through an slcan adapter (Windows: COM3, macOS: /dev/cu.usbmodem1101)\n  robotctl ",
            $command,
            " --can tcp:192.168.0.7:20001",
            $rest,
            "\n      through a CAN-to-Ethernet gateway (or udp:)\n  robotctl ",
            $command,
            " --link /dev/ttyUSB0",
            $rest,
            "\n      through the PC link, a serial adapter at UART2 of the C board (Windows: COM4)"
        )
    };
}

pub(crate) use examples;
