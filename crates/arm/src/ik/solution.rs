//! What a solver found.

/// What is left of the parts that the mask counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Remaining {
    /// Distance to the target, m.
    pub position_m: f64,
    /// Angle to the target's orientation, rad.
    pub rotation_rad: f64,
}

/// How a search ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// The tool is at the target.
    Converged,
    /// No joint values bring the tool there; no limit is in the way.
    OutOfReach,
    /// These joints are at a limit beyond which the tool would come closer.
    AtLimits(Vec<String>),
    /// The mask counts more parts than the arm has joints, and the target is none of the few poses where all of them come out.
    MaskTooWide {
        /// Parts that the mask counts.
        axes: usize,
        /// Joints of the arm.
        joints: usize,
    },
    /// The joints are on their way to the target and moved as far as they may in one call. Only [`follow`](super::Solver::follow)
    /// says so.
    OnTheWay,
}

/// Joint values, and how close they come.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Joint values, rad or m: at the target, or as close to it as was found. They are within the joint limits.
    pub q: Vec<f64>,
    /// How the search ended.
    pub outcome: Outcome,
    /// What is left at `q`.
    pub remaining: Remaining,
    /// Iterations of all descents.
    pub iterations: usize,
    /// Descents.
    pub searches: usize,
}

impl Solution {
    /// Whether the tool is at the target.
    pub fn success(&self) -> bool {
        self.outcome == Outcome::Converged
    }

    /// How the search ended, in words.
    pub fn reason(&self) -> String {
        let Remaining {
            position_m,
            rotation_rad,
        } = self.remaining;
        let left = format!("{:.4} m and {rotation_rad:.4} rad remain", position_m);
        match &self.outcome {
            Outcome::Converged => format!(
                "converged in {} iterations of {} searches",
                self.iterations, self.searches
            ),
            Outcome::OutOfReach => format!("out of reach: {left} at the nearest pose found"),
            Outcome::AtLimits(joints) => {
                format!("at the limits of {}: {left}", joints.join(", "))
            }
            Outcome::MaskTooWide { axes, joints } => format!(
                "the mask counts {axes} parts of the pose, and the arm has {joints} joints: {left}. Give weight 0 to a part \
                 that may come out as it likes, such as rz"
            ),
            Outcome::OnTheWay => format!("on the way: {left} after the largest step allowed"),
        }
    }
}
