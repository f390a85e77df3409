//! Reads registers of a servo.

use anyhow::{Result, bail};
use robot_arm::bus::register::{self, Register};

use super::{connection::Port, output::say};

#[derive(clap::Args)]
#[command(after_help = "Examples:
  armctl read --port /dev/ttyACM0 3                   all registers of servo 3
  armctl read --port /dev/ttyACM0 3 homing_offset mode")]
pub struct Read {
    #[command(flatten)]
    port: Port,
    /// Id
    #[arg(value_parser = clap::value_parser!(u8).range(0..=253))]
    id: u8,
    /// Names of registers; without one, all
    #[arg(value_name = "REGISTER")]
    registers: Vec<String>,
}

impl Read {
    pub fn run(self) -> Result<()> {
        let mut registers: Vec<Register> = Vec::new();
        for name in &self.registers {
            match register::find(name) {
                Some(register) => registers.push(register),
                None => {
                    let known: Vec<&str> = register::ALL.into_iter().map(Register::name).collect();
                    bail!(
                        "no register is called {name}; there are {}",
                        known.join(", ")
                    );
                }
            }
        }
        if registers.is_empty() {
            registers.extend(register::ALL);
        }
        let mut bus = self.port.open()?;
        for register in registers {
            let reading = bus.read(self.id, register)?;
            say!(
                "{:3}  {:<20} {}",
                register.address(),
                register.name(),
                reading.value
            )?;
        }
        Ok(())
    }
}
