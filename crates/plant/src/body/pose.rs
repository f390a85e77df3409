//! Position and motion of the body.

/// Position in the ENU earth frame. Velocity along the heading, to its left, and up.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pose {
    /// East of the start, m.
    pub x_m: f64,
    /// North of the start, m.
    pub y_m: f64,
    /// Up, m: of the free robot's hip centre, above the ground at the start.
    pub z_m: f64,
    /// Heading from east, counter-clockwise. Full turns add up.
    pub yaw_rad: f64,
    /// Distance along the heading; backward motion counts negative.
    pub path_m: f64,
    /// Forward speed.
    pub vx_mps: f64,
    /// Speed to the left.
    pub vy_mps: f64,
    /// Speed upward.
    pub vz_mps: f64,
    /// Yaw rate, left turn positive.
    pub wz_rps: f64,
}
