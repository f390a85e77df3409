//! The meaning and the travel of the channels of an SBUS transmitter.

/// The channel number that means "no channel". Smaller numbers are indices into the frame, from 0.
pub const NO_CHANNEL: u32 = 16;

/// One stick or switch of the transmitter. Counts are those on the wire, 0…2047.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct RemoteChannel {
    /// 0…15, or [`NO_CHANNEL`].
    pub index: u32,
    /// Count when fully left, down, back or off.
    pub low: u32,
    /// Count at the centre.
    pub centre: u32,
    /// Count when fully right, up, forward or on.
    pub high: u32,
    /// 1 if the transmitter sends the channel reversed.
    pub reversed: u32,
}

impl RemoteChannel {
    /// A channel with the counts of FrSky and most other makes at −100, 0, +100 %. Futaba and RadioLink send about
    /// 352, 1024, 1696.
    const fn new(index: u32) -> Self {
        Self {
            index,
            low: 172,
            centre: 992,
            high: 1811,
            reversed: 0,
        }
    }

    /// Position of the channel: −1 at the low end, 0 at the centre, 1 at the high end, and beyond if the channel goes
    /// beyond. `None` without a channel.
    pub fn position(&self, raw: &[u16; 16]) -> Option<f32> {
        let raw = *raw.get(self.index as usize)?;
        let centre = self.centre as f32;
        let offset = f32::from(raw) - centre;
        let end = if offset < 0.0 { self.low } else { self.high };
        // Valid settings leave room between centre and ends. Without room the position is 0.
        let span = (end as f32 - centre).abs();
        let position = if span > 0.0 { offset / span } else { 0.0 };
        Some(if self.reversed == 1 {
            -position
        } else {
            position
        })
    }
}

/// A stick or switch that only a standing robot needs. Its counts are those of a FrSky transmitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct BalanceChannel {
    /// 0…15, or [`NO_CHANNEL`]. A channel that another function uses is none for this one: a robot may have been set up
    /// before this function existed.
    pub index: u32,
    /// 1 if the transmitter sends the channel reversed.
    pub reversed: u32,
}

impl BalanceChannel {
    const fn new(index: u32) -> Self {
        Self { index, reversed: 0 }
    }
}

/// All channels that the robot uses. DBUS does not need it: its sticks and switches are labelled on the transmitter,
/// and their counts are fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct RemoteMapping {
    /// Stick right = high = turn right.
    pub steering: RemoteChannel,
    /// Stick forward = high.
    pub drive: RemoteChannel,
    /// Up = high.
    pub select: RemoteChannel,
    /// Right = high.
    pub dead_man: RemoteChannel,
    /// High = enabled.
    pub enable: RemoteChannel,
    /// Low, middle, high = manual, PC, custom.
    pub mode: RemoteChannel,
    /// Low = run; any other position stops the robot.
    pub e_stop: RemoteChannel,
    /// Low = sit, high = stand.
    pub stand: BalanceChannel,
    /// High = jump.
    pub jump: BalanceChannel,
    /// High = long legs.
    pub height: BalanceChannel,
    /// High = right side down.
    pub roll: BalanceChannel,
}

impl RemoteMapping {
    /// The channels that every robot needs.
    pub const fn all(&self) -> [&RemoteChannel; 7] {
        [
            &self.steering,
            &self.drive,
            &self.select,
            &self.dead_man,
            &self.enable,
            &self.mode,
            &self.e_stop,
        ]
    }

    /// Position of a channel among these of a frame, −1…1. `None` without a channel of its own.
    pub fn balance_position(&self, channel: &BalanceChannel, positions: &[f32; 16]) -> Option<f32> {
        let position = *positions.get(channel.index as usize)?;
        let is_taken = self.all().iter().any(|other| other.index == channel.index);
        let signed = if channel.reversed == 1 {
            -position
        } else {
            position
        };
        (!is_taken).then_some(signed)
    }
}

impl Default for RemoteMapping {
    fn default() -> Self {
        Self {
            steering: RemoteChannel::new(0),
            drive: RemoteChannel::new(1),
            select: RemoteChannel::new(2),
            dead_man: RemoteChannel::new(3),
            enable: RemoteChannel::new(4),
            mode: RemoteChannel::new(5),
            e_stop: RemoteChannel::new(6),
            stand: BalanceChannel::new(7),
            jump: BalanceChannel::new(8),
            height: BalanceChannel::new(9),
            roll: BalanceChannel::new(10),
        }
    }
}
