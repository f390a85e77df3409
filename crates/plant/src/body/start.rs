//! How the free robot lies or stands at power-on.

/// The pose of the free robot at power-on, at rest and with limp motors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Start {
    /// It is upright on its wheels at the middle of its leg length, and is let go at once.
    Standing,
    /// It sits with folded legs, on its wheels and the edge of its body, as after switching off.
    #[default]
    Sitting,
    /// It lies on its front.
    Front,
    /// It lies on its back.
    Back,
    /// It lies on its left side.
    Left,
    /// It lies on its right side.
    Right,
    /// It is upright, with the body on the ground between legs that are drawn in as far as they go.
    Folded,
    /// It lies on its top, wheels up.
    UpsideDown,
    /// It is upright as in [`Standing`](Self::Standing), with its wheels above the ground, and falls.
    Dropped {
        /// Height of the wheels above the ground, m.
        height_m: f64,
    },
}
