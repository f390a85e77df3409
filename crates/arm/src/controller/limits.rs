//! Soft limits.

use super::{ControllerError, ServoController, Warning};

impl ServoController {
    /// Returns the target within the joint's `range_min` and `range_max`. Beyond them it is cut, with a warning.
    pub fn limit_position(&mut self, name: &str, steps: i32) -> Result<i32, ControllerError> {
        let joint = self.joint(name)?;
        let (least, most) = (joint.calibration.range_min, joint.calibration.last_step());
        let given = steps.clamp(least, most);
        let warning = (given != steps).then(|| Warning::Limited {
            joint: name.to_owned(),
            asked: steps,
            given,
            least,
            most,
        });
        let Some(joint) = self.joints.iter_mut().find(|joint| joint.name == name) else {
            return Ok(given);
        };
        // A key that is held down would warn with every step.
        let is_new = warning.is_some() && !joint.is_limited;
        joint.is_limited = warning.is_some();
        if is_new {
            self.warnings.extend(warning);
        }
        Ok(given)
    }
}
