//! Torques that the joints themselves make: dry friction and end stops.

/// Stiffness of dry friction before it slips, as a share of the largest that one step can integrate.
const BRISTLE_SHARE: f64 = 0.02;
/// Damping of that spring, as a share of the inertia over a step.
const BRISTLE_DAMPING: f64 = 0.14;
/// Travel from the file's limit to the stop itself.
pub(super) const STOP_MARGIN_RAD: f64 = 0.02;
/// Stiffness of a stop: an assumption, a rubber buffer.
const STOP_NM_PER_RAD: f64 = 400.0;
/// Damping of a stop, an assumption.
const STOP_NM_PER_RPS: f64 = 1.3;

/// Dry friction as a bristle: a stiff spring that slips where it would exceed the friction. What sticks bends a fraction of a
/// milliradian and then holds still.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DryFriction {
    bend_rad: f64,
}

impl DryFriction {
    /// Torque on a joint of at least `inertia_kgm2` that turns at `rps`, at most `most_nm`.
    pub fn torque_nm(&mut self, rps: f64, most_nm: f64, inertia_kgm2: f64, dt_s: f64) -> f64 {
        let stiffness = BRISTLE_SHARE * inertia_kgm2 / (dt_s * dt_s);
        let damping = BRISTLE_DAMPING * inertia_kgm2 / dt_s;
        self.bend_rad += rps * dt_s;
        let holding_nm = -stiffness * self.bend_rad - damping * rps;
        if holding_nm.abs() <= most_nm {
            return holding_nm;
        }
        let torque_nm = most_nm.copysign(holding_nm);
        self.bend_rad = -torque_nm / stiffness;
        torque_nm
    }
}

/// Torque of the end stops of a hip: zero within its range.
pub(super) fn stop_torque_nm(angle_rad: f64, rps: f64, [lower, upper]: [f64; 2]) -> f64 {
    let above = angle_rad - (upper + STOP_MARGIN_RAD);
    let below = angle_rad - (lower - STOP_MARGIN_RAD);
    if above > 0.0 {
        (-STOP_NM_PER_RAD * above - STOP_NM_PER_RPS * rps).min(0.0)
    } else if below < 0.0 {
        (-STOP_NM_PER_RAD * below - STOP_NM_PER_RPS * rps).max(0.0)
    } else {
        0.0
    }
}
