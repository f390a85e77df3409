//! Finds the pieces of a recording in which the robot was held still.

use nalgebra::Vector3;

use crate::{recording::Sample, statistics::mean};

/// Length of the shortest still position, without the piece that is cut off at each end.
pub(super) const MIN_WINDOW_S: f64 = 1.0;
/// Length of a piece. Each piece is still or not.
const PIECE_S: f64 = 0.2;
const MIN_PIECE_SAMPLES: usize = 5;
/// A longer pause in the samples ends a piece.
const MAX_PAUSE_S: f64 = 0.1;
/// Largest standard deviation of each axis. The BMI088's noise is 0.02 m/s² at 80 Hz bandwidth, and a trembling hand
/// causes 0.2.
const MAX_DEVIATION_MPS2: f64 = 0.08;
/// Largest difference between one piece and the next, and between any piece and the first of its window.
const MAX_DRIFT_MPS2: f64 = 0.08;
/// Range for the size of the mean. A robot under a steady push is not at rest.
const PLAUSIBLE_MPS2: std::ops::Range<f64> = 7.0..12.5;

/// One still position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StillWindow {
    pub start_s: f64,
    pub end_s: f64,
    pub samples: usize,
    /// Mean of the raw samples.
    pub mean_mps2: Vector3<f64>,
}

/// The samples of a fifth of a second.
struct Piece<'a> {
    samples: &'a [Sample],
    mean_mps2: Vector3<f64>,
    still: bool,
}

impl<'a> Piece<'a> {
    fn of(samples: &'a [Sample]) -> Self {
        let mean_mps2 = mean(samples.iter().map(|s| s.value));
        let variance = mean(samples.iter().map(|s| {
            let offset = s.value - mean_mps2;
            offset.component_mul(&offset)
        }));
        let still = samples.len() >= MIN_PIECE_SAMPLES
            && variance.max().sqrt() < MAX_DEVIATION_MPS2
            && PLAUSIBLE_MPS2.contains(&mean_mps2.norm());
        Self {
            samples,
            mean_mps2,
            still,
        }
    }
}

pub(super) fn windows(recording: &[Sample]) -> Vec<StillWindow> {
    let mut windows = Vec::new();
    for run in recording.chunk_by(|a, b| b.t_s - a.t_s <= MAX_PAUSE_S) {
        let pieces: Vec<Piece> = pieces(run);
        let mut rest = pieces.as_slice();
        while let Some(first) = rest.iter().position(|p| p.still) {
            let length = still_length(&rest[first..]);
            windows.extend(window(&rest[first..first + length]));
            rest = &rest[first + length..];
        }
    }
    windows
}

fn pieces(run: &[Sample]) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let mut rest = run;
    while let Some(first) = rest.first() {
        let length = rest
            .iter()
            .take_while(|s| s.t_s - first.t_s < PIECE_S)
            .count();
        let (piece, after) = rest.split_at(length);
        pieces.push(Piece::of(piece));
        rest = after;
    }
    pieces
}

/// Returns how many pieces from the first on belong to one position.
fn still_length(pieces: &[Piece]) -> usize {
    let first = pieces[0].mean_mps2;
    let mut last = first;
    pieces
        .iter()
        .take_while(|piece| {
            let steady = (piece.mean_mps2 - last).amax() < MAX_DRIFT_MPS2
                && (piece.mean_mps2 - first).amax() < MAX_DRIFT_MPS2;
            last = piece.mean_mps2;
            piece.still && steady
        })
        .count()
}

/// Returns the position without its first and last piece, in which the hand may still touch the robot.
fn window(pieces: &[Piece]) -> Option<StillWindow> {
    let [_, inner @ .., _] = pieces else {
        return None;
    };
    let start_s = inner.first()?.samples.first()?.t_s;
    let end_s = inner.last()?.samples.last()?.t_s;
    let samples: Vec<_> = inner
        .iter()
        .flat_map(|p| p.samples)
        .map(|s| s.value)
        .collect();
    // Samples stand at the ends of the span, so a second of them spans one period less.
    let period_s = (end_s - start_s) / (samples.len().max(2) - 1) as f64;
    (end_s - start_s + period_s >= MIN_WINDOW_S - 1e-6).then(|| StillWindow {
        start_s,
        end_s,
        samples: samples.len(),
        mean_mps2: mean(samples.into_iter()),
    })
}
