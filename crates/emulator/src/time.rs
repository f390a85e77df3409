//! Simulated time.

/// Picoseconds since power-on.
pub type Ps = u64;

/// One nanosecond.
pub const NS: Ps = 1_000;
/// One microsecond.
pub const US: Ps = 1_000 * NS;
/// One millisecond.
pub const MS: Ps = 1_000 * US;
/// One second.
pub const SECOND: Ps = 1_000 * MS;
