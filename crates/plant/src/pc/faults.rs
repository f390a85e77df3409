//! Faults of the serial link and of the PC.

/// The faults in force at the moment.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LinkFaults {
    /// No character reaches the board.
    pub cut_down: bool,
    /// No character reaches the PC.
    pub cut_up: bool,
    /// Both lines carry bit errors, swallowed characters and stray bytes.
    pub noise: bool,
    /// The line to the board is full of random characters.
    pub flood: bool,
    /// The line to the board is held low in long breaks.
    pub held_low: bool,
    /// The PC repeats its last frame.
    pub frozen: bool,
    /// The PC sends frames whose fields are all at an end of their range.
    pub extremes: bool,
}

impl LinkFaults {
    /// Whether what the PC sends reaches the board at all.
    pub(super) fn lets_through(self) -> bool {
        !(self.cut_down || self.flood || self.held_low)
    }
}
