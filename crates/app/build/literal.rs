//! Numbers as Rust writes them.

/// An `f32` constant.
pub fn f32(value: f64) -> String {
    format!("{:?}_f32", value as f32)
}

/// A sign of ±1 as an `f32` constant.
pub fn sign(value: i8) -> String {
    f32(f64::from(value))
}
