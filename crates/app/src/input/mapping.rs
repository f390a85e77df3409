//! Which channel means what.

use super::{DbusFrame, DbusSwitch, SbusFrame, channels};
use crate::domain::{DriveMode, OperatorState, RemoteState};

/// Index of an SBUS channel, 0 to 15.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelIndex(u8);

impl ChannelIndex {
    /// `None` above 15.
    pub const fn new(index: u8) -> Option<Self> {
        if index < 16 { Some(Self(index)) } else { None }
    }

    fn of(self, channels: &[f32; 16]) -> f32 {
        channels.get(usize::from(self.0)).copied().unwrap_or(0.0)
    }
}

/// SBUS channel assignment. DBUS needs none: its switches and sticks are labelled on the transmitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RemoteMapping {
    /// Stick right = positive = turn right, so `wz` is its negative.
    pub steering: ChannelIndex,
    pub drive: ChannelIndex,
    /// Up = high.
    pub select: ChannelIndex,
    /// Right = high.
    pub dead_man: ChannelIndex,
    /// High = enabled.
    pub enable: ChannelIndex,
    /// Low, middle, high = 0, 1, 2.
    pub mode: ChannelIndex,
    /// Low = run; anything else stops.
    pub e_stop: ChannelIndex,
}

impl Default for RemoteMapping {
    fn default() -> Self {
        Self {
            steering: ChannelIndex(0),
            drive: ChannelIndex(1),
            select: ChannelIndex(2),
            dead_man: ChannelIndex(3),
            enable: ChannelIndex(4),
            mode: ChannelIndex(5),
            e_stop: ChannelIndex(6),
        }
    }
}

/// A switch is taken as thrown beyond half way.
const SWITCH_THRESHOLD: f32 = 0.5;
/// The dead-man stick counts as held beyond this.
const DEAD_MAN_THRESHOLD: f32 = 0.7;

pub(super) fn from_sbus(
    frame: &SbusFrame,
    mapping: &RemoteMapping,
    ts_us: u64,
) -> (RemoteState, OperatorState) {
    let channels = frame
        .channels
        .map(|raw| channels::normalise(raw, 172, 992, 1811));
    let state = RemoteState {
        vx: mapping.drive.of(&channels),
        wz: -mapping.steering.of(&channels),
        select: mapping.select.of(&channels),
        channels,
        ts_us,
    };
    let enabled = mapping.enable.of(&channels) > SWITCH_THRESHOLD;
    let operator = OperatorState {
        enabled,
        disabled: !enabled,
        e_stop: mapping.e_stop.of(&channels) > -SWITCH_THRESHOLD,
        dead_man: mapping.dead_man.of(&channels) > DEAD_MAN_THRESHOLD,
        mode: match mapping.mode.of(&channels) {
            low if low < -SWITCH_THRESHOLD => DriveMode::Manual,
            high if high > SWITCH_THRESHOLD => DriveMode::Custom,
            _ => DriveMode::Pc,
        },
        ts_us,
    };
    (state, operator)
}

pub(super) fn from_dbus(frame: &DbusFrame, ts_us: u64) -> (RemoteState, OperatorState) {
    let stick = |raw| channels::normalise(raw, 364, 1024, 1684);
    let [right_h, right_v, left_h, left_v] = frame.sticks.map(stick);
    let mut channels = [0.0; 16];
    for (channel, value) in
        channels
            .iter_mut()
            .zip([right_h, right_v, left_h, left_v, stick(frame.wheel)])
    {
        *channel = value;
    }
    let state = RemoteState {
        vx: right_v,
        wz: -right_h,
        select: left_v,
        channels,
        ts_us,
    };
    let enabled = frame.right_switch == DbusSwitch::Up;
    let operator = OperatorState {
        enabled,
        disabled: !enabled,
        e_stop: frame.right_switch == DbusSwitch::Down,
        dead_man: left_h > DEAD_MAN_THRESHOLD,
        mode: match frame.left_switch {
            DbusSwitch::Up => DriveMode::Manual,
            DbusSwitch::Middle => DriveMode::Pc,
            DbusSwitch::Down => DriveMode::Custom,
        },
        ts_us,
    };
    (state, operator)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ends and centre of SBUS: 172, 992, 1811; of DBUS: 364, 1024, 1684 (hardware.md section 6). Beyond 0.7: 1566 and
    /// 1487.
    #[test]
    fn the_left_stick_is_dead_man_and_selector_on_both_radios() {
        let sbus = |select, dead_man| {
            let mut channels = [992; 16];
            (channels[2], channels[3]) = (select, dead_man);
            let frame = SbusFrame {
                channels,
                channel_17: false,
                channel_18: false,
                frame_lost: false,
                failsafe: false,
            };
            let (state, operator) = from_sbus(&frame, &RemoteMapping::default(), 1);
            (state.select, operator.dead_man)
        };
        assert_eq!(sbus(992, 992), (0.0, false));
        assert_eq!(sbus(1811, 1811), (1.0, true));
        assert_eq!(sbus(172, 172), (-1.0, false));
        assert_eq!((sbus(992, 1565).1, sbus(992, 1566).1), (false, true));
        let dbus = |select, dead_man| {
            let frame = DbusFrame {
                sticks: [1024, 1024, dead_man, select],
                wheel: 1024,
                right_switch: DbusSwitch::Middle,
                left_switch: DbusSwitch::Middle,
            };
            let (state, operator) = from_dbus(&frame, 1);
            (state.select, operator.dead_man)
        };
        assert_eq!(dbus(1024, 1024), (0.0, false));
        assert_eq!(dbus(364, 1684), (-1.0, true));
        assert_eq!(dbus(1684, 364), (1.0, false));
        assert_eq!((dbus(1024, 1486).1, dbus(1024, 1487).1), (false, true));
    }
}
