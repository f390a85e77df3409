//! Records the sensors of a robot on a bus. Each sample comes once, with the robot's time and without its corrections.

mod samples;

use std::time::{Duration, Instant};

use robot_app::tuning::RecordingState;

pub use samples::Samples;

use crate::{
    calibration::{accel::AccelCorrection, mag::MagCorrection},
    parameter_file::ParameterFile,
    settings,
    tuning::{TuningClient, TuningError},
};

/// Groups of settings that change what is recorded.
const CORRECTIONS: [&str; 2] = ["imu-calibration", "mag-calibration"];
/// A recording that lost a larger share of its samples is refused.
const LOST_AT_MOST: f64 = 0.01;
/// The IMU gives 200 samples a second.
const LEAST_IMU_HZ: f64 = 100.0;

/// How long the recorder waits, by the computer's clock.
#[derive(Clone, Copy, Debug)]
pub struct RecordTimeouts {
    /// Pause between two requests for the state of the recording.
    pub look: Duration,
    /// A recording without samples for this long has failed.
    pub silence: Duration,
}

impl Default for RecordTimeouts {
    fn default() -> Self {
        Self {
            look: Duration::from_millis(200),
            silence: Duration::from_secs(3),
        }
    }
}

#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    #[error(transparent)]
    Robot(#[from] TuningError),
    #[error("the recording ended early: the robot was armed, or its enable switch went on")]
    CutShort,
    #[error("no samples came for {} s: `robotctl status` shows what the sensors do", .0.as_secs())]
    Silent(Duration),
    #[error(
        "{lost} of {sent} samples were lost on the way: another program at the adapter, a busy computer, a slow serial \
         line? Nothing was written"
    )]
    Lost { lost: u32, sent: u32 },
    #[error(
        "the IMU gave only {0} samples: `robotctl status` shows what it does. Nothing was written"
    )]
    FewSamples(u32),
    #[error(
        "the robot's soft-iron matrix has no inverse: `robotctl tune defaults mag-calibration --yes`"
    )]
    SoftIron,
}

/// The samples of a recording, and how many were lost.
#[derive(Clone, Debug)]
pub struct Recorded {
    pub samples: Samples,
    /// Samples that the robot sent and that did not arrive.
    pub lost: u32,
}

/// Records until the robot ends the recording. `progress` gets the seconds recorded so far.
pub fn record(
    client: &mut TuningClient,
    seconds: u16,
    timeouts: RecordTimeouts,
    mut progress: impl FnMut(f64),
) -> Result<Recorded, RecordError> {
    let corrections = corrections(client)?;
    client.start_recording(seconds)?;
    let mut samples = Samples::default();
    let mut heard_at = Instant::now();
    let report = loop {
        let heard = client.receive_samples(Instant::now() + timeouts.look)?;
        if !heard.is_empty() {
            heard_at = Instant::now();
        }
        samples.extend(&heard);
        progress(samples.duration_s());
        let report = client.recording()?;
        if report.state != Ok(RecordingState::Running) {
            break report;
        }
        if heard_at.elapsed() > timeouts.silence {
            client.start_recording(0)?;
            return Err(RecordError::Silent(timeouts.silence));
        }
    };
    // Samples that came before the last reply.
    samples.extend(&client.receive_samples(Instant::now())?);
    if report.state == Ok(RecordingState::CutShort) {
        return Err(RecordError::CutShort);
    }
    if f64::from(report.imu) < LEAST_IMU_HZ * f64::from(seconds) {
        return Err(RecordError::FewSamples(report.imu));
    }
    let sent = report.imu + report.mag;
    let (imu, mag) = samples.counts();
    let lost = report.imu.saturating_sub(imu) + report.mag.saturating_sub(mag);
    if f64::from(lost) > LOST_AT_MOST * f64::from(sent) {
        return Err(RecordError::Lost { lost, sent });
    }
    samples.undo(&corrections.0, &corrections.1)?;
    Ok(Recorded { samples, lost })
}

fn corrections(client: &mut TuningClient) -> Result<(AccelCorrection, MagCorrection), TuningError> {
    let mut file = ParameterFile::default();
    for named in settings::all().filter(|named| CORRECTIONS.contains(&named.group.name)) {
        file.set(&named.full_name(), client.read(named)?);
    }
    Ok((AccelCorrection::read(&file), MagCorrection::read(&file)))
}

#[cfg(test)]
mod tests;
