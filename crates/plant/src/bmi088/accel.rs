//! Accelerometer die of the BMI088 (datasheet chapters 4.5 and 5.3).

use super::{
    die::{DATA_READY, Die, SOFTRESET, quantise, rate_of_steps_hz},
    low_pass::LowPass,
    sample_clock::SampleClock,
    write_gap::WriteGap,
};
use crate::{
    complaint::Complaint,
    motion::MotionSource,
    physics::STANDARD_GRAVITY_MPS2,
    random::Random,
    time::{MS, Ps, SECOND},
};

mod register {
    pub const CHIP_ID: u8 = 0x00;
    pub const ERR: u8 = 0x02;
    pub const STATUS: u8 = 0x03;
    pub const X_LSB: u8 = 0x12;
    pub const Z_MSB: u8 = 0x17;
    pub const SENSORTIME_0: u8 = 0x18;
    pub const SENSORTIME_2: u8 = 0x1A;
    pub const INT_STAT_1: u8 = 0x1D;
    pub const TEMP_MSB: u8 = 0x22;
    pub const TEMP_LSB: u8 = 0x23;
    pub const CONF: u8 = 0x40;
    pub const RANGE: u8 = 0x41;
    pub const INT1_IO_CONF: u8 = 0x53;
    pub const INT2_IO_CONF: u8 = 0x54;
    pub const INT_MAP_DATA: u8 = 0x58;
    pub const SELF_TEST: u8 = 0x6D;
    pub const PWR_CONF: u8 = 0x7C;
    pub const PWR_CTRL: u8 = 0x7D;
    pub const SOFTRESET: u8 = 0x7E;
}

const CHIP_ID: u8 = 0x1E;
const SUSPEND: u8 = 0x03;
const ACC_ENABLED: u8 = 0x04;
const START_UP: Ps = MS;
/// Resolution of the sensor time: 39.0625 µs per count.
const SENSORTIME_LSB: Ps = SECOND / 25_600;
const TEMPERATURE_PERIOD: Ps = 1_280 * MS;

/// Noise density, x and y 160, z 190 µg/√Hz.
const NOISE_G_PER_SQRT_HZ: [f64; 3] = [160e-6, 160e-6, 190e-6];
/// Zero-g offset, typically ±20 mg; the model draws it uniformly.
const OFFSET_G: f64 = 0.020;
/// Deflection of the self test in g. Its size is assumed: both polarities together exceed the 1000, 1000 and 500 mg that the
/// datasheet asks for.
const SELF_TEST_G: [f64; 3] = [0.7, 0.7, 0.4];

#[derive(Clone)]
pub(super) struct AccelDie {
    random: Random,
    source: MotionSource,
    offset_g: [f64; 3],
    bus: Bus,
    registers: Registers,
    alive_at: Ps,
    write_gap: WriteGap,
    clock: SampleClock,
    filter: LowPass,
    data: [i16; 3],
    data_ready: bool,
    temperature: Option<i16>,
    temperature_at: Ps,
}

/// The bus of the die: it expects I2C until its chip select first rises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bus {
    I2c,
    Spi,
}

#[derive(Clone, Copy, Debug)]
struct Registers {
    conf: u8,
    range: u8,
    int1_io: u8,
    int2_io: u8,
    int_map: u8,
    self_test: u8,
    pwr_conf: u8,
    pwr_ctrl: u8,
}

const RESET: Registers = Registers {
    conf: 0xA8,
    range: 0x01,
    int1_io: 0,
    int2_io: 0,
    int_map: 0,
    self_test: 0,
    pwr_conf: SUSPEND,
    pwr_ctrl: 0,
};

impl AccelDie {
    pub(super) fn new(mut random: Random, source: MotionSource) -> Self {
        let offset_g = match source {
            MotionSource::Physics => std::array::from_fn(|_| random.symmetric(OFFSET_G)),
            MotionSource::Recording => [0.0; 3],
        };
        let (rate_hz, bandwidth_hz) = output_filter(RESET.conf).unwrap_or((100.0, 40.0));
        Self {
            random,
            source,
            offset_g,
            bus: Bus::I2c,
            registers: RESET,
            alive_at: START_UP,
            write_gap: WriteGap::default(),
            clock: SampleClock::new(rate_hz, 0),
            filter: LowPass::new(bandwidth_hz, rate_of_steps_hz()),
            data: [0; 3],
            data_ready: false,
            temperature: None,
            temperature_at: 0,
        }
    }

    /// The state after power-on and after the soft reset.
    pub(super) fn power_on(&mut self, now: Ps) {
        self.bus = Bus::I2c;
        self.registers = RESET;
        self.alive_at = now + START_UP;
        self.data = [0; 3];
        self.data_ready = false;
        self.temperature = None;
    }

    pub(super) fn take_write_complaint(&mut self) -> Option<Complaint> {
        self.write_gap.take_complaint()
    }

    fn measuring(&self) -> bool {
        self.registers.pwr_ctrl == ACC_ENABLED && self.registers.pwr_conf != SUSPEND
    }

    /// Advances by one step; true with a new sample. `locked` means that a burst is being read, during which the data
    /// registers keep their values.
    pub(super) fn step(
        &mut self,
        accel_mps2: [f64; 3],
        temperature_c: f64,
        locked: bool,
        now: Ps,
    ) -> bool {
        if now < self.alive_at || !self.measuring() {
            return false;
        }
        if self.temperature.is_none() || now >= self.temperature_at {
            let eighths = ((temperature_c - 23.0) / 0.125).round();
            self.temperature = Some(eighths.clamp(-1023.0, 1023.0) as i16);
            self.temperature_at = now + TEMPERATURE_PERIOD;
        }
        let analogue_g = self.analogue_g(accel_mps2);
        let sampled = !locked && self.clock.due(now);
        if sampled {
            // raw / 32768 · 1.5 · 2^(range + 1) = g
            let full_scale_g = 1.5 * f64::from(1 << (self.registers.range + 1));
            self.data = analogue_g.map(|g| quantise(g * 32_768.0 / full_scale_g));
            self.data_ready = true;
        }
        sampled
    }

    pub(super) fn replace_sample(&mut self, data: [i16; 3]) {
        self.data = data;
    }

    fn analogue_g(&mut self, accel_mps2: [f64; 3]) -> [f64; 3] {
        let mut force_g = accel_mps2.map(|a| a / STANDARD_GRAVITY_MPS2);
        if self.source == MotionSource::Physics {
            let polarity = match self.registers.self_test {
                0x0D => 1.0,
                0x09 => -1.0,
                _ => 0.0,
            };
            let white = (rate_of_steps_hz() / 2.0).sqrt();
            for (axis, force) in force_g.iter_mut().enumerate() {
                *force += self.offset_g[axis]
                    + polarity * SELF_TEST_G[axis]
                    + self.random.normal() * NOISE_G_PER_SQRT_HZ[axis] * white;
            }
        }
        self.filter.step(force_g)
    }

    fn configure_output(&mut self, now: Ps) {
        if let Some((rate_hz, bandwidth_hz)) = output_filter(self.registers.conf) {
            self.clock = SampleClock::new(rate_hz, now);
            self.filter = LowPass::new(bandwidth_hz, rate_of_steps_hz());
        }
    }
}

impl Die for AccelDie {
    const DUMMY_BYTES: usize = 1;
    const FIFO_DATA: u8 = 0x26;

    fn read(&mut self, register: u8, now: Ps) -> u8 {
        let sensortime = (now / SENSORTIME_LSB) as u32;
        match register {
            register::CHIP_ID => CHIP_ID,
            register::ERR => 0,
            register::STATUS | register::INT_STAT_1 => u8::from(self.data_ready) * DATA_READY,
            register::X_LSB..=register::Z_MSB => {
                self.data_ready = false;
                let offset = usize::from(register - register::X_LSB);
                self.data[offset / 2].to_le_bytes()[offset % 2]
            }
            register::SENSORTIME_0..=register::SENSORTIME_2 => {
                sensortime.to_le_bytes()[usize::from(register - register::SENSORTIME_0)]
            }
            // 0x80, 0x00 marks an invalid temperature.
            register::TEMP_MSB => self.temperature.map_or(0x80, |t| (t >> 3) as u8),
            register::TEMP_LSB => self.temperature.map_or(0, |t| (t << 5) as u8),
            register::CONF => self.registers.conf,
            register::RANGE => self.registers.range,
            register::INT1_IO_CONF => self.registers.int1_io,
            register::INT2_IO_CONF => self.registers.int2_io,
            register::INT_MAP_DATA => self.registers.int_map,
            register::SELF_TEST => self.registers.self_test,
            register::PWR_CONF => self.registers.pwr_conf,
            register::PWR_CTRL => self.registers.pwr_ctrl,
            _ => 0,
        }
    }

    fn write(&mut self, register: u8, value: u8, selected_at: Ps, now: Ps) {
        if self.bus == Bus::I2c {
            return;
        }
        // A die ignores writes while it starts.
        if now < self.alive_at {
            return;
        }
        let suspended = self.registers.pwr_conf == SUSPEND;
        self.write_gap.written(suspended, selected_at);
        let was_measuring = self.measuring();
        match register {
            register::CONF => {
                self.registers.conf = value;
                self.configure_output(now);
            }
            register::RANGE => self.registers.range = value & 0x03,
            register::INT1_IO_CONF => self.registers.int1_io = value,
            register::INT2_IO_CONF => self.registers.int2_io = value,
            register::INT_MAP_DATA => self.registers.int_map = value,
            register::SELF_TEST => self.registers.self_test = value,
            register::PWR_CONF => self.registers.pwr_conf = value,
            register::PWR_CTRL => self.registers.pwr_ctrl = value,
            register::SOFTRESET if value == SOFTRESET => self.power_on(now),
            _ => {}
        }
        if self.measuring() && !was_measuring {
            self.configure_output(now);
        }
    }

    /// A die that is still starting misses the edge, so the edge that ends the soft reset does not count.
    fn deselected(&mut self, now: Ps) {
        self.write_gap.deselected(now);
        if now >= self.alive_at {
            self.bus = Bus::Spi;
        }
    }

    fn drives_miso(&self) -> bool {
        self.bus == Bus::Spi
    }
}

/// Output rate and 3 dB bandwidth in Hz of an ACC_CONF value (datasheet table 5.3), or `None` for a reserved code, which
/// the die ignores.
fn output_filter(conf: u8) -> Option<(f64, f64)> {
    let rate_hz = match conf & 0x0F {
        code @ 0x5..=0xC => 12.5 * f64::from(1 << (code - 0x5)),
        _ => return None,
    };
    let (osr4, osr2, normal) = match conf & 0x0F {
        0x8 => (10.0, 19.0, 40.0),
        0x9 => (20.0, 38.0, 80.0),
        0xA => (40.0, 75.0, 145.0),
        0xB => (80.0, 140.0, 230.0),
        0xC => (145.0, 234.0, 280.0),
        _ => (0.1 * rate_hz, 0.19 * rate_hz, 0.4 * rate_hz),
    };
    match conf >> 4 {
        0x8 => Some((rate_hz, osr4)),
        0x9 => Some((rate_hz, osr2)),
        0xA => Some((rate_hz, normal)),
        _ => None,
    }
}
