//! Records the robot's state from the PC link.

use std::path::Path;

use anyhow::{Result, bail};
use robot_app::link::Heard;
use robotctl::{
    link_recorder::{GAP_S, LinkRecorder, LinkSummary},
    pc_link::{self, PcLink},
};

use super::progress::Progress;
use crate::command::output::say;

pub fn record(port: &str, path: &Path, seconds: Option<u32>) -> Result<()> {
    let mut link = PcLink::open(port)?;
    let mut recorder = LinkRecorder::create(path)?;
    let mut progress = Progress::start(seconds)?;
    let ended = listen(&mut link, &mut recorder, &mut progress);
    progress.end();
    // Whatever ended it, what was recorded is kept.
    let summary = recorder.finish()?;
    if summary.states > 0 {
        report(&summary)?;
        say!("written to {}", path.display())?;
        say!("next:   robotctl plot {}", path.display())?;
    }
    ended?;
    if summary.states == 0 {
        bail!(
            "no state of the robot came: {}",
            pc_link::why_silent(port, &link.traffic())
        );
    }
    Ok(())
}

fn listen(link: &mut PcLink, recorder: &mut LinkRecorder, progress: &mut Progress) -> Result<()> {
    while let Some(deadline) = progress.next_deadline() {
        if let Some(Heard::Uplink(state)) = link.next(deadline)? {
            progress.heard();
            recorder.add(&state, &link.traffic())?;
        }
        progress.show(|| {
            let summary = recorder.summary();
            format!(
                "{} frames, {:.0}/s, {} CRC errors, {} gaps",
                summary.states,
                summary.rate_hz(),
                summary.counters.crc_errors,
                summary.gaps
            )
        });
    }
    Ok(())
}

fn report(summary: &LinkSummary) -> Result<()> {
    say!(
        "recorded {:.1} s of the robot's time: {} frames, {:.1} a second",
        summary.duration_s,
        summary.states,
        summary.rate_hz()
    )?;
    say!(
        "line:   {} CRC errors, {} bytes discarded in {} places, {} frames dropped as implausible",
        summary.counters.crc_errors,
        summary.counters.discarded_bytes,
        summary.counters.resyncs,
        summary.implausible
    )?;
    if summary.implausible > 0 {
        say!(
            "note: a frame that is implausible was damaged: is the line noisy, or does another program have the port open? \
             Only one may"
        )?;
    }
    match summary.gaps {
        0 => say!("gaps:   none longer than {:.1} ms", GAP_S * 1e3)?,
        gaps => say!(
            "gaps:   {gaps}, {:.2} s missing in all, the longest {:.3} s",
            summary.missing_s,
            summary.longest_gap_s
        )?,
    }
    if summary.restarts > 0 {
        say!(
            "note: the robot restarted {} times meanwhile; its time goes on in the file",
            summary.restarts
        )?;
    }
    Ok(())
}
