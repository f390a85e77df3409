//! What the gyro measured since the last read, judged frame by frame.
//!
//! One frame a millisecond leaves a low-pass of 116 Hz, so even a blow takes several frames to show: a step of the true
//! rate reaches a third of its height in the first millisecond at most, and nothing that is real goes there and back
//! within one frame. What does so is a mistake on the way, and its neighbours stand for it; what jumps further is
//! nonsense.

/// 488 °/s: a frame further than this from both of its neighbours, on the same side, is a mistake.
const OUTLIER_COUNTS: u16 = 8_000;
/// 1,587 °/s in a millisecond: the largest step of a blow that changes the true rate by 4,800 °/s at once.
const MAX_STEP: u16 = 26_000;
/// Mistakes in one read beyond which none of it counts.
const MAX_OUTLIERS: u8 = 1;
/// Full scale, and the code that no two's complement range has a twin of.
const FULL_SCALE: u16 = 32_767;
/// What a read stands for.
const READ_MS: u8 = 5;

pub(super) type Frame = [i16; 3];

/// Turn rate since the last read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GyroReading {
    pub mean_counts: [f32; 3],
    /// Of each axis at the end of its range.
    pub clipped_ms: [u8; 3],
    /// Frames that were outliers.
    pub outliers: u8,
    pub end: SeriesEnd,
}

/// The newest frame of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SeriesEnd {
    /// As it was measured.
    measured: Frame,
    /// What has used for it: the frame before, if it jumped so that only the next one can tell whether it was right.
    used: Frame,
}

impl GyroReading {
    /// `before`: the end of the series that `frames` go on from, if there is one. None if no gyro turns like that.
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
    /// A frame has been used.
    has_frames: bool,
}

impl Series {
    /// A frame whose turn was not used when it came, but was right, is used now.
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

pub(super) fn is_at_end(count: i16) -> bool {
    count.unsigned_abs() >= FULL_SCALE
}

/// Whether a rate may follow another that was measured up to some milliseconds before.
pub(super) fn is_possible_step(now: Frame, before: Frame) -> bool {
    is_near(now, before, MAX_STEP)
}

fn is_near(a: Frame, b: Frame, limit: u16) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= limit)
}

/// On any axis beyond both neighbours.
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
