//! Faults of the radio link.

/// The faults in force at the moment.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RadioFaults {
    /// The receiver is unplugged: no further character arrives, not even the rest of a frame.
    pub silent: bool,
    /// The receiver lost the transmitter long ago.
    pub failsafe: bool,
    /// The receiver missed the last radio packet.
    pub frame_lost: bool,
    /// The line carries bit errors and stray bytes.
    pub noise: bool,
    /// Share of the frames that is lost, 0 … 1.
    pub loss: f64,
}
