//! Burst reads → counts → physical units, for the ranges that [`INIT`](super::INIT) sets.

use super::{
    bring_up::write_command,
    registers::{READ, accel, gyro},
};

/// Bytes to exchange for one accelerometer sample: acceleration, sensor time and temperature in one burst. The answer
/// is an echo of the address, a dummy byte, then the registers 0x12 to 0x23.
pub const ACCEL_READ: [u8; 20] = {
    let mut bytes = [0; 20];
    bytes[0] = accel::DATA | READ;
    bytes
};

/// Bytes to exchange for the gyro's newest values and the number of frames in its buffer. The answer is an echo of the
/// address, then the registers 0x00 to 0x0E. It starts at the chip id, because six zero data bytes are a legal sample
/// and do not tell a dead bus.
pub const GYRO_READ: [u8; 16] = {
    let mut bytes = [0; 16];
    bytes[0] = gyro::CHIP_ID | READ;
    bytes
};

/// Most frames that are read. Five come in 5 ms; more than these have piled up only if nobody has read the buffer.
const MAX_FRAMES: usize = 8;
const FRAME_LEN: usize = 6;

/// Bytes to exchange for a full read of the buffer. [`GyroBuffer::Frames`] says how many of them to exchange.
pub const BUFFER_READ: [u8; 1 + MAX_FRAMES * FRAME_LEN] = {
    let mut bytes = [0; 1 + MAX_FRAMES * FRAME_LEN];
    bytes[0] = gyro::FIFO_DATA | READ;
    bytes
};

/// Writes that empty the gyro's buffer after it ran over or got out of step, in the order of PX4. They must be at least
/// 2 µs apart.
pub const BUFFER_RESET: [[u8; 2]; 3] = [
    write_command(gyro::FIFO_CONFIG_0, 0),
    write_command(gyro::FIFO_CONFIG_1, gyro::FIFO_BYPASS),
    write_command(gyro::FIFO_CONFIG_1, gyro::FIFO_MODE),
];

/// A frame that some BMI088 send now and then, and no rate gives (ArduPilot issues 22710 and 25178).
const SPIKE: [i16; 3] = [i16::MIN; 3];
/// Largest difference of the newest frame from the data registers, 1 °/s. The registers show the same sample, or the
/// one before it if a sample came in between.
const MAX_DIFFERENCE: u16 = 16;

/// What to do with the gyro's buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GyroBuffer {
    /// Exchange the first `bytes` of [`BUFFER_READ`].
    Frames {
        /// Number of bytes, the address included.
        bytes: usize,
    },
    /// Its frames are too old. Send [`BUFFER_RESET`].
    Stale,
}

/// Decides by the answer to [`GYRO_READ`].
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

/// Accelerometer sample in counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccelRaw {
    pub counts: [i16; 3],
    /// 24-bit counter, 39.0625 µs per count.
    pub sensor_time: u32,
    /// `None` while the sensor marks it invalid.
    pub temperature: Option<TemperatureRaw>,
}

/// Temperature: 0.125 °C per count, 0 is 23 °C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TemperatureRaw(i16);

/// Gyro sample in counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroRaw {
    /// The newest values.
    pub counts: [i16; 3],
    frames: [[i16; 3]; MAX_FRAMES],
    frame_count: usize,
    /// Something was measured since the last read.
    pub fresh: bool,
    /// Number of frames dropped as spikes.
    pub spikes: u8,
    pub buffer: BufferCheck,
}

/// How the buffer compares with the data registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BufferCheck {
    /// There was nothing to compare.
    Unknown,
    Agrees,
    /// The newest frame differs, so the frames are not used.
    Differs,
    /// It had run over, or had not been read for too long.
    Stale,
}

/// Returns `None` if all bits are alike, as an absent or unpowered sensor answers.
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

/// Decodes the answer to [`GYRO_READ`] and the frames that [`BUFFER_READ`] brought, without the echo of the address.
/// Returns `None` if the answer lacks the gyro's chip id.
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
    let registers = frame([x0, x1, y0, y1, z0, z1]);
    let (frames, _) = frames.as_chunks::<FRAME_LEN>();
    let mut raw = GyroRaw::of(registers);
    raw.fresh = status != 0;
    if gyro_buffer(answer) == GyroBuffer::Stale {
        raw.buffer = BufferCheck::Stale;
    } else {
        raw.take_frames(registers, frames);
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
    /// m/s² per count at ±12 g.
    const MPS2_PER_COUNT: f32 = 12.0 * 9.806_65 / 32_768.0;

    /// Specific force in m/s², sensor axes.
    pub fn mps2(&self) -> [f32; 3] {
        self.counts
            .map(|count| f32::from(count) * Self::MPS2_PER_COUNT)
    }
}

impl GyroRaw {
    /// °/s per count at ±2000 °/s.
    pub const DPS_PER_COUNT: f32 = 1.0 / 16.384;

    /// A sample of the data registers alone.
    fn of(counts: [i16; 3]) -> Self {
        Self {
            counts,
            frames: [[0; 3]; MAX_FRAMES],
            frame_count: 0,
            fresh: false,
            spikes: 0,
            buffer: BufferCheck::Unknown,
        }
    }

    /// What was measured since the last read, one frame a millisecond, the newest last. If the buffer is not usable, it
    /// is the newest value alone.
    pub fn frames(&self) -> &[[i16; 3]] {
        match self.frames.get(..self.frame_count) {
            Some(frames) if !frames.is_empty() => frames,
            _ => core::slice::from_ref(&self.counts),
        }
    }

    /// Uses the frames of the buffer if the newest of them is what the registers show, or if the registers show a spike
    /// and cannot be compared.
    fn take_frames(&mut self, registers: [i16; 3], frames: &[[u8; FRAME_LEN]]) {
        let mut newest = [None; 2];
        let mut count = 0usize;
        for bytes in frames {
            let counts = frame(*bytes);
            if counts == SPIKE {
                self.spikes = self.spikes.saturating_add(1);
            } else if let Some(place) = self.frames.get_mut(count) {
                *place = counts;
                count = count.saturating_add(1);
                newest = [newest[1], Some(counts)];
            }
        }
        let [before, Some(last)] = newest else {
            return;
        };
        let is_shown = |counts: [i16; 3]| is_near(counts, registers);
        if registers == SPIKE {
            self.counts = last;
        } else if is_shown(last) || before.is_some_and(is_shown) {
            self.buffer = BufferCheck::Agrees;
        } else {
            self.buffer = BufferCheck::Differs;
            return;
        }
        self.frame_count = count;
    }
}

fn is_near(one: [i16; 3], other: [i16; 3]) -> bool {
    one.iter()
        .zip(other)
        .all(|(a, b)| a.abs_diff(b) <= MAX_DIFFERENCE)
}

impl TemperatureRaw {
    /// 11-bit two's complement, upper eight bits first. 0x80 0x00 means invalid.
    fn parse(msb: u8, lsb: u8) -> Option<Self> {
        if msb == 0x80 {
            return None;
        }
        Some(Self(i16::from_be_bytes([msb, lsb]) >> 5))
    }

    /// Temperature in °C.
    pub fn celsius(self) -> f32 {
        23.0 + 0.125 * f32::from(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chip id, the newest values 100, −200, 300, and `status`.
    fn answer(status: u8) -> [u8; 16] {
        let mut answer = [0; 16];
        answer[1] = 0x0F;
        answer[3..9].copy_from_slice(&[0x64, 0x00, 0x38, 0xFF, 0x2C, 0x01]);
        answer[15] = status;
        answer
    }

    #[test]
    fn all_frames_in_the_buffer_are_read() {
        assert_eq!(gyro_buffer(&answer(0)), GyroBuffer::Frames { bytes: 1 });
        assert_eq!(gyro_buffer(&answer(5)), GyroBuffer::Frames { bytes: 31 });
        assert_eq!(gyro_buffer(&answer(8)), GyroBuffer::Frames { bytes: 49 });
        assert_eq!(gyro_buffer(&answer(9)), GyroBuffer::Stale);
        assert_eq!(gyro_buffer(&answer(0x83)), GyroBuffer::Stale);
        assert_eq!(BUFFER_READ.len(), 49);
    }

    fn bytes<const N: usize>(frames: [[i16; 3]; N]) -> Vec<u8> {
        let counts = frames.as_flattened().iter();
        counts.flat_map(|count| count.to_le_bytes()).collect()
    }

    #[test]
    fn frames_are_decoded_in_order() {
        let frames = [[90, -300, 296], [100, -200, 300]];
        let raw = decode_gyro(&answer(2), &bytes(frames)).unwrap();
        assert_eq!(raw.counts, [100, -200, 300]);
        assert_eq!(raw.frames(), frames);
        assert!(raw.fresh);
        assert_eq!((raw.buffer, raw.spikes), (BufferCheck::Agrees, 0));
    }

    /// If a sample comes between the reads, the registers show the last frame but one.
    #[test]
    fn a_sample_in_between_is_no_difference() {
        let frames = [[0; 3], [100, -200, 300], [900, -900, 900]];
        let raw = decode_gyro(&answer(3), &bytes(frames)).unwrap();
        assert_eq!(raw.buffer, BufferCheck::Agrees);
        assert_eq!(raw.frames(), frames);
    }

    /// X shows Z, Y shows X, Z shows Y; or one axis is a little more than 1 °/s off.
    #[test]
    fn frames_that_differ_from_the_registers_are_not_used() {
        for off in [[300, 100, -200], [117, -200, 300], [100, -200, 283]] {
            let raw = decode_gyro(&answer(2), &bytes([off, off])).unwrap();
            assert_eq!(raw.buffer, BufferCheck::Differs, "{off:?}");
            assert_eq!(raw.frames(), [[100, -200, 300]]);
        }
        let within = decode_gyro(&answer(1), &bytes([[116, -216, 284]])).unwrap();
        assert_eq!(within.buffer, BufferCheck::Agrees);
    }

    #[test]
    fn spikes_are_dropped_anywhere_in_the_buffer() {
        let spike = [i16::MIN; 3];
        let good = [100, -200, 300];
        let raw = decode_gyro(&answer(4), &bytes([spike, good, spike, good])).unwrap();
        assert_eq!(raw.frames(), [good, good]);
        assert_eq!((raw.buffer, raw.spikes), (BufferCheck::Agrees, 2));
        // A spike in the registers.
        let mut registers = answer(2);
        registers[3..9].copy_from_slice(&bytes([spike]));
        let raw = decode_gyro(&registers, &bytes([[90, -190, 310], spike])).unwrap();
        assert_eq!(raw.counts, [90, -190, 310]);
        assert_eq!(raw.frames(), [[90, -190, 310]]);
        assert_eq!((raw.buffer, raw.spikes), (BufferCheck::Unknown, 1));
        // One axis at the end of its range is no spike. A buffer of nothing but spikes gives no frame.
        let one = [i16::MIN, -200, 300];
        assert_eq!(decode_gyro(&answer(1), &bytes([one])).unwrap().spikes, 0);
        let all = decode_gyro(&registers, &bytes([spike, spike])).unwrap();
        assert_eq!((all.counts, all.spikes), (spike, 2));
    }

    #[test]
    fn without_frames_the_newest_values_are_used() {
        let stale = decode_gyro(&answer(0xE4), &[]).unwrap();
        assert_eq!(stale.frames(), [[100, -200, 300]]);
        assert_eq!(stale.buffer, BufferCheck::Stale);
        assert!(stale.fresh);
        assert!(!decode_gyro(&answer(0), &[]).unwrap().fresh);
    }
}
