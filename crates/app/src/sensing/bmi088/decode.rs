//! Burst reads → counts → physical units, for the ranges that `INIT` sets.

use super::registers::{READ, accel, gyro};

/// Bytes to exchange for one accelerometer sample: acceleration, sensor time and temperature in one burst.
/// Answer: address echo, dummy byte, then registers 0x12 to 0x23.
pub const ACCEL_READ: [u8; 20] = {
    let mut bytes = [0; 20];
    bytes[0] = accel::DATA | READ;
    bytes
};

/// Bytes to exchange for one gyro sample. It starts at the chip id: six zero data bytes are a legal sample at rest,
/// so the data alone cannot tell a dead bus. Answer: address echo, then registers 0x00 to 0x07.
pub const GYRO_READ: [u8; 9] = {
    let mut bytes = [0; 9];
    bytes[0] = gyro::CHIP_ID | READ;
    bytes
};

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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GyroRaw {
    pub counts: [i16; 3],
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

/// `None` unless the answer carries the gyro's chip id.
pub fn decode_gyro(answer: &[u8; GYRO_READ.len()]) -> Option<GyroRaw> {
    let [_address, chip_id, _reserved, x0, x1, y0, y1, z0, z1] = *answer;
    (chip_id == gyro::CHIP_ID_VALUE).then_some(GyroRaw {
        counts: [
            i16::from_le_bytes([x0, x1]),
            i16::from_le_bytes([y0, y1]),
            i16::from_le_bytes([z0, z1]),
        ],
    })
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

    pub fn dps(&self) -> [f32; 3] {
        self.counts
            .map(|count| f32::from(count) * Self::DPS_PER_COUNT)
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
