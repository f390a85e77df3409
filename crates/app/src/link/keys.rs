//! Keys and sticks of the remote control in state frames. What they mean on this robot: docs/pc-link.md.

bitflags::bitflags! {
    /// Keys. The low byte is the document's Key1, the high byte its Key2.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Keys: u16 {
        /// The radio is lost or in failsafe.
        const F2 = 1 << 0;
        /// The robot is armed.
        const F1 = 1 << 1;
        /// Channel 11 is above half.
        const L2 = 1 << 2;
        /// Channel 12 is above half.
        const R2 = 1 << 3;
        /// The e-stop is thrown.
        const SELECT = 1 << 4;
        /// The enable switch is on.
        const START = 1 << 5;
        /// Channel 9 is above half.
        const L1 = 1 << 6;
        /// Channel 10 is above half.
        const R1 = 1 << 7;
        /// Channel 14 is below minus half.
        const LEFT = 1 << 8;
        /// Channel 13 is below minus half.
        const DOWN = 1 << 9;
        /// Channel 14 is above half.
        const RIGHT = 1 << 10;
        /// Channel 13 is above half.
        const UP = 1 << 11;
        /// Dead-man: the left stick is held to the right.
        const Y = 1 << 12;
        /// Mode custom.
        const X = 1 << 13;
        /// Mode PC.
        const B = 1 << 14;
        /// Mode manual.
        const A = 1 << 15;
    }
}

/// Sticks, −1…1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sticks {
    /// Left stick, right positive.
    pub lx: f32,
    /// Right stick, right positive.
    pub rx: f32,
    /// Left stick, up positive.
    pub ly: f32,
    /// Channel 11.
    pub l2: f32,
    /// Right stick, up positive.
    pub ry: f32,
}
