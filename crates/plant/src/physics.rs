//! Constants that all mechanical and analogue models share.

use crate::time::{Ps, US, to_seconds};

/// Time step of mechanics and analogue signals. A command takes effect at the next step.
pub(crate) const PHYSICS_STEP: Ps = 250 * US;

/// Standard gravity g₀, m/s² (ISO 80000-3).
pub(crate) const STANDARD_GRAVITY_MPS2: f64 = 9.80665;

/// [`PHYSICS_STEP`] in seconds.
pub(crate) fn physics_step_s() -> f64 {
    to_seconds(PHYSICS_STEP)
}
