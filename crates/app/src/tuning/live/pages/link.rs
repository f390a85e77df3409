//! Pages of the PC link.

use super::*;
use crate::domain::LinkHealth;

/// Commands of the PC. A robot that has never heard one shows the highest age.
pub const COMMANDS: [LiveField; 3] = [
    measure!("rate-hz", "Hz", 16, 10, |live, _| link(live).rate_hz),
    count!("age-ms", "ms", 16, |live, _| live.diagnostics.pc_age_us
        / 1_000),
    count!("longest-gap-ms", "ms", 16, |live, _| link(live)
        .longest_gap_us
        / 1_000),
];

pub const FRAMES: [LiveField; 2] = [
    count!("good", "", 24, |live, _| link(live).good),
    count!("sent", "", 24, |live, _| link(live).sent),
];

pub const ERRORS: [LiveField; 4] = [
    count!("crc-errors", "", 12, |live, _| link(live).crc_errors),
    count!("resyncs", "", 12, |live, _| link(live).resyncs),
    count!("line-errors", "", 12, |live, _| link(live).line_errors),
    count!("unconfirmed", "", 12, |live, _| link(live).unconfirmed),
];

pub const TUNNEL: [LiveField; 3] = [
    count!("tunnelled", "", 16, |live, _| link(live).tunnelled),
    count!("tunnel-dropped", "", 12, |live, _| link(live)
        .tunnel_dropped),
    count!("discarded-bytes", "", 20, |live, _| link(live)
        .discarded_bytes),
];

fn link<'a>(live: &LiveSource<'a>) -> &'a LinkHealth {
    &live.diagnostics.link
}
