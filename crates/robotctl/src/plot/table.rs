//! The page of a table for calibration.

use std::path::Path;

use robot_chart::Figure;

use super::{
    Content, PlotError,
    series::{Axis, Words, gaps, with_gaps},
};
use crate::recording::{self, RecordingError, Sample, Sensor};

/// A longer time without a sample is a gap. This is the time of ten samples of the IMU.
const GAP_S: f64 = 0.05;

pub(super) fn content(path: &Path) -> Result<Content, PlotError> {
    let accel = recording::load(path, Sensor::Accelerometer);
    let mag = recording::load(path, Sensor::Magnetometer);
    let (accel, mag) = match (accel, mag) {
        // Neither sensor: the first error says what is expected.
        (Err(error), Err(_)) => return Err(error.into()),
        (Err(error @ RecordingError::File { .. }), _) => return Err(error.into()),
        (accel, mag) => (accel.unwrap_or_default(), mag.unwrap_or_default()),
    };
    let times = || accel.iter().chain(&mag).map(|sample| sample.t_s);
    let start_s = times().fold(f64::INFINITY, f64::min);
    let end_s = times().fold(f64::NEG_INFINITY, f64::max);
    let duration_s = (end_s - start_s).max(1e-3);
    let densest = if accel.is_empty() { &mag } else { &accel };
    let axis = Axis {
        time: 0.0..duration_s,
        gaps: gaps(
            densest.iter().map(|sample| sample.t_s - start_s),
            4.0 * GAP_S,
        ),
        marks: Vec::new(),
    };
    let sensors = [
        (
            &accel,
            "Accelerations",
            "m/s²",
            "Each still position must show a magnitude near 9.8.",
        ),
        (
            &mag,
            "Magnetic field",
            "µT",
            "A calibrated field has the same magnitude in all attitudes.",
        ),
    ];
    let mut body = String::new();
    for (samples, title, unit, caption) in sensors {
        let words = Words {
            title,
            caption,
            unit,
        };
        let figure = axis.figure(&words, curves(samples, start_s))?;
        body.extend(figure.as_ref().map(Figure::html));
    }
    Ok(Content {
        summary: format!(
            "{duration_s:.1} s, {} samples of the accelerometer, {} of the magnetometer",
            accel.len(),
            mag.len()
        ),
        body,
    })
}

fn curves(samples: &[Sample], start_s: f64) -> Vec<(String, super::series::Points)> {
    let curve = |label: &str, value: &dyn Fn(&Sample) -> f64| {
        let points = samples
            .iter()
            .map(|sample| (sample.t_s - start_s, Some(value(sample))));
        (label.to_owned(), with_gaps(points, 4.0 * GAP_S))
    };
    vec![
        curve("x", &|sample| sample.value.x),
        curve("y", &|sample| sample.value.y),
        curve("z", &|sample| sample.value.z),
        curve("magnitude", &|sample| sample.value.norm()),
    ]
}
