//! Burst reads → counts → physical units, for the ranges that `INIT` sets.

use super::{
    bring_up::write_command,
    registers::{READ, accel, gyro},
};
use crate::math::vector;

/// Bytes to exchange for one accelerometer sample: acceleration, sensor time and temperature in one burst.
/// Answer: address echo, dummy byte, then registers 0x12 to 0x23.
pub const ACCEL_READ: [u8; 20] = {
    let mut bytes = [0; 20];
    bytes[0] = accel::DATA | READ;
    bytes
};

/// Bytes to exchange for the gyro's newest values and the fill of its buffer. It starts at the chip id: six zero data
/// bytes are a legal sample at rest, so the data alone cannot tell a dead bus. Answer: address echo, then registers
/// 0x00 to 0x0E.
pub const GYRO_READ: [u8; 16] = {
    let mut bytes = [0; 16];
    bytes[0] = gyro::CHIP_ID | READ;
    bytes
};

/// Five come in 5 ms. More than these have piled up only if the reader has slept.
const MAX_FRAMES: usize = 8;
const FRAME_LEN: usize = 6;

/// Bytes to exchange for all frames a buffer may hold that is read at all: the first [`GyroBuffer::Frames`] of them.
pub const BUFFER_READ: [u8; 1 + MAX_FRAMES * FRAME_LEN] = {
    let mut bytes = [0; 1 + MAX_FRAMES * FRAME_LEN];
    bytes[0] = gyro::FIFO_DATA | READ;
    bytes
};

/// Bytes to send to empty the gyro's buffer.
pub const BUFFER_CLEAR: [u8; 2] = write_command(gyro::FIFO_CONFIG_1, gyro::FIFO_STREAM);

/// What to do about the gyro's buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GyroBuffer {
    /// Exchange so many bytes of [`BUFFER_READ`].
    Frames { bytes: usize },
    /// Too old to be of use: send [`BUFFER_CLEAR`].
    Stale,
}

/// By the answer to [`GYRO_READ`].
pub fn gyro_buffer(answer: &[u8; GYRO_READ.len()]) -> GyroBuffer {
    let [.., status] = *answer;
    let frames = usize::from(status & !gyro::FIFO_OVERRUN);
    if status & gyro::FIFO_OVERRUN != 0 || frames > MAX_FRAMES {
        GyroBuffer::Stale
    } else {
        GyroBuffer::Frames {
            bytes: 1usize.saturating_add(frames.saturating_mul(FRAME_LEN)),
        }
    }
}

/// Accelerometer counts as read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccelRaw {
    pub counts: [i16; 3],
    /// 24 bit, 39.0625 µs a count.
    pub sensor_time: u32,
    /// `None` while the sensor marks it invalid.
    pub temperature: Option<TemperatureRaw>,
}

/// 0.125 °C a count, 0 = 23 °C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TemperatureRaw(i16);

/// Gyro counts as read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroRaw {
    /// The newest.
    pub counts: [i16; 3],
    /// The smallest and the largest since the last read.
    pub lowest: [i16; 3],
    pub highest: [i16; 3],
    /// Mean since the last read; the newest where the buffer was of no use.
    pub mean_counts: [f32; 3],
    /// Something was measured since the last read.
    pub fresh: bool,
}

/// `None` for an answer that only an absent or unpowered sensor gives: all bits alike.
pub fn decode_accel(answer: &[u8; ACCEL_READ.len()]) -> Option<AccelRaw> {
    let [_address, _dummy, registers @ ..] = answer;
    if registers.iter().all(|&byte| byte == 0x00) || registers.iter().all(|&byte| byte == 0xFF) {
        return None;
    }
    let [
        x0,
        x1,
        y0,
        y1,
        z0,
        z1,
        t0,
        t1,
        t2,
        _,
        _,
        _,
        _,
        _,
        _,
        _,
        temp_msb,
        temp_lsb,
    ] = *registers;
    Some(AccelRaw {
        counts: [
            i16::from_le_bytes([x0, x1]),
            i16::from_le_bytes([y0, y1]),
            i16::from_le_bytes([z0, z1]),
        ],
        sensor_time: u32::from_le_bytes([t0, t1, t2, 0]),
        temperature: TemperatureRaw::parse(temp_msb, temp_lsb),
    })
}

/// `answer`: to [`GYRO_READ`]; `frames`: what [`BUFFER_READ`] brought, without the echo of the address. `None` unless the
/// answer carries the gyro's chip id.
pub fn decode_gyro(answer: &[u8; GYRO_READ.len()], frames: &[u8]) -> Option<GyroRaw> {
    let [
        _address,
        chip_id,
        _reserved,
        x0,
        x1,
        y0,
        y1,
        z0,
        z1,
        ..,
        status,
    ] = *answer;
    if chip_id != gyro::CHIP_ID_VALUE {
        return None;
    }
    let counts = frame([x0, x1, y0, y1, z0, z1]);
    let mut raw = GyroRaw {
        counts,
        lowest: counts,
        highest: counts,
        mean_counts: counts.map(f32::from),
        fresh: status != 0,
    };
    let (frames, _) = frames.as_chunks::<FRAME_LEN>();
    if !frames.is_empty() {
        raw.average(frames);
    }
    Some(raw)
}

fn frame([x0, x1, y0, y1, z0, z1]: [u8; FRAME_LEN]) -> [i16; 3] {
    [
        i16::from_le_bytes([x0, x1]),
        i16::from_le_bytes([y0, y1]),
        i16::from_le_bytes([z0, z1]),
    ]
}

impl AccelRaw {
    /// m/s² a count at ±12 g.
    const MPS2_PER_COUNT: f32 = 12.0 * 9.806_65 / 32_768.0;

    pub fn mps2(&self) -> [f32; 3] {
        self.counts
            .map(|count| f32::from(count) * Self::MPS2_PER_COUNT)
    }
}

impl GyroRaw {
    /// °/s a count at ±2000 °/s.
    const DPS_PER_COUNT: f32 = 1.0 / 16.384;

    /// At most 8 frames: their sum fits single precision without rounding.
    fn average(&mut self, frames: &[[u8; FRAME_LEN]]) {
        let mut sum = [0.0; 3];
        for bytes in frames {
            let counts = frame(*bytes);
            sum = vector::add(sum, counts.map(f32::from));
            for (lowest, count) in self.lowest.iter_mut().zip(counts) {
                *lowest = count.min(*lowest);
            }
            for (highest, count) in self.highest.iter_mut().zip(counts) {
                *highest = count.max(*highest);
            }
        }
        self.mean_counts = vector::scale(sum, 1.0 / frames.len() as f32);
    }

    /// Mean rate since the last read.
    pub fn dps(&self) -> [f32; 3] {
        vector::scale(self.mean_counts, Self::DPS_PER_COUNT)
    }
}

impl TemperatureRaw {
    /// 11 bit two's complement, upper eight bits first; 0x80 0x00 means invalid.
    fn parse(msb: u8, lsb: u8) -> Option<Self> {
        if msb == 0x80 {
            return None;
        }
        Some(Self(i16::from_be_bytes([msb, lsb]) >> 5))
    }

    pub fn celsius(self) -> f32 {
        23.0 + 0.125 * f32::from(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chip id, newest values 100, −200, 300, and `status`.
    fn answer(status: u8) -> [u8; 16] {
        let mut answer = [0; 16];
        answer[1] = 0x0F;
        answer[3..9].copy_from_slice(&[0x64, 0x00, 0x38, 0xFF, 0x2C, 0x01]);
        answer[15] = status;
        answer
    }

    #[test]
    fn as_many_frames_are_read_as_there_are() {
        assert_eq!(gyro_buffer(&answer(0)), GyroBuffer::Frames { bytes: 1 });
        assert_eq!(gyro_buffer(&answer(5)), GyroBuffer::Frames { bytes: 31 });
        assert_eq!(gyro_buffer(&answer(8)), GyroBuffer::Frames { bytes: 49 });
        assert_eq!(gyro_buffer(&answer(9)), GyroBuffer::Stale);
        assert_eq!(gyro_buffer(&answer(0x83)), GyroBuffer::Stale);
        assert_eq!(BUFFER_READ.len(), 49);
    }

    /// By hand: (90 + 110) / 2, (−300 − 200) / 2, (0 − 2) / 2.
    #[test]
    fn frames_are_averaged_and_their_ends_known() {
        let frames = [90i16, -300, 0, 110, -200, -2].map(i16::to_le_bytes);
        let raw = decode_gyro(&answer(2), frames.as_flattened()).unwrap();
        assert_eq!(raw.counts, [100, -200, 300]);
        assert_eq!(raw.mean_counts, [100.0, -250.0, -1.0]);
        assert_eq!(raw.lowest, [90, -300, -2]);
        assert_eq!(raw.highest, [110, -200, 300]);
        assert!(raw.fresh);
        for (got, expected) in raw.dps().iter().zip([6.1035, -15.2588, -0.0610]) {
            assert!((got - expected).abs() < 1e-3, "{:?}", raw.dps());
        }
    }

    #[test]
    fn without_frames_the_newest_values_count() {
        let stale = decode_gyro(&answer(0xE4), &[]).unwrap();
        assert_eq!(stale.mean_counts, [100.0, -200.0, 300.0]);
        assert!(stale.fresh);
        assert!(!decode_gyro(&answer(0), &[]).unwrap().fresh);
    }
}
