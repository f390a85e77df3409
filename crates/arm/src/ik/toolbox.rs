//! Inverse kinematics with arguments and answer of roboticstoolbox.

use nalgebra::Matrix4;

use super::{IkError, Mask, Solution, Solver, pose_of};
use crate::kinematics::{Joint, Robot};

impl Robot {
    /// Joint values that bring the tool to `Tep`, a 4 × 4 pose in the world, whether they do, and why not.
    ///
    /// Without `q0`, the search begins in the middle of the joints' ranges, and without a `mask`, the whole pose counts. A
    /// question that does not fit the arm is answered with `q0`, `false` and what is wrong with it.
    pub fn ikine_lm(
        &self,
        tep: &Matrix4<f64>,
        q0: Option<&[f64]>,
        mask: Option<[f64; 6]>,
    ) -> (Vec<f64>, bool, String) {
        let q0 = q0.map_or_else(|| self.middle(), <[f64]>::to_vec);
        match self.ask(tep, &q0, mask) {
            Ok(solution) => {
                let (success, reason) = (solution.success(), solution.reason());
                (solution.q, success, reason)
            }
            Err(error) => (q0, false, error.to_string()),
        }
    }

    fn ask(
        &self,
        tep: &Matrix4<f64>,
        q0: &[f64],
        mask: Option<[f64; 6]>,
    ) -> Result<Solution, IkError> {
        let mask = mask.map_or(Ok(Mask::POSE), Mask::new)?;
        Solver::default().solve(self, &pose_of(tep)?, q0, mask)
    }

    /// The middle of each joint's range, and 0 where it has none.
    pub fn middle(&self) -> Vec<f64> {
        let middle = |joint: &Joint| (joint.lower() + joint.upper()) / 2.0;
        let values = self.joints().iter().map(middle);
        values
            .map(|it| if it.is_finite() { it } else { 0.0 })
            .collect()
    }
}
