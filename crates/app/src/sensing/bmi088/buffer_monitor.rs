//! Whether the gyro's buffer (its FIFO) agrees with the data registers, over several samples.

use super::decode::{BufferCheck, GyroRaw};
use crate::domain::GyroBufferStatus;

/// Samples in a row (20 ms) that differ from the data registers before the buffer is reset.
const MAX_DIFFERENT: u8 = 4;

/// Counts what each sample shows of the buffer, and asks for a reset after several differences.
#[derive(Clone, Debug, Default)]
pub struct BufferMonitor {
    status: GyroBufferStatus,
    different_in_row: u8,
    reset_wanted: bool,
}

impl BufferMonitor {
    /// The counters, for diagnostics.
    pub const fn status(&self) -> GyroBufferStatus {
        self.status
    }

    /// Takes a sample.
    pub fn update(&mut self, gyro: &GyroRaw) {
        let status = &mut self.status;
        status.spikes = status.spikes.wrapping_add(gyro.spikes.into());
        match gyro.buffer {
            BufferCheck::Unknown => {}
            BufferCheck::Agrees => self.different_in_row = 0,
            BufferCheck::Differs => {
                status.differences = status.differences.wrapping_add(1);
                self.different_in_row = self.different_in_row.saturating_add(1);
                self.reset_wanted = self.different_in_row >= MAX_DIFFERENT;
            }
            // The driver has reset it already.
            BufferCheck::Stale => {
                status.overruns = status.overruns.wrapping_add(1);
                self.different_in_row = 0;
            }
        }
    }

    /// True once after the buffer has differed too often: it must be reset.
    pub fn take_reset(&mut self) -> bool {
        let wanted = core::mem::take(&mut self.reset_wanted);
        if wanted {
            self.different_in_row = 0;
            self.status.resets = self.status.resets.wrapping_add(1);
        }
        wanted
    }
}

#[cfg(test)]
mod tests {
    use super::{super::decode::decode_gyro, *};

    /// The registers are 0, 0, 1000. The only frame is `x`, 0, 1000.
    fn sample(x: i16, status: u8) -> GyroRaw {
        let mut answer = [0; 16];
        answer[1] = 0x0F;
        answer[7..9].copy_from_slice(&1_000i16.to_le_bytes());
        answer[15] = status;
        let frame = [x, 0, 1_000].map(i16::to_le_bytes);
        decode_gyro(&answer, frame.as_flattened()).unwrap()
    }

    #[test]
    fn four_different_samples_in_a_row_reset_the_buffer() {
        let mut monitor = BufferMonitor::default();
        let mut resets = |differs: bool| {
            monitor.update(&sample(if differs { 500 } else { 0 }, 1));
            monitor.take_reset()
        };
        let different = [true, true, true, false, true, true, true, true, true];
        let seen = different.map(&mut resets);
        let expected = [false, false, false, false, false, false, false, true, false];
        assert_eq!(seen, expected);
        let status = monitor.status();
        assert_eq!((status.differences, status.resets), (8, 1));
    }

    #[test]
    fn an_overrun_asks_for_no_further_reset() {
        let mut monitor = BufferMonitor::default();
        for overrun in [0x81, 0xE4, 9] {
            monitor.update(&sample(0, overrun));
            assert!(!monitor.take_reset());
        }
        let expected = GyroBufferStatus {
            overruns: 3,
            ..GyroBufferStatus::default()
        };
        assert_eq!(monitor.status(), expected);
    }
}
