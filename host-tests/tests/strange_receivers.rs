//! Byte streams of receivers of many makes, taken from bug reports of other projects. Every sound frame is delivered
//! with the right sticks, and a wrong protocol gives nothing.

use robot_app::{
    domain::RemoteUpdate,
    input::{RemoteFormat, RemoteMapping, RemoteReceiver},
};

/// 12 bit at 100 kbaud.
const SBUS_BYTE_US: u64 = 120;
/// 11 bit at 100 kbaud.
const DBUS_BYTE_US: u64 = 110;

/// 16 channels of 11 bits, lowest bit first.
fn sbus(channels: [u16; 16], flags: u8, footer: u8) -> Vec<u8> {
    let mut frame = vec![0x0F];
    let (mut bits, mut held) = (0u32, 0);
    for channel in channels {
        bits |= u32::from(channel & 0x7FF) << held;
        held += 11;
        while held >= 8 {
            frame.push(bits as u8);
            bits >>= 8;
            held -= 8;
        }
    }
    frame.extend([flags, footer]);
    assert_eq!(frame.len(), 25);
    frame
}

/// Enable on, mode and e-stop low.
fn centred(centre: u16) -> [u16; 16] {
    let mut channels = [centre; 16];
    (channels[4], channels[5], channels[6]) = (1811, 172, 172);
    channels
}

struct Stream {
    format: RemoteFormat,
    byte_us: u64,
    period_us: u64,
}

const SBUS: Stream = Stream {
    format: RemoteFormat::Sbus,
    byte_us: SBUS_BYTE_US,
    period_us: 15_000,
};
const DBUS: Stream = Stream {
    format: RemoteFormat::Dbus,
    byte_us: DBUS_BYTE_US,
    period_us: 14_000,
};

impl Stream {
    fn feed(&self, frames: &[Vec<u8>]) -> Vec<RemoteUpdate> {
        let mut receiver = RemoteReceiver::new(self.format, RemoteMapping::default());
        let mut updates = Vec::new();
        let mut start_us = 1_000_000;
        for frame in frames {
            let end_us = start_us + frame.len() as u64 * self.byte_us;
            receiver.feed(frame, end_us, |update| updates.push(update));
            start_us += self.period_us;
        }
        updates
    }
}

#[test]
fn every_footer_after_silence_is_a_frame_s_end() {
    for footer in (0..=255).filter(|footer| *footer != 0x0F) {
        let updates = SBUS.feed(&vec![sbus(centred(992), 0, footer); 20]);
        assert_eq!(updates.len(), 20, "{footer:#04x}");
        let last = updates[19];
        assert_eq!((last.state.vx, last.state.wz), (0.0, 0.0));
        assert!(last.operator.enabled && !last.operator.e_stop);
        assert_eq!(last.diagnostics.quality, 1.0);
        assert_eq!(last.diagnostics.discarded_bytes, 0);
    }
}

/// Futaba R7003SB: 30 bytes, the 25th is 0x08 (bolderflight/sbus#79). The other five bytes do not count against the link.
#[test]
fn bytes_after_a_frame_do_not_reduce_quality() {
    for footer in [0x00, 0x08] {
        let mut frame = sbus(centred(1024), 0, footer);
        frame.extend([0, 3, 0xC0, 0x33, 0]);
        let updates = SBUS.feed(&vec![frame; 100]);
        assert_eq!(updates.len(), 100);
        let last = updates[99];
        assert_eq!(last.diagnostics.quality, 1.0);
        assert_eq!(last.diagnostics.discarded_bytes, 5 * 99);
        // The receiver's centre lies within the dead band.
        assert!((last.state.vx - 0.039).abs() < 0.001);
        assert!(last.operator.enabled);
    }
}

/// A header among these bytes does not start a frame.
#[test]
fn a_header_after_a_frame_is_ignored() {
    let mut frame = sbus(centred(992), 0, 0x08);
    frame.extend([0x0F, 3, 0x0F, 0x33, 0x0F]);
    let updates = SBUS.feed(&vec![frame; 100]);
    assert_eq!(updates.len(), 100);
    assert_eq!(updates[99].diagnostics.quality, 1.0);
}

/// Nine or more bytes count as a cut frame.
#[test]
fn longer_trailers_count_as_lost_frames() {
    let mut frame = sbus(centred(992), 0, 0x00);
    frame.extend([0x55; 9]);
    let updates = SBUS.feed(&vec![frame; 100]);
    assert_eq!(updates.len(), 100);
    // With nine bytes behind each frame, a frame's 25 bytes are 25 of 34.
    let quality = updates[99].diagnostics.quality;
    assert!((0.6..0.8).contains(&quality), "{quality}");
}

/// A period of 6 ms leaves 3 ms of idle line. Below that a frame must start where the previous one ended.
#[test]
fn every_period_from_3_to_22_ms_is_followed() {
    for period_us in (3_000..=22_000).step_by(500) {
        for footer in [0x00, 0x08, 0x34] {
            let stream = Stream { period_us, ..SBUS };
            let updates = stream.feed(&vec![sbus(centred(992), 0, footer); 100]);
            assert_eq!(updates.len(), 100, "{period_us}");
            let rate_hz = updates[99].diagnostics.frame_rate_hz;
            let expected_hz = 1e6 / period_us as f32;
            assert!((rate_hz - expected_hz).abs() < 0.1, "{rate_hz}");
        }
    }
}

/// Any footer is accepted at a period of 6 ms, even if the interrupt is half a millisecond late.
#[test]
fn silence_of_three_milliseconds_is_seen_whatever_the_footer() {
    let mut receiver = RemoteReceiver::new(RemoteFormat::Sbus, RemoteMapping::default());
    let mut frames = 0;
    for index in 0..100u64 {
        let late_us = if index % 2 == 0 { 500 } else { 0 };
        let end_us = 1_000_000 + index * 6_000 + 3_000 + late_us;
        receiver.feed(&sbus(centred(992), 0, 0x77), end_us, |_| frames += 1);
    }
    assert_eq!(frames, 100);
}

/// A byte is lost on the line and another comes in the gap: 25 bytes that are not a frame.
#[test]
fn a_frame_with_a_pause_inside_needs_a_known_footer() {
    for (footer, delivered) in [(0x77, 0), (0x00, 1)] {
        let mut receiver = RemoteReceiver::new(RemoteFormat::Sbus, RemoteMapping::default());
        let frame = sbus(centred(992), 0, footer);
        let mut frames = 0;
        receiver.feed(&frame[..24], 1_000_000, |_| frames += 1);
        receiver.feed(&frame[24..], 1_000_000 + 4 * SBUS_BYTE_US, |_| frames += 1);
        assert_eq!(frames, delivered, "{footer:#04x}");
    }
}

/// Without silence the byte before a header is no proof that a frame ends there.
#[test]
fn without_an_idle_line_an_unknown_footer_is_rejected() {
    let mut receiver = RemoteReceiver::new(RemoteFormat::Sbus, RemoteMapping::default());
    let frame = sbus(centred(992), 0, 0x77);
    let stream = [&frame[10..], &frame[..], &frame[..], &frame[..]].concat();
    receiver.feed(&stream, 1_000_000, |_| panic!("which phase is it?"));
}

/// End points and beyond: FrSky 172 and 1811, Futaba 352 and 1696, 0 and 2047 with travel at 150 %.
#[test]
fn ends_of_all_makes_drive_and_switch() {
    for (raw, vx, enabled) in [
        (0, -1.0, false),
        (172, -1.0, false),
        (352, -0.780, false),
        (1696, 0.860, true),
        (1716, 0.884, true),
        (1811, 1.0, true),
        (2047, 1.0, true),
    ] {
        let mut channels = centred(992);
        (channels[1], channels[4]) = (raw, raw);
        let updates = SBUS.feed(&vec![sbus(channels, 0, 0); 20]);
        assert_eq!(updates.len(), 20);
        let last = updates[19];
        assert!((last.state.vx - vx).abs() < 0.001, "{raw}");
        assert_eq!(last.operator.enabled, enabled, "{raw}");
        assert_eq!(last.raw, channels);
    }
}

/// A three-position switch of Futaba.
#[test]
fn switches_of_futaba_have_their_three_positions() {
    for (mode, expected) in [(352, 0), (1024, 1), (1696, 2)] {
        for (e_stop, stops) in [(352, false), (1024, true), (1696, true)] {
            let mut channels = centred(1024);
            (channels[4], channels[5], channels[6]) = (1696, mode, e_stop);
            let updates = SBUS.feed(&vec![sbus(channels, 0, 0); 20]);
            let operator = updates[19].operator;
            assert_eq!(operator.mode as u8, expected);
            assert_eq!(operator.e_stop, stops);
            assert!(operator.enabled);
        }
    }
}

/// Receivers that lost their transmitter and have no flag for it: no channel, or all at one value.
#[test]
fn failsafe_presets_without_a_flag_never_enable_the_robot() {
    for raw in [0, 172, 992, 1024, 1811, 2047] {
        let updates = SBUS.feed(&vec![sbus([raw; 16], 0, 0); 20]);
        let operator = updates[19].operator;
        assert!(!operator.enabled || operator.e_stop, "{raw}");
    }
}

/// ArduPilot#31088: a receiver that flags every frame from some time on; X4R: every second one.
#[test]
fn flagged_frames_move_no_stick_and_reduce_quality() {
    let flagged = |count: usize, lost: fn(usize) -> bool| {
        let frames: Vec<_> = (0..count)
            .map(|index| sbus(centred(992), if lost(index) { 4 } else { 0 }, 0))
            .collect();
        let updates = SBUS.feed(&frames);
        assert_eq!(updates.len(), count);
        updates[count - 1].diagnostics
    };
    let for_ever = flagged(140, |index| index >= 70);
    assert_eq!((for_ever.quality, for_ever.lost_frames), (0.0, 70));
    assert!(for_ever.age_us >= 1_000_000);
    assert_eq!(flagged(128, |index| index % 2 == 0).quality, 0.5);
    let two_of_three = flagged(126, |index| index % 3 != 0).quality;
    assert!((0.3..0.36).contains(&two_of_three), "{two_of_three}");
}

const DBUS_CENTRED: [u8; 18] = [
    0x00, 0x04, 0x20, 0x00, 0x01, 0xF8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x04,
];

/// The image is the wrong one for this receiver, or the line has no inverter (betaflight#4867).
#[test]
fn another_protocol_gives_nothing() {
    assert!(SBUS.feed(&vec![DBUS_CENTRED.to_vec(); 50]).is_empty());
    assert!(DBUS.feed(&vec![sbus(centred(992), 0, 0); 50]).is_empty());
    let inverted: Vec<u8> = sbus(centred(992), 0, 0).iter().map(|byte| !byte).collect();
    assert!(SBUS.feed(&vec![inverted; 50]).is_empty());
}

#[test]
fn dbus_has_its_own_centre_whatever_the_settings() {
    for period_us in [7_000, 14_000] {
        let stream = Stream { period_us, ..DBUS };
        let updates = stream.feed(&vec![DBUS_CENTRED.to_vec(); 20]);
        assert_eq!(updates.len(), 20);
        let RemoteUpdate { state, raw, .. } = updates[19];
        assert_eq!((state.vx, state.wz, state.select), (0.0, 0.0, 0.0));
        assert_eq!(raw[..5], [1024; 5]);
        assert_eq!(raw[5..], [0; 11]);
    }
    let mut longer = DBUS_CENTRED.to_vec();
    longer.extend([0, 0, 0]);
    assert!(DBUS.feed(&vec![longer; 20]).is_empty());
}
