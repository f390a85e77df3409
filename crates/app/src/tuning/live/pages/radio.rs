//! Pages of the pilot's switches and the radio link.

use super::*;

pub const OPERATOR: [LiveField; 2] = [
    set!("switches", 4, |bit| named(&SWITCHES, bit), |live, _| {
        let operator = &live.diagnostics.operator;
        marks([
            operator.enabled,
            operator.disabled,
            operator.e_stop,
            operator.dead_man,
        ])
    }),
    choice!(
        "mode",
        2,
        &["manual", "pc", "custom"],
        |live, _| live.diagnostics.operator.mode as u32
    ),
];

pub const LINK: [LiveField; 4] = [
    measure!("rate-hz", "Hz", 16, 10, |live, _| live
        .diagnostics
        .remote_diag
        .frame_rate_hz),
    measure!("quality-percent", "%", 8, 1, |live, _| live
        .diagnostics
        .remote_diag
        .quality
        * 100.0),
    count!("age-ms", "ms", 16, |live, _| live
        .diagnostics
        .remote_diag
        .age_us
        / 1_000),
    set!("marks", 1, |bit| named(&["failsafe"], bit), |live, _| {
        marks([live.diagnostics.remote_diag.failsafe])
    }),
];

pub const FRAMES: [LiveField; 2] = [
    count!("accepted", "", 24, |live, _| live
        .diagnostics
        .remote_diag
        .frames),
    count!("marked-lost", "", 24, |live, _| live
        .diagnostics
        .remote_diag
        .lost_frames),
];

pub const LINE: [LiveField; 2] = [
    count!("bytes", "", 32, |live, _| live
        .diagnostics
        .radio_line
        .rx_bytes),
    count!("bytes-of-no-frame", "", 16, |live, _| live
        .diagnostics
        .remote_diag
        .discarded_bytes),
];

pub const ERRORS: [LiveField; 4] = [
    count!("parity", "", 12, |live, _| live
        .diagnostics
        .radio_line
        .parity),
    count!("framing", "", 12, |live, _| live
        .diagnostics
        .radio_line
        .framing),
    count!("noise", "", 12, |live, _| live.diagnostics.radio_line.noise),
    count!("overrun", "", 12, |live, _| live
        .diagnostics
        .radio_line
        .overrun),
];

/// Four channels a page, −1…1.
pub const CHANNELS: [LiveField; 4] = [
    measure!("first", "", 12, 1_000, |live, part| channel(live, part, 0)),
    measure!("second", "", 12, 1_000, |live, part| channel(live, part, 1)),
    measure!("third", "", 12, 1_000, |live, part| channel(live, part, 2)),
    measure!("fourth", "", 12, 1_000, |live, part| channel(live, part, 3)),
];

/// The same channels in raw counts: SBUS 0…2047; DBUS has five, and the others are 0. All are 0 before the first
/// frame.
pub const RAW_CHANNELS: [LiveField; 4] = [
    count!("first", "", 12, |live, part| raw_channel(live, part, 0)),
    count!("second", "", 12, |live, part| raw_channel(live, part, 1)),
    count!("third", "", 12, |live, part| raw_channel(live, part, 2)),
    count!("fourth", "", 12, |live, part| raw_channel(live, part, 3)),
];

const SWITCHES: [&str; 4] = ["enabled", "disabled", "e-stop", "dead-man"];

/// NaN before the first frame.
fn channel(live: &LiveSource<'_>, part: usize, place: usize) -> f32 {
    let remote = &live.diagnostics.remote;
    match remote.channels.get(index_of(part, place)) {
        Some(channel) if remote.ts_us != 0 => *channel,
        _ => f32::NAN,
    }
}

fn raw_channel(live: &LiveSource<'_>, part: usize, place: usize) -> u32 {
    let raw = live.diagnostics.remote_raw.get(index_of(part, place));
    raw.copied().unwrap_or(0).into()
}

fn index_of(part: usize, place: usize) -> usize {
    part.saturating_mul(4).saturating_add(place)
}
