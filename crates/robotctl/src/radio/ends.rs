//! Finds the ends of sticks and switches.

use robot_app::domain::RemoteChannel;

use super::{
    Frame, MappedControl, Movement,
    movement::{MoveError, sorted},
};

/// Number of frames that must show an end. SBUS has no checksum, so a single frame may be wrong.
const FRAMES_AT_AN_END: usize = 3;
/// A stick must come as near as this to the end at which it was held before.
const MOST_MISSED: u16 = 60;
/// Least distance of a stick's end from its centre.
const LEAST_SPAN: u16 = 300;

/// Returns the settings of a stick. It went to all its ends in `frames`.
pub fn stick(moved: &Movement, frames: &[Frame]) -> Result<RemoteChannel, MoveError> {
    let counts = sorted(frames, moved.index);
    let (centre, held) = (moved.from, moved.to);
    let end = |place: Option<usize>| place.and_then(|place| counts.get(place));
    let low = *end(Some(FRAMES_AT_AN_END - 1)).unwrap_or(&centre);
    let high = *end(counts.len().checked_sub(FRAMES_AT_AN_END)).unwrap_or(&centre);
    let (down, up) = (centre.saturating_sub(low), high.saturating_sub(centre));
    let reached =
        low <= held.saturating_add(MOST_MISSED) && held <= high.saturating_add(MOST_MISSED);
    let is_lopsided = down.min(up) < LEAST_SPAN.max(down.max(up) / 2);
    if !reached || is_lopsided {
        return Err(MoveError::Ends {
            name: moved.control.name(),
            index: moved.index,
            low,
            centre,
            high,
            held,
        });
    }
    Ok(channel(moved, low, centre, high))
}

impl MappedControl {
    /// Returns a switch, which was at both of its ends.
    pub fn switch(moved: &Movement) -> Self {
        let (low, high) = (moved.from.min(moved.to), moved.from.max(moved.to));
        Self {
            control: moved.control,
            channel: Some(channel(moved, low, low.midpoint(high), high)),
        }
    }
}

fn channel(moved: &Movement, low: u16, centre: u16, high: u16) -> RemoteChannel {
    RemoteChannel {
        index: moved.index as u32,
        low: low.into(),
        centre: centre.into(),
        high: high.into(),
        reversed: moved.is_reversed().into(),
    }
}
