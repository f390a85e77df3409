//! Position and motion of the body.

/// Position in the ENU earth frame, velocity in the body's own axes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pose {
    /// East of the start, m.
    pub x_m: f64,
    /// North of the start, m.
    pub y_m: f64,
    /// Heading from east, counter-clockwise. Full turns add up.
    pub yaw_rad: f64,
    /// Distance along the body's own forward axis; backward motion counts negative.
    pub path_m: f64,
    /// Forward speed.
    pub vx_mps: f64,
    /// Yaw rate, left turn positive.
    pub wz_rps: f64,
}
