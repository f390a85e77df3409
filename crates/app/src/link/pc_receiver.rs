//! The computer's end of the line: bytes → the robot's state.

use super::{
    HEADER, ScanCounters, TUNNEL_HEADER, Tunnelled, UPLINK_LEN, Uplink,
    scanner::{Found, Frame, Scanner, Shape},
    tunnel::TUNNEL_SHAPE,
};
use crate::domain::CanFrame;

static STATE_SHAPE: Shape = Shape::new(UPLINK_LEN);

/// What a frame from the robot brings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "it is handed over at once and never stored"
)]
pub enum Heard {
    /// The robot's state.
    Uplink(Uplink),
    /// An answer on the tuning channel.
    Tunnel(CanFrame),
}

/// Decodes what the robot sends.
///
/// ```
/// use robot_app::link::{Heard, PcReceiver, Uplink};
///
/// let sent = Uplink { mcu_c: 41, ..Uplink::default() };
/// let mut receiver = PcReceiver::new();
/// let mut temperatures_c = Vec::new();
/// receiver.feed(&sent.encode(), |heard| {
///     if let Heard::Uplink(state) = heard {
///         temperatures_c.push(state.mcu_c);
///     }
/// });
/// assert_eq!(temperatures_c, [41]);
/// assert_eq!(receiver.counters().good, 1);
/// ```
#[derive(Clone, Debug)]
pub struct PcReceiver {
    scanner: Scanner,
}

impl Frame for Heard {
    fn shape(header: u8) -> Option<&'static Shape> {
        match header {
            HEADER => Some(&STATE_SHAPE),
            TUNNEL_HEADER => Some(&TUNNEL_SHAPE),
            _ => None,
        }
    }

    fn read(bytes: &[u8]) -> Option<Self> {
        if let Ok(frame) = bytes.try_into() {
            return Uplink::decode(frame).map(Self::Uplink);
        }
        let tunnelled = Tunnelled::decode(bytes.try_into().ok()?)?;
        Some(Self::Tunnel(tunnelled.can_frame()))
    }
}

impl Default for PcReceiver {
    fn default() -> Self {
        Self::new()
    }
}

impl PcReceiver {
    /// A receiver that has seen no byte yet.
    pub fn new() -> Self {
        Self {
            scanner: Scanner::new(),
        }
    }

    /// Takes bytes in chunks of any length. `sink` gets what each frame brings.
    pub fn feed(&mut self, bytes: &[u8], mut sink: impl FnMut(Heard)) {
        let mut sink = |found: Found<Heard>, _following| sink(found.frame);
        self.scanner.feed(bytes, &mut sink);
    }

    /// What was received since the start.
    pub fn counters(&self) -> ScanCounters {
        self.scanner.counters()
    }
}
