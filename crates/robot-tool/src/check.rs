//! `robot check`: what holds of a robot, and by how much.

use std::process::ExitCode;

use robot_description::{Figures, Robot};

use crate::robot_file::RobotFile;

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    file: RobotFile,
}

const EXAMPLES: &str = "\
The exit code is 0 if the firmware can be built for the robot, warnings or not.

Example:
  cargo xtask robot check fivebar-rs00";

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let examined = args.file.examine()?;
    print!("{}", table(&examined.robot));
    for warning in &examined.warnings {
        println!("warning: {warning}");
    }
    Ok(ExitCode::SUCCESS)
}

/// Figures beside what is asked or allowed.
fn table(robot: &Robot) -> String {
    let figures = robot.figures();
    let mut rows = vec![row("", "has", "asked or allowed")];
    rows.extend(standing(robot, &figures));
    rows.extend(moving(robot, &figures));
    rows.extend(mechanics(&figures));
    let lines: String = rows
        .iter()
        .map(|[what, has, wanted]| format!("{what:<44}  {has:<26}  {wanted}\n"))
        .collect();
    let total_kg = robot.total_mass_kg();
    format!("{}: {total_kg:.2} kg\n\n{lines}", robot.name)
}

type Row = [String; 3];

fn row(what: &str, has: &str, wanted: &str) -> Row {
    [what, has, wanted].map(str::to_owned)
}

fn standing(robot: &Robot, figures: &Figures) -> Vec<Row> {
    let stands = figures.stands.iter().map(|stand| {
        row(
            &format!("torque of each hip, standing at {:.2} m", stand.length_m),
            &format!("{:.2} N m, {:.0} %", stand.hip_nm, 100.0 * stand.share),
            &format!("70 % of {:.1} N m", robot.joints.continuous_nm),
        )
    });
    let mut rows: Vec<_> = stands.collect();
    rows.push(row(
        "body above the ground at the lowest height",
        &format!("{:.2} m", figures.clearance_m),
        "more than 0 m",
    ));
    rows
}

fn moving(robot: &Robot, figures: &Figures) -> Vec<Row> {
    let limits = &robot.control.limits;
    let turn_rps = figures.top_speed_mps / (robot.wheels.track_m / 2.0);
    let jump = &figures.jump;
    vec![
        row(
            "speed of unloaded wheels",
            &format!("{:.2} m/s", figures.top_speed_mps),
            &format!(
                "{:.2} m/s asked, {:.0} % of it; 90 %",
                limits.max_speed_mps,
                100.0 * limits.max_speed_mps / figures.top_speed_mps
            ),
        ),
        row(
            "turn rate of unloaded wheels",
            &format!("{turn_rps:.1} rad/s"),
            &format!(
                "{:.1} rad/s asked, {:.0} % of it; 90 %",
                limits.max_yaw_rps,
                100.0 * limits.max_yaw_rps / turn_rps
            ),
        ),
        row(
            "acceleration by the wheels' torque",
            &format!("{:.1} m/s2", figures.acceleration_mps2),
            "",
        ),
        row(
            "force along a leg at its shortest",
            &format!("{:.0} N", figures.push_n),
            &format!("{:.0} N stand on it", figures.carried_n),
        ),
        row(
            "take-off",
            &format!("{:.2} m/s after {:.2} s", jump.take_off_mps, jump.push_s),
            &format!(
                "hips turn at {:.1} of {:.1} rad/s",
                jump.hip_rps, robot.joints.no_load_rps
            ),
        ),
        row(
            "wheels above the ground in a jump",
            &format!("{:.2} m", jump.clearance_m),
            &format!("{:.2} m asked", limits.jump_m),
        ),
    ]
}

fn mechanics(figures: &Figures) -> Vec<Row> {
    let [back_rad, fore_rad] = figures.leans_rad;
    let mut rows = vec![
        row(
            "lean of the legs at middle height",
            &format!("{back_rad:.2} to {fore_rad:.2} rad"),
            "0.25 rad either way",
        ),
        row(
            "shanks from one line, at worst",
            &format!("{:.1} degrees", figures.between_shanks_rad.to_degrees()),
            "10 degrees",
        ),
        row(
            "knees from folded or straight, at worst",
            &format!("{:.1} degrees", figures.at_knee_rad.to_degrees()),
            "3 degrees",
        ),
    ];
    for (name, load) in ["CAN1", "CAN2"].iter().zip(figures.bus_loads) {
        rows.push(row(
            &format!("load of {name}, tuning and all"),
            &format!("{:.0} %", 100.0 * load),
            "80 %",
        ));
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The carried 4.962 kg are 24.33 N on each leg; at 0.26 m each N takes 0.0750 N·m of each hip. 50.5 rad/s on a
    /// radius of 0.075 m are 3.79 m/s.
    #[test]
    fn the_table_of_the_small_robot() {
        let text = include_str!("../../../robots/fivebar.toml");
        let robot = Robot::parse(text, "fivebar.toml").expect("sound");
        let table = table(&robot);
        assert!(table.starts_with("fivebar: 6.55 kg\n"), "{table}");
        for line in [
            "torque of each hip, standing at 0.26 m        1.82 N m, 61 %              70 % of 3.0 N m",
            "speed of unloaded wheels                      3.79 m/s                    2.50 m/s asked, 66 % of it; 90 %",
            "load of CAN1, tuning and all                  57 %                        80 %",
        ] {
            assert!(table.lines().any(|it| it == line), "{line}\n{table}");
        }
    }
}
