//! Simulated time.

/// Picoseconds since power-on.
pub type Ps = u64;

pub const NS: Ps = 1_000;
pub const US: Ps = 1_000 * NS;
pub const MS: Ps = 1_000 * US;
pub const SECOND: Ps = 1_000 * MS;

/// Seconds as picoseconds, rounded; negative or not finite gives 0.
pub fn from_seconds(seconds: f64) -> Ps {
    (seconds * SECOND as f64).round() as Ps
}

pub fn to_seconds(ps: Ps) -> f64 {
    ps as f64 / SECOND as f64
}
