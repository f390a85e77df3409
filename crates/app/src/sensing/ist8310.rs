//! Isentek IST8310 magnetometer: I2C at 400 kHz at most, with a reset pin of its own.
//!
//! A driver carries out [`INIT`]. Every 20 ms it writes [`START_SINGLE_SHOT`], waits [`MEASUREMENT_US`] and reads
//! [`READ_LEN`] bytes from [`READ_FROM`] for [`MagPipeline`](super::MagPipeline):
//!
//! ```
//! use robot_app::sensing::ist8310::{self, InitStep};
//!
//! let waits_us = ist8310::INIT.iter().map(|step| match step {
//!     InitStep::Wait { us } => *us,
//!     _ => 0,
//! });
//! assert_eq!(waits_us.sum::<u32>(), 100_000);
//! ```

/// Seven-bit I2C address.
pub const ADDRESS: u8 = 0x0E;

const WHO_AM_I: u8 = 0x00;
const WHO_AM_I_VALUE: u8 = 0x10;
const STATUS_1: u8 = 0x02;
const DATA_READY: u8 = 0x01;
const CONTROL_1: u8 = 0x0A;
const SINGLE_SHOT: u8 = 0x01;
const AVERAGE: u8 = 0x41;
/// 16 averages on all axes.
const AVERAGE_16: u8 = 0x24;
const PULSE_DURATION: u8 = 0x42;
const PULSE_NORMAL: u8 = 0xC0;

/// Bytes to write to start one measurement.
pub const START_SINGLE_SHOT: [u8; 2] = [CONTROL_1, SINGLE_SHOT];
/// Time to wait for one measurement.
pub const MEASUREMENT_US: u32 = 7_000;
/// Time over which 16 averages measure: the shortest wait in use by PX4 and ArduPilot.
const AVERAGING_US: u64 = 6_000;
/// Duration of [`START_SINGLE_SHOT`] on the bus: start, three bytes with acknowledge, stop, at 400 kHz.
const ORDER_US: u64 = 73;
/// First register of a sample.
pub const READ_FROM: u8 = STATUS_1;
/// Bytes of a sample: status and three axes.
pub const READ_LEN: usize = 7;

/// What a failed check of the bring-up found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum InitCheck {
    /// The sensor does not answer with its id.
    Missing,
    /// The number of averages does not read back.
    AverageNotKept,
    /// The pulse duration does not read back.
    PulseNotKept,
}

/// One step of the bring-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitStep {
    /// Set the level of the RSTN pin. Low holds the sensor in reset.
    ResetPin {
        /// True for the high level.
        high: bool,
    },
    /// Write one register.
    Write {
        /// Address of the register.
        register: u8,
        /// Its new value.
        value: u8,
    },
    /// Read one register. If it does not hold `expected`, the bring-up has failed.
    Check {
        /// Address of the register.
        register: u8,
        /// The value that it must hold.
        expected: u8,
        /// What another value means.
        failure: InitCheck,
    },
    /// Leave the sensor alone for this long.
    Wait {
        /// Time in µs.
        us: u32,
    },
}

/// The bring-up, to be carried out in order. It takes about 100 ms, nearly all of it waiting.
pub const INIT: &[InitStep] = &[
    InitStep::ResetPin { high: false },
    InitStep::Wait { us: 50_000 },
    InitStep::ResetPin { high: true },
    InitStep::Wait { us: 50_000 },
    InitStep::Check {
        register: WHO_AM_I,
        expected: WHO_AM_I_VALUE,
        failure: InitCheck::Missing,
    },
    InitStep::Write {
        register: AVERAGE,
        value: AVERAGE_16,
    },
    InitStep::Write {
        register: PULSE_DURATION,
        value: PULSE_NORMAL,
    },
    InitStep::Check {
        register: AVERAGE,
        expected: AVERAGE_16,
        failure: InitCheck::AverageNotKept,
    },
    InitStep::Check {
        register: PULSE_DURATION,
        expected: PULSE_NORMAL,
        failure: InitCheck::PulseNotKept,
    },
];

/// Middle of the measurement whose start was written at `started_us`.
pub(super) const fn measured_at_us(started_us: u64) -> u64 {
    started_us.saturating_add(ORDER_US + AVERAGING_US / 2)
}

/// A sample in counts, in the sensor's left-handed axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MagRaw {
    counts: [i16; 3],
}

/// Returns `None` if there is no new measurement, or if all bits of the answer are alike.
pub(super) fn decode(answer: &[u8; READ_LEN]) -> Option<MagRaw> {
    let [status, x0, x1, y0, y1, z0, z1] = *answer;
    if status & DATA_READY == 0 || status == 0xFF {
        return None;
    }
    Some(MagRaw {
        counts: [
            i16::from_le_bytes([x0, x1]),
            i16::from_le_bytes([y0, y1]),
            i16::from_le_bytes([z0, z1]),
        ],
    })
}

impl MagRaw {
    /// 14-bit resolution, the reset value of CNTL3.
    const UT_PER_COUNT: f32 = 0.3;
    /// Range by the datasheet: ±1600 µT on x and y, ±2500 µT on z.
    const RANGE_UT: [f32; 3] = [1_600.0, 1_600.0, 2_500.0];

    /// The field in µT, with y inverted to make the axes right-handed. PX4 and ArduPilot agree that the sensor's are
    /// left-handed; which axis is inverted makes no difference to the 24 possible mountings. Returns `None` beyond the
    /// range.
    pub fn right_handed_ut(&self) -> Option<[f32; 3]> {
        let field_ut = self
            .counts
            .map(|count| f32::from(count) * Self::UT_PER_COUNT);
        let in_range = field_ut
            .iter()
            .zip(Self::RANGE_UT)
            .all(|(value, range)| value.abs() <= range);
        let [x, y, z] = field_ut;
        in_range.then_some([x, -y, z])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0.3 µT per count by the datasheet, with y inverted.
    #[test]
    fn a_sample_is_made_right_handed() {
        let raw = decode(&[0x01, 0x64, 0x00, 0x38, 0xFF, 0xC8, 0x00]).unwrap();
        assert_eq!(raw.counts, [100, -200, 200]);
        let field = raw.right_handed_ut().unwrap();
        for (got, expected) in field.iter().zip([30.0, 60.0, 60.0]) {
            assert!((got - expected).abs() < 1e-4);
        }
    }

    #[test]
    fn an_old_sample_and_a_dead_bus_give_none() {
        assert_eq!(decode(&[0; READ_LEN]), None);
        assert_eq!(decode(&[0xFF; READ_LEN]), None);
    }

    #[test]
    fn a_field_beyond_the_range_is_rejected() {
        let raw = MagRaw {
            counts: [5_400, 0, 0],
        };
        assert_eq!(raw.right_handed_ut(), None);
    }
}
