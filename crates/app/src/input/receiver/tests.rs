use super::*;
use crate::{
    domain::{DriveMode, StandSwitch},
    input::{SBUS_SWITCH_HIGH, SBUS_SWITCH_LOW},
};

/// All channels are 992 and no flag is set (docs/hardware.md#test-vectors).
const SBUS_CENTRED: [u8; 25] = [
    0x0F, 0xE0, 0x03, 0x1F, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0xE0, 0x03, 0x1F, 0xF8,
    0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0x00, 0x00,
];
/// All sticks are 1024 and both switches in the middle (docs/hardware.md#test-vectors).
const DBUS_CENTRED: [u8; 18] = [
    0x00, 0x04, 0x20, 0x00, 0x01, 0xF8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x04,
];

struct Bench {
    receiver: RemoteReceiver,
    frame: &'static [u8],
    character_us: u64,
    now_us: u64,
    updates: Vec<RemoteUpdate>,
}

impl Bench {
    fn sbus() -> Self {
        Self::new(RemoteFormat::Sbus, &SBUS_CENTRED, 120)
    }

    fn dbus() -> Self {
        Self::new(RemoteFormat::Dbus, &DBUS_CENTRED, 110)
    }

    fn new(format: RemoteFormat, frame: &'static [u8], character_us: u64) -> Self {
        Self {
            receiver: RemoteReceiver::new(format, RemoteMapping::default()),
            frame,
            character_us,
            now_us: 1_000_000,
            updates: Vec::new(),
        }
    }

    /// Sends the bytes from `from` to `to` of the frame as one burst.
    fn burst(&mut self, from: usize, to: usize, damaged: bool) {
        self.now_us += (to - from) as u64 * self.character_us;
        if damaged {
            self.receiver.reject(to - from, self.now_us);
        } else {
            let updates = &mut self.updates;
            let bytes = &self.frame[from..to];
            self.receiver
                .feed(bytes, self.now_us, |update| updates.push(update));
        }
    }

    fn frame(&mut self, damaged: bool) {
        self.now_us += 4_000;
        self.burst(0, self.frame.len(), damaged);
    }
}

#[test]
fn a_damaged_frame_is_dropped_and_the_next_one_accepted() {
    for mut bench in [Bench::sbus(), Bench::dbus()] {
        bench.frame(false);
        bench.frame(true);
        assert_eq!(bench.updates.len(), 1);
        bench.frame(false);
        assert_eq!(bench.updates.len(), 2);
        assert_eq!(bench.updates[1].diagnostics.damaged_bursts, 1);
    }
}

/// An interval of 7 ms is 142.857 Hz. The last interval of 10 ms, 100 Hz, has a weight of a tenth.
#[test]
fn the_frame_rate_is_smoothed() {
    let mut bench = Bench::sbus();
    for (pause_us, rate_hz) in [(0, 0.0), (0, 142.857), (0, 142.857), (3_000, 138.571)] {
        bench.now_us += pause_us;
        bench.frame(false);
        let found_hz = bench.updates.last().unwrap().diagnostics.frame_rate_hz;
        assert!((found_hz - rate_hz).abs() < 0.01, "{found_hz} Hz");
    }
}

/// In byte 23, bit 2 is frame lost and bit 3 failsafe.
#[test]
fn lost_and_failsafe_frames_do_not_refresh_the_link() {
    for (flags, alive) in [(0, true), (1 << 2, false), (1 << 3, false), (3 << 2, false)] {
        let mut frame = SBUS_CENTRED;
        frame[23] = flags;
        let mut receiver = RemoteReceiver::new(RemoteFormat::Sbus, RemoteMapping::default());
        let mut good_ts_us = Vec::new();
        receiver.feed(&frame, 1_000_000, |update| {
            good_ts_us.push(update.diagnostics.good_ts_us);
        });
        assert_eq!(good_ts_us, [if alive { 1_000_000 } else { 0 }], "{flags:b}");
    }
}

/// Returns the update after three equal frames, 14 ms apart.
fn decoded(format: RemoteFormat, frame: &[u8]) -> RemoteUpdate {
    let mut receiver = RemoteReceiver::new(format, RemoteMapping::default());
    let mut last = RemoteUpdate::default();
    for count in 1..=3 {
        receiver.feed(frame, count * 14_000, |update| last = update);
    }
    assert_eq!(last.diagnostics.frames, 3);
    last
}

/// As [`decoded`] for a frame with enable off, mode at its low end, e-stop off and all else centred, but for one
/// channel.
fn decoded_sbus(channel: usize, raw: u16) -> RemoteUpdate {
    let mut channels = [992; 16];
    channels[4..7].fill(172);
    channels[channel] = raw;
    let mut frame = [0; 25];
    frame[0] = 0x0F;
    for bit in 0..16 * 11 {
        let is_set = channels[bit / 11] >> (bit % 11) & 1;
        frame[1 + bit / 8] |= (is_set as u8) << (bit % 8);
    }
    decoded(RemoteFormat::Sbus, &frame)
}

#[test]
fn the_stand_switch_acts_at_the_counts_that_the_pc_tool_takes() {
    use StandSwitch::{Down, Unknown, Up};
    for (raw, stand) in [
        (SBUS_SWITCH_LOW, Down),
        (SBUS_SWITCH_LOW + 1, Unknown),
        (SBUS_SWITCH_HIGH - 1, Unknown),
        (SBUS_SWITCH_HIGH, Up),
    ] {
        assert_eq!(decoded_sbus(7, raw).operator.stand, stand, "{raw}");
    }
}

#[test]
fn sbus_switches_act_beyond_half_way() {
    use DriveMode::{Custom, Manual, Pc};
    for (raw, enabled) in [(172, false), (1_401, false), (1_402, true), (1_811, true)] {
        let operator = decoded_sbus(4, raw).operator;
        assert_eq!((operator.enabled, operator.disabled), (enabled, !enabled));
    }
    for (raw, mode) in [(581, Manual), (583, Pc), (1_401, Pc), (1_402, Custom)] {
        assert_eq!(decoded_sbus(5, raw).operator.mode, mode, "{raw}");
    }
    for (raw, e_stop) in [(172, false), (581, false), (583, true), (1_811, true)] {
        assert_eq!(decoded_sbus(6, raw).operator.e_stop, e_stop, "{raw}");
    }
}

#[test]
fn sbus_sticks_drive_forward_and_turn_right() {
    for (raw, position) in [(172, -1.0), (992, 0.0), (1_811, 1.0)] {
        assert_eq!(decoded_sbus(0, raw).state.wz, -position);
        assert_eq!(decoded_sbus(1, raw).state.vx, position);
    }
}

/// A switch sends 1 for up, 2 for down, 3 for middle. The right one lies in bits 4 and 5 of byte 5, the left one
/// above it.
#[test]
fn dbus_switches_enable_stop_and_select_the_mode() {
    let operator = |left: u8, right: u8| {
        let mut frame = DBUS_CENTRED;
        frame[5] = left << 6 | right << 4 | frame[5] & 0x0F;
        decoded(RemoteFormat::Dbus, &frame).operator
    };
    for (right, enabled, e_stop) in [(1, true, false), (3, false, false), (2, false, true)] {
        let found = operator(3, right);
        assert_eq!((found.enabled, found.disabled), (enabled, !enabled));
        assert_eq!(found.e_stop, e_stop);
    }
    for (left, mode) in [
        (1, DriveMode::Manual),
        (3, DriveMode::Pc),
        (2, DriveMode::Custom),
    ] {
        assert_eq!(operator(left, 3).mode, mode);
    }
}

/// This holds wherever the line splits a frame and whichever part is damaged.
#[test]
fn damage_to_one_half_of_a_frame_rejects_the_whole_frame() {
    for make in [Bench::sbus, Bench::dbus] {
        let len = make().frame.len();
        for cut in 1..len {
            for first_damaged in [true, false] {
                let mut bench = make();
                bench.frame(false);
                bench.now_us += 4_000;
                bench.burst(0, cut, first_damaged);
                bench.burst(cut, len, !first_damaged);
                assert_eq!(bench.updates.len(), 1, "cut at {cut}");
                bench.frame(false);
                assert_eq!(bench.updates.len(), 2, "cut at {cut}");
            }
        }
    }
}

/// The frames follow each other directly, so no idle line shows where one starts.
#[test]
fn without_idle_lines_sbus_resynchronises_at_the_second_frame() {
    let mut bench = Bench::sbus();
    bench.frame(false);
    bench.burst(0, 25, true);
    bench.burst(0, 25, false);
    assert_eq!(bench.updates.len(), 1);
    bench.burst(0, 25, false);
    assert_eq!(bench.updates.len(), 2);
}

#[test]
fn damaged_and_cut_frames_count_as_lost() {
    let mut bench = Bench::sbus();
    for _ in 0..64 {
        bench.frame(false);
    }
    assert_eq!(bench.updates[63].diagnostics.quality, 1.0);
    for _ in 0..16 {
        bench.frame(true);
    }
    bench.frame(false);
    assert_eq!(bench.updates[64].diagnostics.quality, 48.0 / 64.0);
    // Twenty-five frames cut to 24 bytes discard as many bytes as 24 frames have.
    for _ in 0..25 {
        bench.now_us += 4_000;
        bench.burst(0, 24, false);
    }
    bench.frame(false);
    bench.frame(false);
    let quality = bench.updates[66].diagnostics.quality;
    assert_eq!(quality, (64.0 - 16.0 - 24.0) / 64.0);
}
