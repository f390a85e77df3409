//! Lists the servos on the bus.

use anyhow::{Result, bail};
use robot_arm::bus::{BAUD_RATES, Identity, Presence, ServoBus};

use super::{connection::Port, output::say};

#[derive(clap::Args)]
#[command(after_help = "Examples:
  armctl scan --port /dev/ttyACM0              ids 0 to 30 at every speed (Windows: --port COM5)
  armctl scan --port /dev/ttyACM0 --ids 0-253  all ids
  armctl scan --port /dev/ttyACM0 --only-baud  only at --baud")]
pub struct Scan {
    #[command(flatten)]
    port: Port,
    /// Ids to ask
    #[arg(long, value_name = "FROM-TO", default_value = "0-30", value_parser = ids)]
    ids: (u8, u8),
    /// Ask at --baud only
    #[arg(long)]
    only_baud: bool,
    /// Print a list for scripts
    #[arg(long)]
    json: bool,
}

fn ids(text: &str) -> Result<(u8, u8), String> {
    let (from, to) = text.split_once('-').unwrap_or((text, text));
    let id = |text: &str| {
        text.trim()
            .parse::<u8>()
            .ok()
            .filter(|id| *id <= robot_arm::bus::LAST_ID)
    };
    match (id(from), id(to)) {
        (Some(from), Some(to)) if from <= to => Ok((from, to)),
        _ => Err(format!("{text}: ids are 0 to 253, such as 1-6")),
    }
}

/// A servo that was found.
#[derive(serde::Serialize)]
struct Found {
    bps: u32,
    #[serde(flatten)]
    identity: Identity,
}

impl Scan {
    pub fn run(self) -> Result<()> {
        let mut bus = self.port.open()?;
        let mut rates = vec![self.port.baud];
        if !self.only_baud {
            rates.extend(BAUD_RATES.into_iter().filter(|bps| *bps != self.port.baud));
        }
        let (mut found, mut damaged) = (Vec::new(), Vec::new());
        for bps in rates {
            bus.set_baud(bps)?;
            for id in self.ids.0..=self.ids.1 {
                match bus.presence(id)? {
                    Presence::Absent => {}
                    Presence::Damaged => damaged.push((bps, id)),
                    Presence::Present => {
                        let identity = bus.identify(id)?;
                        self.tell(&Found { bps, identity })?;
                        found.push(Found { bps, identity });
                    }
                }
            }
        }
        if self.json {
            say!("{}", serde_json::to_string(&found)?)?;
            return Ok(());
        }
        for (bps, id) in &damaged {
            say!(
                "id {id:3} at {bps} b/s: damaged answers. Two servos with this id? Connect one alone and give it another \
                 (armctl set-id)"
            )?;
        }
        if found.is_empty() && damaged.is_empty() {
            bail!("{}", nobody(&bus, self.ids));
        }
        say!("{} servos", found.len())?;
        Ok(())
    }

    fn tell(&self, found: &Found) -> Result<()> {
        if self.json {
            return Ok(());
        }
        let Identity {
            id,
            model,
            firmware_major,
            firmware_minor,
            position,
            voltage_dv,
            temperature_c,
            alarms,
        } = found.identity;
        let name = if model == 777 { "STS3215" } else { "unknown" };
        say!(
            "id {id:3} at {} b/s: model {model} ({name}), firmware {firmware_major}.{firmware_minor}, position {position}, {:.1} \
             V, {temperature_c} °C, alarms: {alarms}",
            found.bps,
            f64::from(voltage_dv) / 10.0
        )?;
        Ok(())
    }
}

fn nobody(bus: &ServoBus, (from, to): (u8, u8)) -> String {
    let statistics = bus.statistics();
    if statistics.stray_bytes == 0 && statistics.damaged == 0 {
        format!(
            "no servo with an id of {from} to {to} answers at {}, and not one byte came. Is the servos' own supply on (USB \
             feeds no servo), is the cable at the adapter's servo plug, and is the adapter's jumper on USB (B)?",
            bus.port()
        )
    } else {
        format!(
            "no servo with an id of {from} to {to} answers at {}, but {} bytes came: is another device at this port, or a \
             servo at another speed or id (--ids 0-253)?",
            bus.port(),
            statistics.stray_bytes
        )
    }
}
