//! The ground under the wheels.

/// The ground on which the wheels roll.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Floor {
    Clean,
    Slippery,
}

impl Floor {
    /// Friction coefficient: greatest ground force per newton of load. Assumed values, for rubber on a clean floor and
    /// on wet ice.
    pub(super) fn grip(self) -> f64 {
        match self {
            Self::Clean => 0.8,
            Self::Slippery => 0.05,
        }
    }
}
