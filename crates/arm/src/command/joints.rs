//! Moves joints with the keys.

use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

use anyhow::Result;
use robot_arm::controller::{ControllerError, ServoController};

use super::{connection::MovingArm, look::look, screen::Screen, stop::Stop};
use crate::panel::{joints::JointPanel, key::Action};

#[derive(clap::Args)]
#[command(
    after_help = "Keys: Q/A, W/S, E/D, R/F, T/G, Y/H step the joints up and down; [ ] change the step; 0 goes home; Space stops, \
twice it takes the torque away; X takes the torque away, Enter switches it on again; Esc ends.

Example:
  armctl joints --port /dev/ttyACM0 --arm left_arm.json"
)]
pub struct Joints {
    #[command(flatten)]
    arm: MovingArm,
}

const PERIOD: Duration = Duration::from_millis(40);

impl Joints {
    pub fn run(self) -> Result<()> {
        let stop = Stop::catch()?;
        let mut arm = self.arm.open()?;
        arm.set_stop_flag(stop.flag());
        let positions = arm.read_servo_positions()?;
        let joints = arm.calibration().joints().iter();
        let joints = joints.map(|(name, j)| (name.clone(), j.range_min, j.range_max.min(4095)));
        let mut panel = JointPanel::new(joints.collect(), &positions);
        let mut screen = Screen::open()?;
        arm.enable_torque()?;
        let started = Instant::now();
        while !stop.is_caught() {
            for key in screen.keys()? {
                let before = panel.goals();
                let action = panel.press(key, started.elapsed());
                if action == Action::End {
                    return Ok(());
                }
                act(&mut arm, &mut panel, action, &before);
            }
            let before = panel.goals();
            let action = panel.advance();
            act(&mut arm, &mut panel, action, &before);
            let errors = watch(&mut arm, &mut panel);
            screen.draw(" armctl joints ", &lines(&panel, &errors))?;
            std::thread::sleep(PERIOD);
        }
        Ok(())
    }
}

/// Does what a key asks for. Goals that could not be sent are forgotten: the arm does not make up for them when its port is back.
fn act(
    arm: &mut ServoController,
    panel: &mut JointPanel,
    action: Action,
    before: &BTreeMap<String, i32>,
) {
    if let Err(error) = try_to(arm, panel, action) {
        panel.take_back(before);
        panel.note = error.to_string();
    }
}

fn try_to(
    arm: &mut ServoController,
    panel: &mut JointPanel,
    action: Action,
) -> Result<(), ControllerError> {
    match action {
        Action::Send => arm.fast_move_to_pose(&panel.goals(), 0)?,
        Action::Hold => {
            arm.hold()?;
            panel.goals_from_positions();
            "stopped".clone_into(&mut panel.note);
        }
        Action::Release => {
            arm.release()?;
            "no torque: Enter switches it on".clone_into(&mut panel.note);
        }
        Action::Engage => {
            arm.enable_torque()?;
            panel.goals_from_positions();
        }
        Action::Home => panel.go(arm.home_pose()),
        Action::Nothing | Action::End => {}
    }
    Ok(())
}

/// Reads the positions. Returns why there is none of a joint.
fn watch(arm: &mut ServoController, panel: &mut JointPanel) -> Vec<String> {
    let seen = look(arm);
    panel.take_positions(&seen.steps);
    if !panel.is_engaged() {
        panel.goals_from_positions();
    }
    if !seen.warnings.is_empty() {
        panel.note = seen.warnings.join("; ");
    }
    seen.errors
}

fn lines(panel: &JointPanel, errors: &[String]) -> Vec<String> {
    let mut lines = vec![
        format!(
            "{:<18}{:>6}{:>10}{:>8}   {:<12}keys",
            "joint", "goal", "position", "", "limits"
        ),
        String::new(),
    ];
    for row in panel.rows() {
        let position = row
            .position
            .map_or("-".to_owned(), |steps| steps.to_string());
        let (up, down) = row.keys;
        lines.push(format!(
            "{:<18}{:>6}{position:>10}  {}   {:<12}{} / {}",
            row.name,
            row.goal,
            bar(row.goal, row.least, row.most),
            format!("{}..{}", row.least, row.most),
            up.to_uppercase(),
            down.to_uppercase(),
        ));
    }
    let torque = if panel.is_engaged() { "on" } else { "OFF" };
    lines.extend([
        String::new(),
        format!("step {} ([ ] change it)   torque {torque}", panel.step()),
        "Space stops (twice: torque off)   X torque off   Enter torque on   0 home   Esc ends"
            .to_owned(),
        String::new(),
        panel.note.clone(),
    ]);
    lines.extend(errors.iter().cloned());
    lines
}

/// Where a goal is within its limits.
fn bar(goal: i32, least: i32, most: i32) -> String {
    const WIDTH: i32 = 10;
    let place = (goal - least) * (WIDTH - 1) / (most - least).max(1);
    (0..WIDTH)
        .map(|at| if at == place { '#' } else { '-' })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_screen_shows_goals_limits_keys_and_what_is_wrong() {
        let joints = vec![("shoulder_pan".to_owned(), 1000, 3000)];
        let positions = BTreeMap::from([("shoulder_pan".to_owned(), 2047)]);
        let mut panel = JointPanel::new(joints, &positions);
        panel.press('q', Duration::ZERO);
        let shown = lines(&panel, &["servo 3: no answer".to_owned()]).join("\n");
        for part in [
            "2057",
            "2047",
            "1000..3000",
            "Q / A",
            "step 10",
            "torque on",
            "servo 3: no answer",
            "----#-----",
        ] {
            assert!(shown.contains(part), "{part} in\n{shown}");
        }
        panel.press('x', Duration::ZERO);
        assert!(lines(&panel, &[]).join("\n").contains("torque OFF"));
    }
}
