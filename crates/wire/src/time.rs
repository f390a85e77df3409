//! Simulated time.

/// Picoseconds since power-on.
pub type Ps = u64;

/// A nanosecond.
pub const NS: Ps = 1_000;
/// A microsecond.
pub const US: Ps = 1_000 * NS;
/// A millisecond.
pub const MS: Ps = 1_000 * US;
/// A second.
pub const SECOND: Ps = 1_000 * MS;

/// Seconds as picoseconds, rounded. A negative time and NaN give 0.
pub fn from_seconds(seconds: f64) -> Ps {
    (seconds * SECOND as f64).round() as Ps
}

/// Picoseconds as seconds.
pub fn to_seconds(ps: Ps) -> f64 {
    ps as f64 / SECOND as f64
}
