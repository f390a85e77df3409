//! The gyro's frames since the last read, checked one by one.
//!
//! Frames come every millisecond from a low-pass of 116 Hz. A step of the true rate therefore reaches a third of its
//! height at most in the first millisecond, and no real motion goes there and back within one frame. A frame that does
//! is an outlier and is replaced by the mean of its neighbours. A larger jump makes the whole read implausible.

/// A frame that differs from both neighbours by more than this (488 °/s), to the same side, is an outlier.
const OUTLIER_COUNTS: u16 = 8_000;
/// Largest step in a millisecond (1,587 °/s): an impact that changes the true rate by 4,800 °/s at once.
const MAX_STEP: u16 = 26_000;
/// Most outliers in a read that is used.
const MAX_OUTLIERS: u8 = 1;
/// Full scale. The code −32,768 lies beyond it.
const FULL_SCALE: u16 = 32_767;
/// Interval of a read.
const READ_MS: u8 = 5;

/// One gyro frame in counts, sensor axes.
pub(super) type Frame = [i16; 3];

/// The angular rate since the last read, sensor axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GyroReading {
    pub mean_counts: [f32; 3],
    /// Time for which each axis was at the end of its range, ms.
    pub clipped_ms: [u8; 3],
    /// Number of frames that were outliers.
    pub outliers: u8,
    pub end: SeriesEnd,
}

/// The newest frame of a read, which the next read continues from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SeriesEnd {
    /// The frame as it was measured.
    measured: Frame,
    /// The frame that was used for it. After a jump this is the frame before, because only the next frame tells whether
    /// the jump was an outlier.
    used: Frame,
}

impl GyroReading {
    /// Evaluates the frames of one read. `before` is the end of the read that they continue. Returns `None` if they are
    /// not plausible.
    pub fn from_frames(frames: &[Frame], before: Option<SeriesEnd>) -> Option<Self> {
        let mut series = Series::default();
        if let (Some(end), Some(first)) = (before, frames.first()) {
            series.resume(end, *first)?;
        }
        let mut measured = Frame::default();
        for (index, frame) in frames.iter().enumerate() {
            measured = *frame;
            series.add(*frame, frames.get(index.saturating_add(1)).copied())?;
        }
        let count = u8::try_from(frames.len()).ok().filter(|count| *count > 0)?;
        Some(Self {
            mean_counts: series.sum.map(|sum| sum / f32::from(count)),
            clipped_ms: series
                .clipped
                .map(|clipped| clipped.saturating_mul(READ_MS).div_ceil(count)),
            outliers: series.outliers,
            end: SeriesEnd {
                measured,
                used: series.last?,
            },
        })
    }
}

#[derive(Debug, Default)]
struct Series {
    sum: [f32; 3],
    clipped: [u8; 3],
    outliers: u8,
    last: Option<Frame>,
    /// A frame of this read has been used.
    has_frames: bool,
}

impl Series {
    /// If the last frame of the previous read was held back and was no outlier after all, its rotation is added now.
    fn resume(&mut self, end: SeriesEnd, first: Frame) -> Option<()> {
        let SeriesEnd { measured, used } = end;
        self.last = Some(used);
        if measured == used {
            return Some(());
        }
        if is_outlier(used, measured, first) {
            return self.count_outlier();
        }
        self.accept(measured)?;
        let held = used.map(f32::from);
        for (sum, held) in self.sum.iter_mut().zip(held) {
            *sum -= held;
        }
        Some(())
    }

    fn add(&mut self, frame: Frame, next: Option<Frame>) -> Option<()> {
        let Some(last) = self.last else {
            return self.accept(frame);
        };
        match next {
            Some(next) if is_outlier(last, frame, next) => {
                self.count_outlier()?;
                self.accept(midpoint(last, next))
            }
            None if self.has_frames && !is_near(last, frame, OUTLIER_COUNTS) => self.accept(last),
            _ => self.accept(frame),
        }
    }

    fn count_outlier(&mut self) -> Option<()> {
        self.outliers = self.outliers.saturating_add(1);
        (self.outliers <= MAX_OUTLIERS).then_some(())
    }

    fn accept(&mut self, frame: Frame) -> Option<()> {
        if self
            .last
            .is_some_and(|last| !is_near(last, frame, MAX_STEP))
        {
            return None;
        }
        for ((sum, clipped), count) in self.sum.iter_mut().zip(&mut self.clipped).zip(frame) {
            *sum += f32::from(count);
            *clipped = clipped.saturating_add(u8::from(is_at_end(count)));
        }
        self.last = Some(frame);
        self.has_frames = true;
        Some(())
    }
}

/// True if an axis is at the end of its range.
pub(super) fn is_at_end(count: i16) -> bool {
    count.unsigned_abs() >= FULL_SCALE
}

/// True if `now` may follow `before` within some milliseconds.
pub(super) fn is_possible_step(now: Frame, before: Frame) -> bool {
    is_near(now, before, MAX_STEP)
}

fn is_near(a: Frame, b: Frame, limit: u16) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= limit)
}

/// True if the frame lies beyond both neighbours on any axis.
fn is_outlier(before: Frame, frame: Frame, after: Frame) -> bool {
    before
        .iter()
        .zip(frame)
        .zip(after)
        .any(|((before, frame), after)| {
            let (low, high) = (after.min(*before), after.max(*before));
            let beyond = |end: i16| frame.abs_diff(end) > OUTLIER_COUNTS;
            (frame > high && beyond(high)) || (frame < low && beyond(low))
        })
}

fn midpoint(a: Frame, b: Frame) -> Frame {
    let [[ax, ay, az], [bx, by, bz]] = [a, b];
    [ax.midpoint(bx), ay.midpoint(by), az.midpoint(bz)]
}

#[cfg(test)]
mod tests;
