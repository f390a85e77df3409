//! Isentek IST8310 magnetometer: I2C address 0x0E, at most 400 kHz, reset on its own pin.

/// Seven-bit address.
pub const ADDRESS: u8 = 0x0E;

const WHO_AM_I: u8 = 0x00;
const WHO_AM_I_VALUE: u8 = 0x10;
const STATUS_1: u8 = 0x02;
const DATA_READY: u8 = 0x01;
const CONTROL_1: u8 = 0x0A;
const SINGLE_SHOT: u8 = 0x01;
const AVERAGE: u8 = 0x41;
/// 16 × on all axes.
const AVERAGE_16: u8 = 0x24;
const PULSE_DURATION: u8 = 0x42;
const PULSE_NORMAL: u8 = 0xC0;

/// Bytes to write to start one measurement.
pub const START_SINGLE_SHOT: [u8; 2] = [CONTROL_1, SINGLE_SHOT];
/// Time to leave for one measurement.
pub const MEASUREMENT_US: u32 = 7_000;
/// Time over which 16 × averaging measures: the shortest wait that PX4 and ArduPilot get away with.
const AVERAGING_US: u64 = 6_000;
/// [`START_SINGLE_SHOT`] on the wire: start, three bytes with their acknowledges, stop, at 400 kHz.
const ORDER_US: u64 = 73;
/// First register of a sample; read [`READ_LEN`] bytes from it.
pub const READ_FROM: u8 = STATUS_1;
/// Status and three axes.
pub const READ_LEN: usize = 7;

/// What a failed check says about the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum InitCheck {
    Missing,
    AverageNotKept,
    PulseNotKept,
}

/// One step of the bring-up, to be carried out in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitStep {
    /// Level of the RSTN pin; low holds the sensor in reset.
    ResetPin { high: bool },
    /// Write one register.
    Write { register: u8, value: u8 },
    /// Read one register, which must hold `expected` or the bring-up has failed.
    Check {
        register: u8,
        expected: u8,
        failure: InitCheck,
    },
    /// Leave the sensor alone for this long.
    Wait { us: u32 },
}

/// Takes about 100 ms, nearly all of it waiting.
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

/// Middle of the measurement whose order was begun at `started_us`.
pub(super) const fn measured_at_us(started_us: u64) -> u64 {
    started_us.saturating_add(ORDER_US + AVERAGING_US / 2)
}

/// Counts as read, in the sensor's own left-handed frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MagRaw {
    counts: [i16; 3],
}

/// `None` if the status says that nothing new was measured, or the answer has all bits alike.
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
    /// Datasheet range: ±1600 µT on x and y, ±2500 µT on z.
    const RANGE_UT: [f32; 3] = [1_600.0, 1_600.0, 2_500.0];

    /// The field, µT, in right-handed axes: those of the sensor with y turned round (PX4 and ArduPilot agree that they are
    /// left-handed; which one is turned round makes no difference to the 24 ways it may sit). `None` beyond the range of
    /// the sensor.
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

    /// Datasheet: 0.3 µT a count; y is turned round.
    #[test]
    fn a_ready_sample_is_made_right_handed() {
        let raw = decode(&[0x01, 0x64, 0x00, 0x38, 0xFF, 0xC8, 0x00]).unwrap();
        assert_eq!(raw.counts, [100, -200, 200]);
        let field = raw.right_handed_ut().unwrap();
        for (got, expected) in field.iter().zip([30.0, 60.0, 60.0]) {
            assert!((got - expected).abs() < 1e-4);
        }
    }

    #[test]
    fn nothing_new_and_a_dead_bus_give_nothing() {
        assert_eq!(decode(&[0; READ_LEN]), None);
        assert_eq!(decode(&[0xFF; READ_LEN]), None);
    }

    #[test]
    fn a_field_beyond_the_range_is_refused() {
        let raw = MagRaw {
            counts: [5_400, 0, 0],
        };
        assert_eq!(raw.right_handed_ut(), None);
    }
}
