//! What is started, and what is done until the user ends it.

use std::{
    io::{self, IsTerminal, Write},
    path::PathBuf,
    sync::Arc,
    sync::mpsc::{self, Receiver, RecvTimeoutError},
    thread,
    time::Duration,
};

use anyhow::{Context, Result, ensure};
use clap::{Args, ValueEnum};
use robot_arm::calibration::{Calibration, Format, JointCalibration};
use robot_servo_model::{
    Bus, Fault, Port, SO101_JOINTS, Servo, So101, UnknownFault, Version, so101_servos,
};

use super::{
    line::{self, Line},
    plugs::Plugs,
    screen::{self, Around},
    view,
};

/// Time between two pictures.
const REDRAW: Duration = Duration::from_millis(100);

/// What is started, and what goes wrong there.
#[derive(Args)]
#[command(after_help = line::HELP)]
pub struct Sim {
    /// Name under which the port is found as well, such as /tmp/arm
    #[arg(long, value_name = "PATH")]
    at: Option<PathBuf>,
    /// Calibration whose ids the servos have, and with LeRobot's file its offsets and ranges as well
    #[arg(long, value_name = "FILE", conflicts_with = "factory")]
    arm: Option<PathBuf>,
    /// Servos as they leave the factory: each has id 1, and one is plugged in at a time
    #[arg(long)]
    factory: bool,
    /// Version of the servos
    #[arg(long, value_enum, default_value_t = Volts::V12)]
    volts: Volts,
    /// A fault from the start on; may be given more than once
    #[arg(long, value_name = "FAULT")]
    fault: Vec<Fault>,
    /// Bytes that are changed, such as 1%
    #[arg(long, value_name = "PERCENT", value_parser = |text: &str| named("corrupt", text))]
    corrupt: Option<Fault>,
    /// Bytes that are lost, such as 0.5%
    #[arg(long, value_name = "PERCENT", value_parser = |text: &str| named("drop", text))]
    drop: Option<Fault>,
    /// Seed of what goes wrong by chance
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Shows the arm in a browser of this computer as well
    #[arg(long)]
    view: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Volts {
    /// STS3215-C018, 12 V
    #[value(name = "12")]
    V12,
    /// STS3215-C001, 7.4 V
    #[value(name = "7.4")]
    V7,
}

fn named(name: &str, value: &str) -> Result<Fault, UnknownFault> {
    format!("{name}={value}").parse()
}

impl Sim {
    /// Serves the port until the user ends it.
    pub fn run(self) -> Result<()> {
        let mut bus = Bus::new(self.servos()?, self.seed).with_body(So101);
        let faults = self.fault.into_iter().chain(self.corrupt).chain(self.drop);
        faults.for_each(|fault| {
            bus.start(fault);
        });
        let mut plugs = Plugs::new(&mut bus, self.factory);
        let port = match &self.at {
            Some(link) => Port::open_at(bus, link)?,
            None => Port::open(bus)?,
        };
        println!("{}", screen::heading(port.path(), self.factory));
        let port = Arc::new(port);
        let mut said = String::new();
        if self.view {
            let address = view::serve(&port).context("no page for a browser")?;
            said = format!("open http://{address} in a browser");
            println!("{said}");
        }
        watch(&port, &mut plugs, &lines(), said)
    }

    fn servos(&self) -> Result<Vec<Servo>> {
        let version = match self.volts {
            Volts::V12 => Version::Volts12,
            Volts::V7 => Version::Volts7,
        };
        let servos = so101_servos(version).into_iter();
        if self.factory {
            return Ok(servos.map(|servo| servo.with_id(1)).collect());
        }
        let Some(file) = &self.arm else {
            return Ok(servos.collect());
        };
        let calibration = Calibration::load(file)?;
        let joints = calibration.joints();
        ensure!(
            joints.len() == SO101_JOINTS.len(),
            "{}: {} joints, and the emulated arm has {}",
            file.display(),
            joints.len(),
            SO101_JOINTS.len(),
        );
        servos
            .zip(joints)
            .map(|(servo, (name, joint))| {
                calibrated(servo, joint, calibration.format())
                    .with_context(|| format!("{}: {name}", file.display()))
            })
            .collect()
    }
}

/// A servo as the calibration left it. In a plain file all but the id is in the file alone.
fn calibrated(servo: Servo, joint: &JointCalibration, format: Format) -> Result<Servo> {
    let servo = servo.with_id(joint.id);
    Ok(match format {
        Format::Plain => servo,
        Format::LeRobot => servo.with_calibration(
            i16::try_from(joint.homing_offset)?,
            u16::try_from(joint.range_min)?,
            u16::try_from(joint.range_max)?,
        ),
    })
}

/// Does what the user types, and draws the arm if somebody looks.
fn watch(port: &Port, plugs: &mut Plugs, typed: &Receiver<String>, mut said: String) -> Result<()> {
    let is_seen = io::stdout().is_terminal();
    let mut is_first = true;
    loop {
        if is_seen {
            let mut bus = port.bus();
            let (views, faults) = (bus.view(), plugs.hide(bus.faults().collect()));
            drop(bus);
            let around = Around {
                port: port.path(),
                faults: &faults,
                stall: port.longest_stall(),
                said: &said,
            };
            let picture = screen::picture(&views, &around);
            io::stdout().write_all(screen::drawn(&picture, is_first).as_bytes())?;
            io::stdout().flush()?;
            is_first = false;
        }
        match typed.recv_timeout(REDRAW) {
            Err(RecvTimeoutError::Timeout) => {}
            // Without a keyboard it goes on until it is ended from outside.
            Err(RecvTimeoutError::Disconnected) => thread::sleep(REDRAW),
            Ok(text) => {
                // Enter has moved the cursor.
                is_first = true;
                said = match text.parse() {
                    Ok(Line::Quit) => return Ok(()),
                    Ok(line) => line.act(&mut port.bus(), plugs),
                    Err(error) => error.to_string(),
                };
                if !is_seen {
                    println!("> {said}");
                }
            }
        }
    }
}

/// Lines that the user types, read by a thread of their own.
fn lines() -> Receiver<String> {
    let (send, receive) = mpsc::channel();
    thread::spawn(move || {
        for line in io::stdin().lines().map_while(Result::ok) {
            if send.send(line).is_err() {
                return;
            }
        }
    });
    receive
}
