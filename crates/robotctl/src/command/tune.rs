//! `robotctl tune`: the robot's settings over CAN.

use std::{num::NonZeroI16, path::PathBuf};

use anyhow::{Context, Result, bail};
use robotctl::{
    parameter_file::ParameterFile,
    settings::{self, Setting},
    tuning::{
        self, BringUpStep, Motor, SaveError, SaveTimeouts, Trial, TuningClient, WheelGeometry,
    },
};

use super::{
    connection::{Connection, examples},
    output::{begin, say},
};

#[derive(clap::Args)]
#[command(after_help = examples!("tune", " get heater.kp"))]
pub struct Tune {
    #[command(flatten)]
    connection: Connection,
    #[command(subcommand)]
    action: Action,
}

#[derive(clap::Subcommand)]
enum Action {
    /// List all settings with unit and range and, with --can or --link, their present values
    List {
        /// List only names that contain this
        filter: Option<String>,
    },
    /// Print one setting
    Get { name: String },
    /// Change one setting; the robot must be disarmed
    Set {
        name: String,
        /// A number, or one of the names that the setting has for its values
        #[arg(allow_negative_numbers = true)]
        value: String,
    },
    /// Change all settings that differ from those in a file; the robot must be disarmed
    Apply { file: PathBuf },
    /// Write the present values of all settings to a file
    Save { file: PathBuf },
    /// Restore the defaults of a group of settings, or of all; the robot must be disarmed
    Defaults {
        /// A group such as `heater`; without it, all groups
        group: Option<String>,
        /// Confirm that the robot's present values will be lost
        #[arg(long)]
        yes: bool,
    },
    /// Show whether the robot has saved its settings, and what it found in flash at boot
    Status,
    /// Show the wheel geometry or change parts of it
    Wheel(Wheel),
    /// Start or end bring-up of new hardware (docs/bring-up.md); the robot must be disarmed
    BringUp {
        #[command(subcommand)]
        step: Step,
    },
}

#[derive(clap::Subcommand)]
enum Step {
    /// End bring-up
    Off,
    /// Keep the robot from being armed; the log shows the joints
    ReadOnly,
    /// Enable the motors without torque once the robot is armed
    ZeroTorque,
    /// Put a small torque on one motor while the pilot holds the dead-man stick; the drive stick or --torque sets it
    Motor {
        motor: Motor,
        /// Torque of a joint in mN·m (at most 500) or current of a wheel in mA (at most 1000)
        #[arg(long, allow_negative_numbers = true, conflicts_with = "hold")]
        torque: Option<NonZeroI16>,
        /// Hold the angle that the motor has when the pilot takes the stick, with a soft spring
        #[arg(long)]
        hold: bool,
    },
}

impl Step {
    fn what_now(&self) -> &'static str {
        match self {
            Self::Off => "bring-up is off",
            Self::ReadOnly => {
                "bring-up: read only; the robot cannot be armed. Turn each joint by hand: `robotctl status --watch` \
                 shows its angle"
            }
            Self::ZeroTorque => {
                "bring-up: zero torque; once armed, motors are enabled and every joint and wheel still turns freely"
            }
            Self::Motor { .. } => {
                "bring-up: one motor; once armed, it gives a little torque while the dead-man stick is held"
            }
        }
    }

    fn request(&self) -> BringUpStep {
        match *self {
            Self::Off => BringUpStep::Off,
            Self::ReadOnly => BringUpStep::ReadOnly,
            Self::ZeroTorque => BringUpStep::ZeroTorque,
            Self::Motor {
                motor, hold: true, ..
            } => BringUpStep::OneMotor(motor, Trial::Hold),
            Self::Motor { motor, torque, .. } => {
                let trial = torque.map_or(Trial::Stick, Trial::Fixed);
                BringUpStep::OneMotor(motor, trial)
            }
        }
    }
}

#[derive(clap::Args)]
struct Wheel {
    #[arg(long)]
    radius_mm: Option<u16>,
    /// Distance between the centres of the wheels
    #[arg(long)]
    track_mm: Option<u16>,
    /// Motor turns for each turn of the wheel, such as 19.2
    #[arg(long)]
    gear_ratio: Option<f64>,
    /// Whether the left motor's positive direction drives backwards
    #[arg(long)]
    left_reversed: Option<bool>,
    #[arg(long)]
    right_reversed: Option<bool>,
}

impl Tune {
    pub fn run(self) -> Result<()> {
        match &self.action {
            Action::List { filter } => self.list(filter.as_deref().unwrap_or_default()),
            Action::Get { name } => self.get(name),
            Action::Set { name, value } => self.set(name, value),
            Action::Apply { file } => self.apply(file),
            Action::Save { file } => self.save(file),
            Action::Defaults { group, yes } => self.defaults(group.as_deref(), *yes),
            Action::Status => self.status(),
            Action::Wheel(wheel) => self.wheel(wheel),
            Action::BringUp { step } => self.bring_up(step),
        }
    }

    fn list(&self, filter: &str) -> Result<()> {
        let mut client = match self.connection.is_given() {
            true => Some(self.connection.open()?),
            false => None,
        };
        say!("{:<40} {:>12} {:<10} range", "setting", "value", "unit")?;
        for named in settings::all().filter(|n| n.full_name().contains(filter)) {
            let value = match &mut client {
                Some(client) => named.in_words(client.read(named)?),
                None => String::new(),
            };
            say!(
                "{:<40} {value:>12} {:<10} {}",
                named.full_name(),
                named.parameter.unit,
                short(named.range())
            )?;
        }
        Ok(())
    }

    fn get(&self, name: &str) -> Result<()> {
        let named = settings::find(name)?;
        let value = self.connection.open()?.read(named)?;
        say!("{}", shown(named, value))?;
        Ok(())
    }

    fn set(&self, name: &str, value: &str) -> Result<()> {
        let named = settings::find(name)?;
        let value = named.parse(value)?;
        let mut client = self.connection.open()?;
        let before = client.read(named)?;
        client.write(named, value)?;
        say!("{} (was {})", shown(named, value), named.in_words(before))?;
        confirm_saved(&mut client)
    }

    fn apply(&self, path: &std::path::Path) -> Result<()> {
        let file = ParameterFile::load(path)?;
        let mut client = self.connection.open()?;
        for applied in tuning::apply(&mut client, &file)? {
            let was = if applied.before == applied.after {
                "unchanged".to_owned()
            } else {
                format!("was {}", applied.named.in_words(applied.before))
            };
            say!("{} ({was})", shown(applied.named, applied.after))?;
        }
        confirm_saved(&mut client)
    }

    fn save(&self, path: &std::path::Path) -> Result<()> {
        let mut client = self.connection.open()?;
        let mut file = ParameterFile::default();
        for named in settings::all() {
            file.set(&named.full_name(), client.read(named)?);
        }
        file.save(path)?;
        say!("{} settings in {}", file.iter().len(), path.display())?;
        Ok(())
    }

    fn defaults(&self, group: Option<&str>, yes: bool) -> Result<()> {
        let group = group.map(settings::find_group).transpose()?;
        let whose = group.map_or("all groups", |group| group.name);
        if !yes {
            bail!(
                "this replaces the robot's settings of {whose} by the defaults; add --yes to do it (`robotctl tune \
                 save FILE` keeps a copy)"
            );
        }
        let mut client = self.connection.open()?;
        client.restore_defaults(group)?;
        say!("{whose}: defaults")?;
        confirm_saved(&mut client)
    }

    fn bring_up(&self, step: &Step) -> Result<()> {
        self.connection.open()?.bring_up(step.request())?;
        say!("{}", step.what_now())?;
        Ok(())
    }

    fn status(&self) -> Result<()> {
        let mut client = self.connection.open()?;
        match client.store()? {
            Some(report) => say!("{report}")?,
            None => say!("this firmware saves no settings: they last until it is reset")?,
        }
        if let Some(findings) = client.boot_findings()? {
            say!("{findings}")?;
        }
        Ok(())
    }

    fn wheel(&self, wheel: &Wheel) -> Result<()> {
        let mut client = self.connection.open()?;
        let before = client.read_geometry()?;
        let wanted = wheel.changed(before)?;
        if wanted != before {
            client
                .write_geometry(&wanted)
                .context("the wheel geometry was not changed")?;
        }
        let WheelGeometry {
            radius_mm,
            track_mm,
            ..
        } = wanted;
        say!("radius {radius_mm} mm, track {track_mm} mm")?;
        say!("gear ratio {}", f64::from(wanted.gear_ratio_x100) / 100.0)?;
        let direction = |reversed| if reversed { "reversed" } else { "forward" };
        say!("left motor {}", direction(wanted.left_reversed))?;
        say!("right motor {}", direction(wanted.right_reversed))?;
        if wanted == before {
            return Ok(());
        }
        confirm_saved(&mut client)
    }
}

impl Wheel {
    fn changed(&self, before: WheelGeometry) -> Result<WheelGeometry> {
        let gear_ratio_x100 = match self.gear_ratio {
            Some(ratio) => WheelGeometry::hundredths(ratio)?,
            None => before.gear_ratio_x100,
        };
        Ok(WheelGeometry {
            radius_mm: self.radius_mm.unwrap_or(before.radius_mm),
            track_mm: self.track_mm.unwrap_or(before.track_mm),
            gear_ratio_x100,
            left_reversed: self.left_reversed.unwrap_or(before.left_reversed),
            right_reversed: self.right_reversed.unwrap_or(before.right_reversed),
        })
    }
}

/// Waits until the robot may be switched off.
pub(super) fn confirm_saved(client: &mut TuningClient) -> Result<()> {
    begin!("saving … ")?;
    let done = tuning::wait_until_saved(client, SaveTimeouts::default());
    say!("{}", if done.is_ok() { "saved" } else { "not saved" })?;
    match done {
        // That firmware never saves settings, so this is no failure of the command.
        Err(error @ SaveError::NeverSaves) => eprintln!("note: {error}"),
        done => {
            done?;
        }
    }
    Ok(())
}

fn shown(named: Setting, value: f32) -> String {
    let (name, unit) = (named.full_name(), named.parameter.unit);
    let text = format!("{name} = {} {unit}", named.in_words(value));
    text.trim_end().to_owned()
}

/// Shortens a range to fit on one line of a list.
fn short(range: String) -> String {
    const MOST: usize = 60;
    match range.char_indices().nth(MOST) {
        Some((end, _)) => format!("{} …", range.get(..end).unwrap_or_default()),
        None => range,
    }
}
