//! Maps the channels of a frame to sticks and switches.

use super::{DbusFrame, DbusSwitch, SbusFrame, channels, dbus_wheel::DbusWheel};
use crate::domain::{
    DriveMode, OperatorState, RemoteChannel, RemoteMapping, RemoteState, StandSwitch,
};

/// A switch counts as thrown beyond half way.
const SWITCH_THRESHOLD: f32 = 0.5;
/// Counts of an SBUS channel without settings for its ends at which its switch still counts as thrown: beyond half way from
/// FrSky's centre to its ends.
pub const SBUS_SWITCH_LOW: u16 = 581;
/// As [`SBUS_SWITCH_LOW`], towards the high end.
pub const SBUS_SWITCH_HIGH: u16 = 1_402;
/// The dead-man stick counts as held beyond this position.
const DEAD_MAN_THRESHOLD: f32 = 0.7;
/// An e-stop channel further below its low end than this is absent: receivers send 0 for a channel that the
/// transmitter does not have.
const E_STOP_LOWEST: f32 = -1.2;

/// A stick or switch without a channel takes its safe position: sticks centred, enable off, e-stop thrown, no request to
/// stand.
pub(super) fn from_sbus(
    frame: &SbusFrame,
    mapping: &RemoteMapping,
    ts_us: u64,
) -> (RemoteState, OperatorState) {
    let raw = &frame.channels;
    let stick = |channel: &RemoteChannel| position(channel, raw).clamp(-1.0, 1.0);
    let channels = raw.map(|raw| channels::normalise(raw, 172, 992, 1811));
    let balance = |channel| mapping.balance_position(channel, &channels);
    let state = RemoteState {
        height: balance(&mapping.height).unwrap_or(0.0),
        roll: balance(&mapping.roll).unwrap_or(0.0),
        vx: stick(&mapping.drive),
        wz: -stick(&mapping.steering),
        select: stick(&mapping.select),
        hold: stick(&mapping.dead_man),
        channels,
        ts_us,
    };
    let enabled = position(&mapping.enable, raw) > SWITCH_THRESHOLD;
    let operator = OperatorState {
        enabled,
        disabled: !enabled,
        e_stop: !e_stop_is_released(&mapping.e_stop, raw),
        dead_man: position(&mapping.dead_man, raw) > DEAD_MAN_THRESHOLD,
        mode: match mapping.mode.position(raw) {
            None => DriveMode::Manual,
            Some(low) if low < -SWITCH_THRESHOLD => DriveMode::Manual,
            Some(high) if high > SWITCH_THRESHOLD => DriveMode::Custom,
            Some(_) => DriveMode::Pc,
        },
        stand: match balance(&mapping.stand) {
            Some(low) if low < -SWITCH_THRESHOLD => StandSwitch::Down,
            Some(high) if high > SWITCH_THRESHOLD => StandSwitch::Up,
            _ => StandSwitch::Unknown,
        },
        jump: balance(&mapping.jump).is_some_and(|at| at > SWITCH_THRESHOLD),
        ts_us,
    };
    (state, operator)
}

fn position(channel: &RemoteChannel, raw: &[u16; 16]) -> f32 {
    channel.position(raw).unwrap_or(0.0)
}

fn e_stop_is_released(e_stop: &RemoteChannel, raw: &[u16; 16]) -> bool {
    let position = e_stop.position(raw);
    position.is_some_and(|at| (E_STOP_LOWEST..=-SWITCH_THRESHOLD).contains(&at))
}

pub(super) fn raw_of_dbus(frame: &DbusFrame) -> [u16; 16] {
    let [a, b, c, d] = frame.sticks;
    let mut raw = [0; 16];
    for (channel, value) in raw.iter_mut().zip([a, b, c, d, frame.wheel]) {
        *channel = value;
    }
    raw
}

/// `wheel` takes each frame once, in order.
pub(super) fn from_dbus(
    frame: &DbusFrame,
    wheel: &mut DbusWheel,
    ts_us: u64,
) -> (RemoteState, OperatorState) {
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
        hold: left_h,
        height: left_v,
        roll: left_h,
        channels,
        ts_us,
    };
    wheel.step(stick(frame.wheel));
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
        stand: wheel.stand(),
        jump: wheel.jump(),
        ts_us,
    };
    (state, operator)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::NO_CHANNEL;

    fn sbus(channels: [u16; 16]) -> SbusFrame {
        SbusFrame {
            channels,
            channel_17: false,
            channel_18: false,
            frame_lost: false,
            failsafe: false,
        }
    }

    /// A Futaba R7003SB sends 352, 1024, 1696 (betaflight and PX4 give 350 to 1700).
    #[test]
    fn each_stick_is_scaled_by_its_own_ends_and_centre() {
        let mut mapping = RemoteMapping::default();
        let futaba = RemoteChannel {
            low: 352,
            centre: 1024,
            high: 1696,
            ..mapping.drive
        };
        mapping.drive = futaba;
        let vx = |mapping: &RemoteMapping, raw| {
            let mut channels = [992; 16];
            channels[usize::try_from(mapping.drive.index).unwrap()] = raw;
            let (state, _) = from_sbus(&sbus(channels), mapping, 1);
            state.vx
        };
        let positions = [
            (352, -1.0),
            (1024, 0.0),
            (1360, 0.5),
            (1696, 1.0),
            (300, -1.0),
        ];
        for (raw, expected) in positions {
            assert_eq!(vx(&mapping, raw), expected, "{raw}");
        }
        mapping.drive = RemoteChannel {
            index: 9,
            reversed: 1,
            ..futaba
        };
        for (raw, expected) in positions {
            assert_eq!(vx(&mapping, raw), -expected, "{raw}");
        }
    }

    #[test]
    fn sticks_and_switches_without_a_channel_take_their_safe_position() {
        let mut mapping = RemoteMapping::default();
        let none = RemoteChannel {
            index: NO_CHANNEL,
            ..mapping.drive
        };
        for channel in [
            &mut mapping.steering,
            &mut mapping.drive,
            &mut mapping.select,
            &mut mapping.dead_man,
            &mut mapping.enable,
            &mut mapping.mode,
            &mut mapping.e_stop,
        ] {
            *channel = none;
        }
        for raw in [0, 172, 992, 1811, 2047] {
            let (state, operator) = from_sbus(&sbus([raw; 16]), &mapping, 1);
            assert_eq!(
                (state.vx, state.wz, state.select, state.hold),
                (0.0, 0.0, 0.0, 0.0)
            );
            assert!(!operator.enabled && operator.disabled && operator.e_stop);
            assert!(!operator.dead_man);
            assert_eq!(operator.mode, DriveMode::Manual);
        }
    }

    /// A receiver without its transmitter may send one value on all channels: 0, an end or the centre.
    #[test]
    fn no_single_value_on_all_channels_enables_the_robot() {
        for raw in 0..=2047 {
            let (_, operator) = from_sbus(&sbus([raw; 16]), &RemoteMapping::default(), 1);
            assert!(!operator.enabled || operator.e_stop, "{raw}");
        }
    }

    #[test]
    fn a_missing_e_stop_channel_stops_the_robot() {
        let stops = |raw| {
            let mut channels = [992; 16];
            channels[6] = raw;
            from_sbus(&sbus(channels), &RemoteMapping::default(), 1)
                .1
                .e_stop
        };
        for (raw, expected) in [
            (0, true),
            (8, false),
            (172, false),
            (582, false),
            (583, true),
        ] {
            assert_eq!(stops(raw), expected, "{raw}");
        }
        for raw in [992, 1811, 2047] {
            assert!(stops(raw), "{raw}");
        }
    }

    /// Channels 7 to 10 with the stand switch, the jump button, height and roll.
    fn balance_of(mapping: &RemoteMapping, raw: [u16; 4]) -> (StandSwitch, bool, f32, f32) {
        let mut channels = [992; 16];
        channels[7..11].copy_from_slice(&raw);
        let (state, operator) = from_sbus(&sbus(channels), mapping, 1);
        (operator.stand, operator.jump, state.height, state.roll)
    }

    #[test]
    fn standing_has_channels_of_its_own() {
        let mut mapping = RemoteMapping::default();
        let of = |raw| balance_of(&RemoteMapping::default(), raw);
        assert_eq!(
            of([172, 172, 172, 172]),
            (StandSwitch::Down, false, -1.0, -1.0)
        );
        assert_eq!(
            of([992, 992, 992, 992]),
            (StandSwitch::Unknown, false, 0.0, 0.0)
        );
        assert_eq!(
            of([1811, 1811, 1811, 1811]),
            (StandSwitch::Up, true, 1.0, 1.0)
        );
        assert_eq!(
            of([2047, 1402, 2047, 0]),
            (StandSwitch::Up, true, 1.0, -1.0)
        );
        assert_eq!(
            of([1401, 1401, 992, 992]),
            (StandSwitch::Unknown, false, 0.0, 0.0)
        );
        for channel in [
            &mut mapping.stand,
            &mut mapping.jump,
            &mut mapping.height,
            &mut mapping.roll,
        ] {
            channel.reversed = 1;
        }
        let reversed = balance_of(&mapping, [172, 172, 172, 1811]);
        assert_eq!(reversed, (StandSwitch::Up, true, 1.0, -1.0));
    }

    /// A robot whose e-stop was moved to channel 7 by an older firmware has no stand switch.
    #[test]
    fn without_a_channel_of_its_own_a_robot_sits() {
        let nothing = (StandSwitch::Unknown, false, 0.0, 0.0);
        let mut taken = RemoteMapping::default();
        taken.e_stop.index = 7;
        taken.enable.index = 8;
        taken.drive.index = 9;
        taken.select.index = 10;
        let mut none = RemoteMapping::default();
        for channel in [
            &mut none.stand,
            &mut none.jump,
            &mut none.height,
            &mut none.roll,
        ] {
            channel.index = NO_CHANNEL;
        }
        for raw in [0, 172, 992, 1811, 2047] {
            assert_eq!(balance_of(&taken, [raw; 4]), nothing);
            assert_eq!(balance_of(&none, [raw; 4]), nothing);
        }
    }

    #[test]
    fn on_dbus_the_wheel_asks_for_standing_and_the_left_stick_shapes_the_robot() {
        let mut wheel = DbusWheel::default();
        let mut after = |position: u16, frames| {
            let mut found = None;
            for _ in 0..frames {
                let frame = DbusFrame {
                    sticks: [1024, 1024, 364, 1684],
                    wheel: position,
                    right_switch: DbusSwitch::Middle,
                    left_switch: DbusSwitch::Up,
                };
                found = Some(from_dbus(&frame, &mut wheel, 1));
            }
            let (state, operator) = found.expect("a frame");
            assert_eq!((state.height, state.roll), (1.0, -1.0));
            (operator.stand, operator.jump)
        };
        assert_eq!(after(364, 10), (StandSwitch::Down, false));
        assert_eq!(after(1684, 10), (StandSwitch::Up, false));
        assert_eq!(after(1024, 1), (StandSwitch::Up, false));
        assert_eq!(after(1684, 1), (StandSwitch::Up, true));
    }

    /// Low end, centre and high end are 172, 992, 1811 for SBUS and 364, 1024, 1684 for DBUS
    /// (docs/hardware.md#sbus, docs/hardware.md#dbus).
    /// The threshold of 0.7 lies at 1566 and 1487.
    #[test]
    fn on_both_radios_the_left_stick_is_dead_man_and_selector() {
        let of_sbus = |select, dead_man| {
            let mut channels = [992; 16];
            (channels[2], channels[3]) = (select, dead_man);
            let (state, operator) = from_sbus(&sbus(channels), &RemoteMapping::default(), 1);
            (state.select, state.hold, operator.dead_man)
        };
        assert_eq!(of_sbus(992, 992), (0.0, 0.0, false));
        assert_eq!(of_sbus(1811, 1811), (1.0, 1.0, true));
        assert_eq!(of_sbus(172, 172), (-1.0, -1.0, false));
        assert_eq!((of_sbus(992, 1565).2, of_sbus(992, 1566).2), (false, true));
        let dbus = |select, dead_man| {
            let frame = DbusFrame {
                sticks: [1024, 1024, dead_man, select],
                wheel: 1024,
                right_switch: DbusSwitch::Middle,
                left_switch: DbusSwitch::Middle,
            };
            let (state, operator) = from_dbus(&frame, &mut DbusWheel::default(), 1);
            (state.select, state.hold, operator.dead_man)
        };
        assert_eq!(dbus(1024, 1024), (0.0, 0.0, false));
        assert_eq!(dbus(364, 1684), (-1.0, 1.0, true));
        assert_eq!(dbus(1684, 364), (1.0, -1.0, false));
        assert_eq!((dbus(1024, 1486).2, dbus(1024, 1487).2), (false, true));
    }
}
