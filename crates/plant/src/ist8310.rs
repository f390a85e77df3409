//! IST8310 magnetometer on I2C.

use crate::{
    complaint::Complaint,
    motion::MotionSource,
    random::{Random, Stream},
    time::{MS, Ps, US},
};

mod register {
    pub const WAI: u8 = 0x00;
    pub const STAT1: u8 = 0x02;
    pub const X_LSB: u8 = 0x03;
    pub const Z_MSB: u8 = 0x08;
    pub const STAT2: u8 = 0x09;
    pub const CNTL1: u8 = 0x0A;
    pub const CNTL2: u8 = 0x0B;
    pub const STR: u8 = 0x0C;
    pub const CNTL3: u8 = 0x0D;
    pub const TEMP_LSB: u8 = 0x1C;
    pub const TEMP_MSB: u8 = 0x1D;
    pub const AVGCNTL: u8 = 0x41;
    pub const PDCNTL: u8 = 0x42;
}

const ADDRESS: u8 = 0x0E;
const WHO_AM_I: u8 = 0x10;
const MAX_SCL_HZ: u32 = 400_000;
const STAT1_DATA_READY: u8 = 1 << 0;
const STAT1_OVERRUN: u8 = 1 << 1;
const CNTL2_SOFT_RESET: u8 = 1 << 0;
const CNTL2_DRDY_HIGH: u8 = 1 << 2;
const CNTL2_DRDY_ENABLED: u8 = 1 << 3;
/// Drivers wait 50 ms after power-on or the reset pin; the model needs most of it.
const POWER_ON: Ps = 45 * MS;
/// The shortest wait that a driver is known to use with success (ArduPilot).
const SOFT_RESET: Ps = 10 * MS;
/// Resolution in µT per count: 14 bits by default, and 1320 counts per gauss with the axis's bit in CNTL3 set.
const LSB_14_BIT_UT: f64 = 0.3;
const LSB_16_BIT_UT: f64 = 100.0 / 1320.0;
const RANGE_UT: [f64; 3] = [1_600.0, 1_600.0, 2_500.0];
/// Noise of one conversion, µT, divided by the root of the number of averages. No source gives it: a usual value for this
/// kind of sensor.
const NOISE_UT: f64 = 0.8;

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MagFaults {
    /// No supply: the chip never acknowledges, and its settings are lost.
    pub gone: bool,
    /// A device holds SDA low.
    pub bus_held: bool,
}

#[derive(Clone, Copy, Debug)]
struct Registers {
    cntl1: u8,
    cntl2: u8,
    str: u8,
    cntl3: u8,
    avgcntl: u8,
    pdcntl: u8,
}

const RESET: Registers = Registers {
    cntl1: 0,
    cntl2: 0,
    str: 0,
    cntl3: 0,
    avgcntl: 0,
    pdcntl: 0,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Transfer {
    Idle,
    /// The next written byte is the register pointer.
    Pointer,
    Write,
    Read,
}

/// Mean of the field during one conversion, in the sensor's axes.
#[derive(Clone, Copy, Debug, Default)]
struct FieldMean {
    sum_ut: [f64; 3],
    steps: u32,
}

impl FieldMean {
    fn add(&mut self, field_ut: [f64; 3]) {
        for (sum, axis) in self.sum_ut.iter_mut().zip(field_ut) {
            *sum += axis;
        }
        self.steps += 1;
    }

    /// Returns the mean in µT, or 0 without a sample, and starts again.
    fn take_ut(&mut self) -> [f64; 3] {
        let Self { sum_ut, steps } = std::mem::take(self);
        sum_ut.map(|sum| sum / f64::from(steps.max(1)))
    }
}

#[derive(Clone)]
pub(crate) struct Ist8310 {
    random: Random,
    noise_ut: f64,
    faults: MagFaults,
    reset_pin_high: bool,
    alive_at: Ps,
    registers: Registers,
    transfer: Transfer,
    pointer: u8,
    conversion_done_at: Option<Ps>,
    field: FieldMean,
    data: [i16; 3],
    data_ready: bool,
    overrun: bool,
}

impl Ist8310 {
    /// The chip adds no noise to a recording, which has its own.
    pub(crate) fn new(seed: u64, source: MotionSource) -> Self {
        Self {
            random: Random::new(seed, Stream::Magnetometer),
            noise_ut: match source {
                MotionSource::Physics => NOISE_UT,
                MotionSource::Recording => 0.0,
            },
            faults: MagFaults::default(),
            reset_pin_high: true,
            alive_at: POWER_ON,
            registers: RESET,
            transfer: Transfer::Idle,
            pointer: 0,
            conversion_done_at: None,
            field: FieldMean::default(),
            data: [0; 3],
            data_ready: false,
            overrun: false,
        }
    }

    pub(crate) fn set_faults(&mut self, faults: MagFaults, now: Ps) {
        if self.faults.gone && !faults.gone {
            self.restart(now + POWER_ON);
        }
        self.faults = faults;
    }

    pub(crate) fn set_reset_pin(&mut self, high: bool, now: Ps) {
        if high && !self.reset_pin_high {
            self.restart(now + POWER_ON);
        }
        self.reset_pin_high = high;
    }

    fn restart(&mut self, alive_at: Ps) {
        self.alive_at = alive_at;
        self.registers = RESET;
        self.transfer = Transfer::Idle;
        self.pointer = 0;
        self.conversion_done_at = None;
        self.field = FieldMean::default();
        self.data = [0; 3];
        self.data_ready = false;
        self.overrun = false;
    }

    fn answers(&self, now: Ps) -> bool {
        self.reset_pin_high && !self.faults.gone && !self.faults.bus_held && now >= self.alive_at
    }

    pub(crate) fn bus_held(&self) -> bool {
        self.faults.bus_held
    }

    /// Level of DRDY, which is inactive at rest and while it is switched off.
    pub(crate) fn drdy_pin(&self) -> bool {
        let enabled = self.registers.cntl2 & CNTL2_DRDY_ENABLED != 0;
        let active_high = self.registers.cntl2 & CNTL2_DRDY_HIGH != 0;
        if enabled && self.data_ready {
            active_high
        } else {
            !active_high
        }
    }

    /// End of the current conversion.
    pub(crate) fn next_event(&self) -> Ps {
        self.conversion_done_at.unwrap_or(Ps::MAX)
    }

    /// True during a conversion, which averages the field over all of its time.
    pub(crate) fn is_converting(&self, now: Ps) -> bool {
        let done_at = self.conversion_done_at;
        done_at.is_some_and(|done_at| now + self.conversion_time() > done_at)
    }

    /// Adds the field of one step, in the sensor's axes, to the current conversion.
    pub(crate) fn sample_field(&mut self, field_ut: [f64; 3]) {
        self.field.add(field_ut);
    }

    /// Ends the conversion that is due.
    pub(crate) fn convert(&mut self) {
        let Some(done_at) = self.conversion_done_at.take() else {
            return;
        };
        let field_ut = self.field.take_ut();
        // The chip's own axes are left-handed: y points the other way.
        let chip_ut = [field_ut[0], -field_ut[1], field_ut[2]];
        let average = |code: u8| f64::from(1 << code.min(4));
        let xz = average(self.registers.avgcntl & 0x07);
        let y = average(self.registers.avgcntl >> 3 & 0x07);
        let averages = [xz, y, xz];
        for axis in 0..3 {
            let noise_ut = self.random.normal() * self.noise_ut / averages[axis].sqrt();
            let value_ut = (chip_ut[axis] + noise_ut).clamp(-RANGE_UT[axis], RANGE_UT[axis]);
            let fine = self.registers.cntl3 >> (4 + axis) & 1 != 0;
            let lsb_ut = if fine { LSB_16_BIT_UT } else { LSB_14_BIT_UT };
            self.data[axis] = (value_ut / lsb_ut).round() as i16;
        }
        self.overrun |= self.data_ready;
        self.data_ready = true;
        match continuous_period(self.registers.cntl1) {
            Some(period) => self.conversion_done_at = Some(done_at + period),
            None => self.registers.cntl1 = 0,
        }
    }

    /// The misuse that keeps the chip from understanding the master, if there is one.
    pub(crate) fn misuse(&self, addr7: u8, scl_hz: u32) -> Option<Complaint> {
        (addr7 == ADDRESS && scl_hz > MAX_SCL_HZ).then(|| {
            Complaint::fails(format!(
                "IST8310: SCL at {scl_hz} Hz, at most {MAX_SCL_HZ} Hz: no acknowledge"
            ))
        })
    }

    pub(crate) fn address(&mut self, addr7: u8, read: bool, scl_hz: u32, now: Ps) -> bool {
        if addr7 != ADDRESS || scl_hz > MAX_SCL_HZ || !self.answers(now) {
            self.transfer = Transfer::Idle;
            return false;
        }
        self.transfer = if read {
            Transfer::Read
        } else {
            Transfer::Pointer
        };
        true
    }

    pub(crate) fn write(&mut self, byte: u8, now: Ps) -> bool {
        if !self.answers(now) {
            return false;
        }
        match self.transfer {
            Transfer::Pointer => {
                self.pointer = byte;
                self.transfer = Transfer::Write;
            }
            Transfer::Write => {
                self.write_register(self.pointer, byte, now);
                self.pointer = self.pointer.wrapping_add(1);
            }
            Transfer::Idle | Transfer::Read => return false,
        }
        true
    }

    pub(crate) fn read(&mut self, now: Ps) -> u8 {
        if self.transfer != Transfer::Read || !self.answers(now) {
            return 0xFF;
        }
        let value = self.read_register(self.pointer);
        self.pointer = self.pointer.wrapping_add(1);
        value
    }

    pub(crate) fn stop(&mut self) {
        self.transfer = Transfer::Idle;
    }

    fn read_register(&mut self, register: u8) -> u8 {
        match register {
            register::WAI => WHO_AM_I,
            register::STAT1 => {
                (u8::from(self.data_ready) * STAT1_DATA_READY)
                    | (u8::from(self.overrun) * STAT1_OVERRUN)
            }
            register::X_LSB..=register::Z_MSB => {
                self.data_ready = false;
                self.overrun = false;
                let offset = usize::from(register - register::X_LSB);
                self.data[offset / 2].to_le_bytes()[offset % 2]
            }
            register::CNTL1 => self.registers.cntl1,
            register::CNTL2 => self.registers.cntl2,
            register::STR => self.registers.str,
            register::CNTL3 => self.registers.cntl3,
            register::AVGCNTL => self.registers.avgcntl,
            register::PDCNTL => self.registers.pdcntl,
            register::STAT2 | register::TEMP_LSB | register::TEMP_MSB => 0,
            _ => 0,
        }
    }

    fn write_register(&mut self, register: u8, value: u8, now: Ps) {
        match register {
            register::CNTL1 => {
                self.registers.cntl1 = value & 0x0F;
                self.field = FieldMean::default();
                self.conversion_done_at = match self.registers.cntl1 {
                    0 => None,
                    _ => Some(now + self.conversion_time()),
                };
            }
            register::CNTL2 if value & CNTL2_SOFT_RESET != 0 => self.restart(now + SOFT_RESET),
            register::CNTL2 => self.registers.cntl2 = value,
            register::STR => self.registers.str = value,
            register::CNTL3 => self.registers.cntl3 = value,
            register::AVGCNTL => self.registers.avgcntl = value,
            register::PDCNTL => self.registers.pdcntl = value,
            _ => {}
        }
    }

    /// 6 ms at 16 averages (the wait every driver uses); the other steps scale down to 1 ms.
    fn conversion_time(&self) -> Ps {
        let code = (self.registers.avgcntl & 0x07)
            .max(self.registers.avgcntl >> 3 & 0x07)
            .min(4);
        1_000 * US + (5_000 * US * ((1 << code) - 1)) / 15
    }
}

fn continuous_period(cntl1: u8) -> Option<Ps> {
    match cntl1 {
        0x03 => Some(100 * MS),
        0x05 => Some(50 * MS),
        0x07 => Some(20 * MS),
        0x06 => Some(10 * MS),
        0x0B => Some(5 * MS),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
