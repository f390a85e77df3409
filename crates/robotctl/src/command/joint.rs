//! `robotctl joint`: sets a joint's zero.

use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use robotctl::{
    settings,
    tuning::{self, Joint, TuningClient},
};

use super::{
    connection::{Connection, examples},
    output::say,
    tune::confirm_saved,
};

#[derive(clap::Args)]
#[command(after_help = examples!("joint", " zero left-front"))]
pub struct JointCommand {
    #[command(flatten)]
    connection: Connection,
    #[command(subcommand)]
    action: Action,
}

#[derive(clap::Subcommand)]
enum Action {
    /// Make the joint's present angle 0, or --angle; the robot must be disarmed and the joint must stand still
    Zero {
        joint: Joint,
        /// The joint's present angle in rad, in the robot's model
        #[arg(
            long,
            value_name = "RAD",
            default_value_t = 0.0,
            allow_negative_numbers = true
        )]
        angle: f32,
    },
}

impl JointCommand {
    pub fn run(self) -> Result<()> {
        let mut client = self.connection.open()?;
        match self.action {
            Action::Zero { joint, angle } => zero(&mut client, joint, angle),
        }
    }
}

fn zero(client: &mut TuningClient, joint: Joint, angle_rad: f32) -> Result<()> {
    ensure!(angle_rad.is_finite(), "--angle must be a number");
    let name = joint
        .to_possible_value()
        .context("every joint has a name")?;
    let name = name.get_name();
    let setting = settings::find(&format!("joint-{name}.zero-rad"))?;
    let min_rad = client.read(settings::find(&format!("joint-{name}.min-rad"))?)?;
    let max_rad = client.read(settings::find(&format!("joint-{name}.max-rad"))?)?;
    let angle = |client: &mut TuningClient| -> Result<Option<f64>> {
        let reading = client.live(tuning::live_page("joint"), joint as usize)?;
        Ok(reading.and_then(|reading| reading.number("angle-rad")))
    };
    let before = angle(client)?;
    let zero_before = client.read(setting)?;
    client
        .zero_joint(joint as u8, angle_rad)
        .with_context(|| format!("the zero of {name} was not changed"))?;
    let zero = client.read(setting)?;
    match before {
        Some(before) => say!("{name} stands at {angle_rad} rad (was called {before:.3} rad)")?,
        None => say!("{name} stands at {angle_rad} rad")?,
    }
    say!("{} = {zero} rad (was {zero_before})", setting.full_name())?;
    if !(min_rad..=max_rad).contains(&angle_rad) {
        say!(
            "note: that is beyond its limits, {min_rad} … {max_rad} rad: move it or set joint-{name}.min-rad, .max-rad"
        )?;
    }
    confirm_saved(client)
}
