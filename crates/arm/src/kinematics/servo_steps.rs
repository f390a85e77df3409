//! Joint angles as servo steps, and back.
//!
//! `steps = home + sign · ratio · q · 4096 / 2π`, and `q = sign · (steps − home) / (ratio · 4096 / 2π)`.

use std::{collections::BTreeMap, f64::consts::TAU};

use super::{KinematicsError, Robot};

/// Steps of a servo's shaft in a turn (STS3215).
pub const STEPS_PER_TURN: f64 = 4096.0;

const STEPS_PER_RAD: f64 = STEPS_PER_TURN / TAU;

impl Robot {
    /// Steps for joint angles in rad, to the nearest one. `joint_names` says which angle is whose, and `home_pose` where each
    /// joint's 0 is.
    ///
    /// Neither the joints' limits nor those of the servos are looked at: the controller does that.
    ///
    /// # Errors
    /// There is not one finite angle for each name, or a name is not one of the arm or has no home.
    pub fn q_to_servo_targets<S: AsRef<str>>(
        &self,
        q_rad: &[f64],
        joint_names: &[S],
        home_pose: &BTreeMap<String, i32>,
    ) -> Result<BTreeMap<String, i32>, KinematicsError> {
        if q_rad.len() != joint_names.len() {
            return Err(KinematicsError::Length {
                what: "q",
                found: q_rad.len(),
                wanted: joint_names.len(),
            });
        }
        if !q_rad.iter().all(|it| it.is_finite()) {
            return Err(KinematicsError::NotFinite { what: "q" });
        }
        let pairs = joint_names.iter().zip(q_rad);
        let targets = pairs.map(|(name, q_rad)| {
            let name = name.as_ref();
            let (per_rad, home) = self.servo_scale(name, home_pose)?;
            let steps = f64::from(home) + per_rad * q_rad;
            // A conversion of floats that cannot fail: it ends at the integer's limits.
            Ok((name.to_owned(), steps.round() as i32))
        });
        targets.collect()
    }

    /// Joint angles in rad from the `positions` that the servos report, in steps. The order is that of `joint_names`.
    ///
    /// # Errors
    /// A name is not one of the arm, or has no home or no position.
    pub fn read_joint_angles<S: AsRef<str>>(
        &self,
        joint_names: &[S],
        home_pose: &BTreeMap<String, i32>,
        positions: &BTreeMap<String, i32>,
    ) -> Result<Vec<f64>, KinematicsError> {
        let angles = joint_names.iter().map(|name| {
            let name = name.as_ref();
            let (per_rad, home) = self.servo_scale(name, home_pose)?;
            let steps = *named("positions", name, positions)?;
            Ok((f64::from(steps) - f64::from(home)) / per_rad)
        });
        angles.collect()
    }

    /// Steps for a rad, with their sign, and the steps at 0.
    fn servo_scale(
        &self,
        name: &str,
        home_pose: &BTreeMap<String, i32>,
    ) -> Result<(f64, i32), KinematicsError> {
        let index = self.index_of(name)?;
        let gear = self.joints().get(index).map(|it| it.gear());
        let gear = gear.unwrap_or(super::Gear::DIRECT);
        let home = *named("home_pose", name, home_pose)?;
        // The sign is its own inverse, so that one factor serves both ways.
        Ok((gear.sign() * gear.ratio() * STEPS_PER_RAD, home))
    }
}

fn named<'a>(
    what: &'static str,
    joint: &str,
    map: &'a BTreeMap<String, i32>,
) -> Result<&'a i32, KinematicsError> {
    map.get(joint).ok_or_else(|| KinematicsError::Missing {
        what,
        joint: joint.to_owned(),
    })
}
