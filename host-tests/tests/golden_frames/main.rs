//! The frames of docs/hardware.md#test-vectors, computed there from the protocol tables, and the joint motors' frames as
//! the makers' documents and C code give them, and those of the PC link as the tables of its document give them, through
//! the public interface.

mod dm4310;
mod link;
mod mit_vectors;
mod rs00;

use robot_app::{
    domain::{BusId, DriveMode, MotorCurrent, RemoteUpdate},
    input::{DbusFrame, DbusSwitch, RemoteFormat, RemoteMapping, RemoteReceiver, SbusFrame},
    motor::{layout::ROBOT_LAYOUT, m3508},
};

const SBUS_CENTRED: [u8; 25] = [
    0x0F, 0xE0, 0x03, 0x1F, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0xE0, 0x03, 0x1F, 0xF8,
    0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0x00, 0x00,
];
/// Channel 1 = 172, channel 2 = 1811, frame lost and failsafe.
const SBUS_FAILSAFE: [u8; 25] = [
    0x0F, 0xAC, 0x98, 0x38, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0xE0, 0x03, 0x1F, 0xF8,
    0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0x0C, 0x00,
];
const DBUS_CENTRED: [u8; 18] = [
    0x00, 0x04, 0x20, 0x00, 0x01, 0xF8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x04,
];
/// 364, 1684, 1024, 1684, right up, left down.
const DBUS_DEFLECTED: [u8; 18] = [
    0x6C, 0xA1, 0x34, 0x00, 0x29, 0x9D, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x04,
];

#[test]
fn sbus_centred() {
    let frame = SbusFrame::parse(&SBUS_CENTRED).unwrap();
    assert_eq!(frame.channels, [992; 16]);
    assert!(!frame.frame_lost && !frame.failsafe && !frame.channel_17 && !frame.channel_18);
}

#[test]
fn sbus_failsafe() {
    let frame = SbusFrame::parse(&SBUS_FAILSAFE).unwrap();
    assert_eq!(frame.channels[..3], [172, 1811, 992]);
    assert_eq!(frame.channels[3..], [992; 13]);
    assert!(frame.frame_lost && frame.failsafe);
}

#[test]
fn dbus_centred() {
    let frame = DbusFrame::parse(&DBUS_CENTRED).unwrap();
    assert_eq!(frame.sticks, [1024; 4]);
    assert_eq!(frame.wheel, 1024);
    assert_eq!(frame.right_switch, DbusSwitch::Middle);
    assert_eq!(frame.left_switch, DbusSwitch::Middle);
}

#[test]
fn dbus_deflected() {
    let frame = DbusFrame::parse(&DBUS_DEFLECTED).unwrap();
    assert_eq!(frame.sticks, [364, 1684, 1024, 1684]);
    assert_eq!(frame.right_switch, DbusSwitch::Up);
    assert_eq!(frame.left_switch, DbusSwitch::Down);
}

#[test]
fn dbus_out_of_range_is_rejected() {
    let mut no_switch = DBUS_CENTRED;
    no_switch[5] = 0xC8;
    let mut far_stick = DBUS_CENTRED;
    far_stick[0] = 0xFF;
    far_stick[1] = 0x07;
    let mut third_button = DBUS_CENTRED;
    third_button[12] = 2;
    for frame in [no_switch, far_stick, third_button] {
        assert_eq!(DbusFrame::parse(&frame), None);
    }
}

/// A transmitter without a wheel sends zeros or its own bits in bytes 16 and 17.
#[test]
fn no_value_of_the_dbus_wheel_invalidates_a_frame() {
    let centred = DbusFrame::parse(&DBUS_CENTRED).unwrap();
    for sent in 0..=u16::MAX {
        let mut bytes = DBUS_CENTRED;
        bytes[16..].copy_from_slice(&sent.to_le_bytes());
        let expected = DbusFrame {
            wheel: sent % 2_048,
            ..centred
        };
        assert_eq!(DbusFrame::parse(&bytes), Some(expected), "{sent:#06x}");
    }
}

/// Feeds the frame twice, as its content counts when the next frame confirms it.
fn last_update(format: RemoteFormat, bytes: &[u8]) -> Option<RemoteUpdate> {
    let mut receiver = RemoteReceiver::new(format, RemoteMapping::default());
    let mut last = None;
    for ts_us in [20_000, 27_000] {
        receiver.feed(bytes, ts_us, |update| last = Some(update));
    }
    last
}

/// SBUS bytes for sixteen raw channels, packed here bit by bit.
fn sbus(channels: [u16; 16]) -> [u8; 25] {
    let mut frame = [0; 25];
    frame[0] = 0x0F;
    for bit in 0..176 {
        let value = channels[bit / 11] >> (bit % 11) & 1;
        frame[1 + bit / 8] |= (value as u8) << (bit % 8);
    }
    frame
}

#[test]
fn sbus_sticks_and_switches_follow_the_mapping() {
    let mut channels = [992; 16];
    channels[0] = 1811; // stick right: turn right
    channels[1] = 1811; // stick forward
    channels[4] = 1811; // enabled
    channels[5] = 1811; // mode 2
    channels[6] = 172; // run
    let update = last_update(RemoteFormat::Sbus, &sbus(channels)).unwrap();
    assert_eq!((update.state.vx, update.state.wz), (1.0, -1.0));
    assert!(update.operator.enabled && !update.operator.e_stop);
    assert_eq!(update.operator.mode, DriveMode::Custom);

    let update = last_update(RemoteFormat::Sbus, &SBUS_CENTRED).unwrap();
    assert_eq!((update.state.vx, update.state.wz), (0.0, 0.0));
    assert!(!update.operator.enabled);
    assert!(
        update.operator.e_stop,
        "only a switch clearly low means run"
    );
    assert_eq!(update.operator.mode, DriveMode::Pc);
}

#[test]
fn channels_are_normalised_to_the_unit_range() {
    for (raw, expected) in [
        (0, -1.0),
        (172, -1.0),
        (582, -0.5),
        (1811, 1.0),
        (2047, 1.0),
    ] {
        let update = last_update(RemoteFormat::Sbus, &sbus([raw; 16])).unwrap();
        assert_eq!(update.state.channels, [expected; 16]);
    }
}

#[test]
fn dbus_sticks_and_switches_follow_the_mapping() {
    let update = last_update(RemoteFormat::Dbus, &DBUS_DEFLECTED).unwrap();
    assert_eq!((update.state.vx, update.state.wz), (1.0, 1.0));
    assert!(update.operator.enabled && !update.operator.e_stop);
    assert_eq!(update.operator.mode, DriveMode::Custom);
    let update = last_update(RemoteFormat::Dbus, &DBUS_CENTRED).unwrap();
    assert!(!update.operator.enabled && !update.operator.e_stop);
}

#[test]
fn a_failsafe_frame_moves_no_stick() {
    let mut receiver = RemoteReceiver::new(RemoteFormat::Sbus, RemoteMapping::default());
    let mut updates = Vec::new();
    receiver.feed(&SBUS_CENTRED, 10_000, |update| updates.push(update));
    receiver.feed(&SBUS_FAILSAFE, 17_000, |update| updates.push(update));
    let [before, after] = updates[..] else {
        panic!("two frames, {} updates", updates.len());
    };
    assert_eq!(after.state, before.state);
    assert!(after.diagnostics.failsafe);
    assert_eq!(after.diagnostics.lost_frames, 1);
    assert_eq!(after.diagnostics.age_us, 7_000);
    assert_eq!(after.diagnostics.at(30_000).age_us, 20_000);
}

#[test]
fn m3508_currents() {
    let current = |counts: f32| MotorCurrent::clamped(counts * 20_000.0 / 16_384.0, f32::INFINITY);
    let frame = m3508::encode_currents([1_000.0, -1_000.0, 16_384.0, -16_384.0].map(current));
    assert_eq!(
        frame.payload(),
        [0x03, 0xE8, 0xFC, 0x18, 0x40, 0x00, 0xC0, 0x00]
    );
}

/// 0x200 with all zero on CAN1; FF FF FF FF FF FF FF FD for motors 1 to 4 on CAN2.
#[test]
fn safe_frames_stop_every_motor() {
    let frames: Vec<(BusId, u16, Vec<u8>)> = ROBOT_LAYOUT
        .safe_frames()
        .iter()
        .map(|(bus, frame)| (*bus, frame.id().raw(), frame.payload().to_vec()))
        .collect();
    let disable = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD].to_vec();
    assert_eq!(
        frames,
        [
            (BusId::Can1, 0x200, vec![0; 8]),
            (BusId::Can2, 0x001, disable.clone()),
            (BusId::Can2, 0x002, disable.clone()),
            (BusId::Can2, 0x003, disable.clone()),
            (BusId::Can2, 0x004, disable),
        ]
    );
}
