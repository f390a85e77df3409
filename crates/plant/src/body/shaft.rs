//! A rotating shaft with friction.

use crate::m3508::Friction;

/// Speed in rad/s after one step under a driving torque. Friction stops the shaft but never reverses it.
pub(super) fn turn_shaft(
    rps: f64,
    torque_nm: f64,
    friction: Friction,
    inertia_kgm2: f64,
    dt_s: f64,
) -> f64 {
    let driven = rps + (torque_nm - friction.viscous_nm_per_rps * rps) * dt_s / inertia_kgm2;
    let brake = friction.dry_nm * dt_s / inertia_kgm2;
    if driven.abs() <= brake {
        0.0
    } else {
        driven - brake.copysign(driven)
    }
}
