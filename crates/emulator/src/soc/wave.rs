//! A rectangular wave on a pin.

/// Output of a timer channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Frequency, Hz.
    pub hz: f64,
    /// Mean on-fraction, 0 … 1.
    pub duty: f64,
}
