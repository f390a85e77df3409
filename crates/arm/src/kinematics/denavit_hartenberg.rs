//! A chain as a table of Denavit–Hartenberg parameters.

use super::{ElementaryTransform as Et, JointKind};

/// Which of the two ways to place the frames a table follows. Mixing them up gives another arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DhConvention {
    /// Denavit and Hartenberg 1955, as in Paul and Spong: `Rz(θ) tz(d) tx(a) Rx(α)`.
    Standard,
    /// Craig's, where a frame sits on its own joint: `Rx(α) tx(a) Rz(θ) tz(d)`.
    Modified,
}

/// One row: one joint with its link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DhRow {
    /// Whether the joint's angle is added to `theta_rad`, or its length to `d_m`.
    pub kind: JointKind,
    /// Offset along z, m.
    pub d_m: f64,
    /// Length of the link along x, m.
    pub a_m: f64,
    /// Twist of the link around x, rad.
    pub alpha_rad: f64,
    /// Angle around z, rad.
    pub theta_rad: f64,
    /// The joint counts the other way.
    pub flipped: bool,
}

impl DhRow {
    /// The row as elementary transforms.
    pub fn elementary(&self, convention: DhConvention) -> [Et; 5] {
        let joint = match self.kind {
            JointKind::Revolute => Et::joint_rz(),
            JointKind::Prismatic => Et::joint_tz(),
        };
        let joint = if self.flipped { joint.flipped() } else { joint };
        let (d, a) = (Et::tz(self.d_m), Et::tx(self.a_m));
        let (alpha, theta) = (Et::rx(self.alpha_rad), Et::rz(self.theta_rad));
        match convention {
            // What goes around and along the same axis may change places.
            DhConvention::Standard => [theta, joint, d, a, alpha],
            DhConvention::Modified => [alpha, a, theta, joint, d],
        }
    }
}
