//! Gives a servo its id.

use anyhow::{Result, bail};
use robot_arm::bus::Presence;

use super::{connection::Port, output::say};

#[derive(clap::Args)]
#[command(
    after_help = "New servos all have the id 1: connect one alone, give it its id, then connect the next.

Example:
  armctl set-id --port /dev/ttyACM0 --from 1 --to 6"
)]
pub struct SetId {
    #[command(flatten)]
    port: Port,
    /// The id that it has
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u8).range(0..=253))]
    from: u8,
    /// The id that it gets
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u8).range(0..=253))]
    to: u8,
}

impl SetId {
    pub fn run(self) -> Result<()> {
        let Self { from, to, .. } = self;
        let mut bus = self.port.open()?;
        if from == to {
            bail!("--from and --to are the same id: nothing is to be done");
        }
        match bus.presence(to)? {
            Presence::Absent => {}
            Presence::Present => bail!(
                "a servo on this bus has the id {to} already, and two with one id disturb each other: connect only the servo \
                 whose id is to change"
            ),
            Presence::Damaged => {
                bail!("several servos answer to the id {to}: connect one servo alone")
            }
        }
        if bus.presence(from)? == Presence::Damaged {
            bail!(
                "several servos answer to the id {from}, as new ones do: connect one servo alone, or all of them get the id {to}"
            );
        }
        bus.change_id(from, to)?;
        say!("servo {from} is servo {to} now, also after its power was off")?;
        Ok(())
    }
}
