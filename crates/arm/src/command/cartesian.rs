//! Moves the tool with the keys.

use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

use anyhow::{Context, Result};
use nalgebra::IsometryMatrix3;
use robot_arm::{
    controller::ServoController,
    ik::{Mask, Outcome, Solver},
    kinematics::{Robot, create_so101_5dof},
};

use super::{connection::MovingArm, look::look, screen::Screen, stop::Stop};
use crate::panel::{cartesian::CartesianPanel, key::Action};

#[derive(clap::Args)]
#[command(
    after_help = "Keys: W/S forward and back, A/D left and right, R/F up and down, I/K pitch, J/L roll, O/P gripper; [ ] change \
the step; 0 goes home; Space stops, twice it takes the torque away; X takes the torque away, Enter switches it on again; Esc \
ends. The arm is an SO-101; its calibration has the homes of the model's zero pose.

Example:
  armctl cartesian --port /dev/ttyACM0 --arm left_arm.json"
)]
pub struct Cartesian {
    #[command(flatten)]
    arm: MovingArm,
    /// Let the orientation come out as it likes
    #[arg(long)]
    place_only: bool,
}

const PERIOD: Duration = Duration::from_millis(20);
/// No joint moves further in a period: 1.5 rad/s.
const LARGEST_CHANGE_RAD: f64 = 0.03;
/// The gripper's steps in a period on the way home.
const GRIPPER_STEP: i32 = 20;
const GRIPPER: &str = "gripper";

struct Session {
    arm: ServoController,
    robot: Robot,
    names: Vec<String>,
    mask: Mask,
    /// Joint angles that were sent last.
    q: Vec<f64>,
    gripper: Option<i32>,
    /// Joint angles that the servos have, if all answer.
    measured_q: Option<Vec<f64>>,
}

impl Cartesian {
    pub fn run(self) -> Result<()> {
        let stop = Stop::catch()?;
        let mut arm = self.arm.open()?;
        arm.set_stop_flag(stop.flag());
        let mask = if self.place_only {
            Mask::POSITION
        } else {
            Mask::WITHOUT_YAW
        };
        let mut session = Session::new(arm, mask)?;
        let mut panel = CartesianPanel::new(session.tool()?);
        let mut screen = Screen::open()?;
        session.arm.enable_torque()?;
        let started = Instant::now();
        while !stop.is_caught() {
            for key in screen.keys()? {
                let action = panel.press(key, started.elapsed());
                if action == Action::End {
                    return Ok(());
                }
                if let Err(error) = session.act(&mut panel, action) {
                    panel.note = error.to_string();
                }
            }
            if panel.is_engaged()
                && let Err(error) = session.advance(&mut panel)
            {
                panel.note = error.to_string();
            }
            let errors = session.watch(&mut panel);
            screen.draw(" armctl cartesian ", &session.lines(&panel, &errors)?)?;
            std::thread::sleep(PERIOD);
        }
        Ok(())
    }
}

impl Session {
    fn new(arm: ServoController, mask: Mask) -> Result<Self> {
        let robot = create_so101_5dof();
        let names: Vec<String> = robot.joint_names().map(str::to_owned).collect();
        let mut session = Self {
            arm,
            names,
            robot,
            mask,
            q: Vec::new(),
            gripper: None,
            measured_q: None,
        };
        session.take_angles()?;
        Ok(session)
    }

    /// Takes the angles from the servos.
    fn take_angles(&mut self) -> Result<()> {
        let positions = self.arm.read_servo_positions()?;
        let home = self.arm.home_pose();
        self.q = self
            .robot
            .read_joint_angles(&self.names, &home, &positions)
            .context("the arm is no SO-101")?;
        self.gripper = positions.get(GRIPPER).copied();
        Ok(())
    }

    /// Reads the positions. Returns why there is none of a joint.
    fn watch(&mut self, panel: &mut CartesianPanel) -> Vec<String> {
        let seen = look(&mut self.arm);
        if !seen.warnings.is_empty() {
            panel.note = seen.warnings.join("; ");
        }
        let home = self.arm.home_pose();
        let angles = self
            .robot
            .read_joint_angles(&self.names, &home, &seen.steps);
        self.measured_q = angles.ok();
        seen.errors
    }

    fn tool(&self) -> Result<IsometryMatrix3<f64>> {
        Ok(self.robot.fkine(&self.q)?)
    }

    fn act(&mut self, panel: &mut CartesianPanel, action: Action) -> Result<()> {
        match action {
            Action::Hold => {
                self.arm.hold()?;
                "stopped".clone_into(&mut panel.note);
            }
            Action::Release => {
                self.arm.release()?;
                "no torque: Enter switches it on".clone_into(&mut panel.note);
                return Ok(());
            }
            Action::Engage => self.arm.enable_torque()?,
            Action::Send | Action::Nothing | Action::End | Action::Home => return Ok(()),
        }
        self.take_angles()?;
        panel.set_target(self.tool()?);
        Ok(())
    }

    /// Takes a step. What could not be sent is forgotten: the arm does not make up for it when its port is back.
    fn advance(&mut self, panel: &mut CartesianPanel) -> Result<()> {
        let before = (self.q.clone(), self.gripper);
        let steps = panel.take_gripper();
        self.gripper = self.gripper.map(|now| now + steps);
        let taken = if panel.is_homing() {
            self.go_home(panel)
        } else {
            self.follow(panel)
        };
        if taken.is_err() {
            (self.q, self.gripper) = before;
            panel.end_homing();
            panel.set_target(self.tool()?);
        }
        taken
    }

    /// Takes a step towards the target.
    fn follow(&mut self, panel: &mut CartesianPanel) -> Result<()> {
        let solver = Solver::default();
        let solution = solver.follow(
            &self.robot,
            panel.target(),
            &self.q,
            self.mask,
            LARGEST_CHANGE_RAD,
        )?;
        if !solution.success() {
            panel.note = solution.reason();
        }
        let is_at_its_end = !solution.success() && solution.outcome != Outcome::OnTheWay;
        self.q = solution.q;
        if is_at_its_end {
            // Else the way back would begin with as many key presses as went beyond the reach.
            panel.set_target(self.tool()?);
        }
        self.send()
    }

    /// Takes a step towards the joints' homes.
    fn go_home(&mut self, panel: &mut CartesianPanel) -> Result<()> {
        let mut is_there = true;
        for angle in &mut self.q {
            is_there &= angle.abs() <= LARGEST_CHANGE_RAD;
            *angle -= angle.clamp(-LARGEST_CHANGE_RAD, LARGEST_CHANGE_RAD);
        }
        let home = self.arm.home_pose().get(GRIPPER).copied();
        if let (Some(steps), Some(home)) = (&mut self.gripper, home) {
            *steps += (home - *steps).clamp(-GRIPPER_STEP, GRIPPER_STEP);
            is_there &= *steps == home;
        }
        panel.set_target(self.tool()?);
        if is_there {
            panel.end_homing();
        }
        self.send()
    }

    /// Sends joint angles and gripper.
    fn send(&mut self) -> Result<()> {
        let home = self.arm.home_pose();
        let mut targets: BTreeMap<String, i32> =
            self.robot.q_to_servo_targets(&self.q, &self.names, &home)?;
        if let Some(steps) = self.gripper {
            let steps = self.arm.limit_position(GRIPPER, steps)?;
            self.gripper = Some(steps);
            targets.insert(GRIPPER.to_owned(), steps);
        }
        Ok(self.arm.fast_move_to_pose(&targets, 0)?)
    }

    fn lines(&self, panel: &CartesianPanel, errors: &[String]) -> Result<Vec<String>> {
        let place = |name: &str, pose: &IsometryMatrix3<f64>| {
            let at = pose.translation.vector;
            let (roll, pitch, yaw) = pose.rotation.euler_angles();
            format!(
                "{name:<8} x {:+.3}  y {:+.3}  z {:+.3} m   roll {:+.2}  pitch {:+.2}  yaw {:+.2} rad",
                at.x, at.y, at.z, roll, pitch, yaw
            )
        };
        let angles: Vec<String> = self.q.iter().map(|angle| format!("{angle:+.2}")).collect();
        let (m, rad) = panel.step();
        let torque = if panel.is_engaged() { "on" } else { "OFF" };
        let tool = match &self.measured_q {
            Some(q) => place("tool", &self.robot.fkine(q)?),
            None => "tool     not known".to_owned(),
        };
        let mut lines = vec![
            place("target", panel.target()),
            tool,
            format!("joints   {} rad", angles.join("  ")),
            String::new(),
            "W / S x   A / D y   R / F z   I / K pitch   J / L roll   O / P gripper".to_owned(),
            format!(
                "step {:.0} mm, {rad} rad ([ ] change it)   torque {torque}",
                m * 1000.0
            ),
            "Space stops (twice: torque off)   X torque off   Enter torque on   0 home   Esc ends"
                .to_owned(),
            String::new(),
            panel.note.clone(),
        ];
        lines.extend(errors.iter().cloned());
        Ok(lines)
    }
}
