//! The steps of a calibration, with the user's Enter between them.

use std::{
    io::{IsTerminal, stdin, stdout},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

use anyhow::{Context, Result, bail};
use robot_arm::{
    bus::register::HOMING_OFFSET,
    calibration::{Calibration, Format, Travel},
    controller::ServoController,
};

use crate::command::{
    connection::Arm,
    output::{say, write},
    stop::Stop,
};

/// Between two readings no joint goes half a turn.
const PERIOD: Duration = Duration::from_millis(10);
const SHOW_EVERY: u32 = 20;

pub struct Session {
    arm: ServoController,
    stop: Stop,
}

impl Session {
    pub fn open(arm: &Arm, stop: Stop) -> Result<Self> {
        // Positions are wanted as they come, so that the old limits are no matter.
        let mut arm = arm.open()?;
        arm.release()?;
        Ok(Self { arm, stop })
    }

    pub fn record(&mut self, format: Format, whole_turn: &[String]) -> Result<Calibration> {
        let names = self.arm.joint_names();
        let ids: Vec<u8> = self
            .arm
            .calibration()
            .joints()
            .iter()
            .map(|(_, j)| j.id)
            .collect();
        let mut offsets = Vec::new();
        for id in &ids {
            offsets.push(self.arm.bus().read(*id, HOMING_OFFSET)?.value);
        }
        say!(
            "1. The torque is off. Put every joint into the middle of its travel, and press Enter."
        )?;
        self.until_enter(|_| Ok(()))?;
        let middle = self.arm.read_servo_positions()?;
        let mut travels = Vec::new();
        for (name, offset) in names.iter().zip(&offsets) {
            let position = middle.get(name).context("a joint did not answer")?;
            travels.push(Travel::new(*position, *offset));
        }
        say!(
            "2. Move each joint slowly to both of its stops ({} may stay), and press Enter.",
            whole_turn.join(", ")
        )?;
        let mut number = 0;
        self.until_enter(|arm| {
            let positions = arm.read_positions()?.steps;
            for ((name, offset), travel) in names.iter().zip(&offsets).zip(&mut travels) {
                if let Some(position) = positions.get(name) {
                    travel.follow(*position, *offset);
                }
            }
            number += 1;
            if number % SHOW_EVERY == 0 && stdout().is_terminal() {
                show(&names, &travels)?;
            }
            Ok(())
        })?;
        let mut joints = Vec::new();
        for ((name, id), travel) in names.iter().zip(ids).zip(&travels) {
            let joint = travel
                .finish(id, format, whole_turn.contains(name))
                .with_context(|| format!("{name} is not calibrated, and nothing was stored"))?;
            joints.push((name.clone(), joint));
        }
        Ok(Calibration::new(format, joints)?)
    }

    /// Does something again and again until Enter is pressed.
    fn until_enter(
        &mut self,
        mut act: impl FnMut(&mut ServoController) -> Result<()>,
    ) -> Result<()> {
        let is_pressed = Arc::new(AtomicBool::new(false));
        let pressed = is_pressed.clone();
        // It ends with the line, or with the program.
        thread::spawn(move || {
            // An input that has ended counts as Enter.
            let _ = stdin().read_line(&mut String::new());
            pressed.store(true, Ordering::Relaxed);
        });
        while !is_pressed.load(Ordering::Relaxed) {
            if self.stop.is_caught() {
                bail!("stopped: nothing was stored, and no joint has torque");
            }
            act(&mut self.arm)?;
            self.arm.bus().wait(PERIOD)?;
        }
        Ok(())
    }
}

fn show(names: &[String], travels: &[Travel]) -> Result<()> {
    let each: Vec<String> = names
        .iter()
        .zip(travels)
        .map(|(name, travel)| {
            let (below, above) = travel.reach();
            format!("{name} -{below}/+{above}")
        })
        .collect();
    write(format_args!("\r{}\x1b[K", each.join("  ")))?;
    Ok(())
}
