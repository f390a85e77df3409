//! Records all frames of a CAN bus.

use std::{
    path::Path,
    time::{Instant, SystemTime, UNIX_EPOCH},
};

use anyhow::{Result, bail};
use robotctl::{
    can_link::{CanDevice, CanLink},
    can_recorder::{CanRecorder, CanSummary},
};

use super::progress::Progress;
use crate::command::output::say;

pub fn record(device: &CanDevice, path: &Path, seconds: Option<u32>) -> Result<()> {
    let mut link = device.open()?;
    let mut recorder = CanRecorder::create(path)?;
    let mut progress = Progress::start(seconds)?;
    let ended = listen(link.as_mut(), &mut recorder, &mut progress);
    progress.end();
    // Whatever ended it, what was recorded is kept.
    let summary = recorder.finish()?;
    if summary.frames > 0 {
        report(&summary)?;
        say!("written to {}", path.display())?;
        say!("next:   robotctl plot {}", path.display())?;
    }
    ended?;
    if summary.frames == 0 {
        bail!("no frame came through {device}: {}", link.why_silent());
    }
    Ok(())
}

fn listen(
    link: &mut dyn CanLink,
    recorder: &mut CanRecorder,
    progress: &mut Progress,
) -> Result<()> {
    // The computer's time of day may jump, so it is read once.
    let (start, start_ns) = (Instant::now(), now_ns());
    while let Some(deadline) = progress.next_deadline() {
        if let Some(frame) = link.receive(deadline)? {
            progress.heard();
            recorder.add(&frame, start_ns + start.elapsed().as_nanos() as u64)?;
        }
        progress.show(|| {
            let summary = recorder.summary();
            format!("{} frames, {:.0}/s", summary.frames, summary.rate_hz())
        });
    }
    Ok(())
}

/// Returns ns since 1970.
fn now_ns() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| since.as_nanos() as u64)
}

fn report(summary: &CanSummary) -> Result<()> {
    say!(
        "recorded {:.1} s: {} frames, {:.0} a second, bus load about {:.0} %, longest silence {:.1} ms",
        summary.duration.as_secs_f64(),
        summary.frames,
        summary.rate_hz(),
        100.0 * summary.load(),
        summary.longest_gap.as_secs_f64() * 1e3
    )?;
    let seconds = summary.duration.as_secs_f64().max(1e-9);
    for (id, count) in &summary.of_id {
        say!(
            "  {id:#05x}  {count:>8} frames  {:>7.1}/s",
            *count as f64 / seconds
        )?;
    }
    Ok(())
}
