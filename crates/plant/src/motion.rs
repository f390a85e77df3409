//! The motion that inertial sensors measure.

/// Specific force and angular rate, both in the same right-handed axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    /// Specific force in m/s²: +9.8 on the axis that points up at rest.
    pub accel_mps2: [f64; 3],
    /// Angular rate in rad/s.
    pub gyro_rps: [f64; 3],
}

/// Source of the motion, which decides the errors that a sensor model adds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MotionSource {
    /// True motion: the model adds offset, noise, filter, range and quantisation.
    Physics,
    /// The output of another sensor, which has an offset and noise already: the model adds filter, range and
    /// quantisation only.
    Recording,
}
