//! `policy show`: what a policy sees and commands.

use std::process::ExitCode;

use robot_policy::{Drive, PolicyDescription, observation::Layout};

use super::place::Place;

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Show {
    #[command(flatten)]
    place: Place,
}

const EXAMPLES: &str = "\
The exit code is 0 if the network fits.

Example:
  policy show --robot fivebar --config flat";

impl Show {
    pub fn run(self) -> anyhow::Result<ExitCode> {
        // Before the network is read: whoever has one that does not fit wants to see what it should have been.
        let described = self.place.described()?;
        described.iter().for_each(print);
        let (policy, model) = self.place.load()?;
        if described.is_none() {
            print(&policy);
        }
        println!("✓ {} fits", model.file().display());
        Ok(ExitCode::SUCCESS)
    }
}

fn print(policy: &PolicyDescription) {
    println!(
        "{}: a run each {:.1} ms\n",
        policy.name,
        1e3 * policy.period_s()
    );
    println!("Input\n{}\n", Layout::new(policy));
    println!("Output\n{}", joints(policy));
}

/// A line for each joint.
fn joints(policy: &PolicyDescription) -> String {
    let motors = policy.mapping.motors().iter();
    let motors = motors.zip(policy.mapping.directions());
    let rows = policy.joints.iter().zip(motors).enumerate();
    let rows = rows.map(|(index, (joint, (motor, direction)))| {
        let unit = match joint.drive {
            Drive::Position => "rad",
            Drive::Speed => "rad/s",
        };
        let sense = if *direction > 0.0 { "" } else { ", reversed" };
        let action = &joint.action;
        format!(
            "{index:>5}  {:<18} target {:+.3} {:+.3} · action {unit}, Kp {} Kd {}, at most {} N·m, motor {motor}{sense}\n",
            joint.name, action.offset, action.scale, joint.kp, joint.kd, joint.torque_limit_nm
        )
    });
    rows.collect()
}
