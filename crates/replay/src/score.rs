//! The metric of the BROAD trials, as their `score.py` computes it.

use robot_plant::attitude::AttitudeError;
use serde::Serialize;

use crate::{
    reference::Reference,
    run::{Mode, Run},
    trial::Trial,
};

/// The instants at which estimate and reference are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// The instants of the reference. The estimate is interpolated between its neighbours (`score.py --at ref`).
    Samples,
    /// The instants of the 1 kHz output. The reference is interpolated between its neighbours (`score.py --at est`).
    EveryTick,
}

/// Root mean square errors over the scored phase.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    pub total_deg: f64,
    pub heading_deg: f64,
    pub inclination_deg: f64,
}

impl Figures {
    /// Returns the mean, or `None` if there are no errors.
    pub fn mean(all: &[Self]) -> Option<Self> {
        let mean = |part: fn(&Self) -> f64| all.iter().map(part).sum::<f64>() / all.len() as f64;
        (!all.is_empty()).then(|| Self {
            total_deg: mean(|figures| figures.total_deg),
            heading_deg: mean(|figures| figures.heading_deg),
            inclination_deg: mean(|figures| figures.inclination_deg),
        })
    }
}

/// Estimate and reference at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    pub t_s: f64,
    /// True in the scored phase.
    pub scored: bool,
    /// `None` in a gap of the reference.
    pub error: Option<AttitudeError>,
}

impl Run {
    /// Returns the errors over the scored phase of `trial`, which must be the trial of this run. It is `None` if the
    /// trial has no reference there.
    pub fn score(&self, trial: &Trial, at: At) -> Option<Figures> {
        let mut sums = [0.0; 3];
        let mut count = 0_u32;
        let compared = self.compare(trial, at);
        for error in compared.iter().filter(|instant| instant.scored) {
            let Some(error) = error.error else { continue };
            let parts = [
                error.total_deg(),
                error.heading_deg(),
                error.inclination_deg(),
            ];
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum += part * part;
            }
            count += 1;
        }
        let [total_deg, heading_deg, inclination_deg] =
            sums.map(|sum| (sum / f64::from(count)).sqrt());
        (count > 0).then_some(Figures {
            total_deg,
            heading_deg,
            inclination_deg,
        })
    }

    /// Returns the error at every instant of the record, scored or not. It is empty without a reference. In 6d mode,
    /// the heading error of the last second before the scored phase is subtracted from all of them.
    pub fn compare(&self, trial: &Trial, at: At) -> Vec<Instant> {
        let Some(reference) = &trial.reference else {
            return Vec::new();
        };
        let mut compared = self.errors(reference, at);
        if self.mode == Mode::SixAxis {
            let offset_rad = heading_offset_rad(&compared);
            for instant in &mut compared {
                let without = |error: AttitudeError| error.without_heading(offset_rad);
                instant.error = instant.error.map(without);
            }
        }
        compared
    }

    fn errors(&self, reference: &Reference, at: At) -> Vec<Instant> {
        let track = self.track();
        let times = match at {
            At::Samples => &reference.track,
            At::EveryTick => &track,
        };
        let instant = |index| {
            let t_s = times.time_s(index);
            let known = track.at(t_s).zip(reference.track.at(t_s));
            Instant {
                t_s,
                scored: reference.scored(t_s),
                error: known.map(|(estimate, truth)| AttitudeError::between(estimate, truth)),
            }
        };
        (0..times.attitudes.len()).map(instant).collect()
    }
}

/// Returns the mean heading error over the last known second before the scored phase, or over the first known second if
/// nothing is known before.
fn heading_offset_rad(compared: &[Instant]) -> f64 {
    let from = compared.iter().position(|instant| instant.scored);
    let known = |instants: &[Instant]| -> Vec<f64> {
        let errors = instants.iter().filter_map(|instant| instant.error);
        errors.map(|e| e.heading_deg().to_radians()).collect()
    };
    let a_second = match compared {
        [first, second, ..] => (1.0 / (second.t_s - first.t_s)).round_ties_even() as usize,
        _ => 1,
    };
    let before = known(&compared[..from.unwrap_or(0)]);
    let headings = match before.len().checked_sub(a_second) {
        Some(skipped) => before[skipped..].to_vec(),
        None if before.is_empty() => known(compared).into_iter().take(a_second).collect(),
        None => before,
    };
    let (sin, cos) = headings.iter().fold((0.0, 0.0), |(sin, cos), heading| {
        (sin + heading.sin(), cos + heading.cos())
    });
    sin.atan2(cos)
}
