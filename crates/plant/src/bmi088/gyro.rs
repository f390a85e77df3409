//! Gyroscope die of the BMI088 (datasheet chapters 4.6 and 5.5).

use super::{
    die::{DATA_READY, Die, SOFTRESET, quantise, rate_of_steps_hz},
    fifo::Fifo,
    low_pass::LowPass,
    sample_clock::SampleClock,
    write_gap::WriteGap,
};
use crate::{
    complaint::Complaint,
    motion::MotionSource,
    random::Random,
    time::{MS, Ps},
};

mod register {
    pub const CHIP_ID: u8 = 0x00;
    pub const X_LSB: u8 = 0x02;
    pub const Z_MSB: u8 = 0x07;
    pub const INT_STAT_1: u8 = 0x0A;
    pub const FIFO_STATUS: u8 = 0x0E;
    pub const RANGE: u8 = 0x0F;
    pub const BANDWIDTH: u8 = 0x10;
    pub const LPM1: u8 = 0x11;
    pub const SOFTRESET: u8 = 0x14;
    pub const INT_CTRL: u8 = 0x15;
    pub const INT_IO_CONF: u8 = 0x16;
    pub const INT_MAP: u8 = 0x18;
    pub const SELF_TEST: u8 = 0x3C;
    pub const FIFO_CONFIG_0: u8 = 0x3D;
    pub const FIFO_CONFIG_1: u8 = 0x3E;
    pub const FIFO_DATA: u8 = 0x3F;
}

const CHIP_ID: u8 = 0x0F;
const SUSPEND: u8 = 0x80;
const DEEP_SUSPEND: u8 = 0x20;
const START_UP: Ps = 30 * MS;
/// The datasheet gives no duration. Most drivers wait 10 ms or poll.
const SELF_TEST_TIME: Ps = 10 * MS;

/// Noise density 0.014 °/s/√Hz.
const NOISE_DPS_PER_SQRT_HZ: f64 = 0.014;
/// Zero-rate offset, typically ±1 °/s; the model draws it uniformly.
const OFFSET_DPS: f64 = 1.0;

#[derive(Clone)]
pub(super) struct GyroDie {
    random: Random,
    source: MotionSource,
    offset_dps: [f64; 3],
    registers: Registers,
    alive_at: Ps,
    write_gap: WriteGap,
    clock: SampleClock,
    filter: LowPass,
    data: [i16; 3],
    data_ready: bool,
    fifo: Fifo,
    self_test_done_at: Option<Ps>,
}

#[derive(Clone, Copy, Debug)]
struct Registers {
    range: u8,
    bandwidth: u8,
    lpm1: u8,
    int_ctrl: u8,
    int_io: u8,
    int_map: u8,
}

const RESET: Registers = Registers {
    range: 0,
    bandwidth: 0x80,
    lpm1: 0,
    int_ctrl: 0,
    int_io: 0x0F,
    int_map: 0,
};

impl GyroDie {
    pub(super) fn new(mut random: Random, source: MotionSource) -> Self {
        let offset_dps = match source {
            MotionSource::Physics => std::array::from_fn(|_| random.symmetric(OFFSET_DPS)),
            MotionSource::Recording => [0.0; 3],
        };
        let (rate_hz, bandwidth_hz) = output_filter(RESET.bandwidth);
        Self {
            random,
            source,
            offset_dps,
            registers: RESET,
            alive_at: START_UP,
            write_gap: WriteGap::default(),
            clock: SampleClock::new(rate_hz, START_UP),
            filter: LowPass::new(bandwidth_hz, rate_of_steps_hz()),
            data: [0; 3],
            data_ready: false,
            fifo: Fifo::new(),
            self_test_done_at: None,
        }
    }

    /// The state after power-on and after the soft reset.
    pub(super) fn power_on(&mut self, now: Ps) {
        self.registers = RESET;
        self.alive_at = now + START_UP;
        self.data = [0; 3];
        self.data_ready = false;
        self.fifo = Fifo::new();
        self.self_test_done_at = None;
        self.configure_output(self.alive_at);
    }

    pub(super) fn take_write_complaint(&mut self) -> Option<Complaint> {
        self.write_gap.take_complaint()
    }

    fn suspended(&self) -> bool {
        self.registers.lpm1 & (SUSPEND | DEEP_SUSPEND) != 0
    }

    /// Advances by one step; true with a new sample. `locked` means that a burst is being read, during which the data
    /// registers keep their values.
    pub(super) fn step(&mut self, gyro_rps: [f64; 3], locked: bool, now: Ps) -> bool {
        if now < self.alive_at || self.suspended() {
            return false;
        }
        let analogue_dps = self.analogue_dps(gyro_rps);
        let sampled = !locked && self.clock.due(now);
        if sampled {
            let full_scale_dps = 2_000.0 / f64::from(1 << self.registers.range);
            self.data = analogue_dps.map(|dps| quantise(dps * 32_768.0 / full_scale_dps));
            self.data_ready = true;
            self.fifo.push(self.data);
        }
        sampled
    }

    pub(super) fn replace_sample(&mut self, data: [i16; 3]) {
        self.data = data;
        self.fifo.replace_newest(data);
    }

    /// Shifts the axes in the FIFO by one place.
    pub(super) fn slip_fifo(&mut self) {
        self.fifo.slip();
    }

    /// True in the FIFO mode in which slips were reported.
    pub(super) fn streams(&self) -> bool {
        self.fifo.streams()
    }

    fn analogue_dps(&mut self, gyro_rps: [f64; 3]) -> [f64; 3] {
        let mut rate_dps = gyro_rps.map(f64::to_degrees);
        if self.source == MotionSource::Physics {
            let white = (rate_of_steps_hz() / 2.0).sqrt();
            for (rate, offset) in rate_dps.iter_mut().zip(self.offset_dps) {
                *rate += offset + self.random.normal() * NOISE_DPS_PER_SQRT_HZ * white;
            }
        }
        self.filter.step(rate_dps)
    }

    fn configure_output(&mut self, now: Ps) {
        let (rate_hz, bandwidth_hz) = output_filter(self.registers.bandwidth);
        self.clock = SampleClock::new(rate_hz, now);
        self.filter = LowPass::new(bandwidth_hz, rate_of_steps_hz());
    }

    /// Bits: 1 ready, 2 failed, 4 rate sensor works.
    fn self_test_result(&self, now: Ps) -> u8 {
        const READY: u8 = 1 << 1;
        const RATE_OK: u8 = 1 << 4;
        match self.self_test_done_at {
            Some(at) if now >= at => RATE_OK | READY,
            _ => RATE_OK,
        }
    }
}

impl Die for GyroDie {
    const DUMMY_BYTES: usize = 0;
    const FIFO_DATA: u8 = register::FIFO_DATA;

    fn read(&mut self, register: u8, now: Ps) -> u8 {
        if now < self.alive_at {
            return 0xFF;
        }
        match register {
            register::CHIP_ID => CHIP_ID,
            register::X_LSB..=register::Z_MSB => {
                self.data_ready = false;
                let offset = usize::from(register - register::X_LSB);
                self.data[offset / 2].to_le_bytes()[offset % 2]
            }
            register::INT_STAT_1 => u8::from(self.data_ready) * DATA_READY,
            register::FIFO_STATUS => self.fifo.status(),
            register::FIFO_CONFIG_1 => self.fifo.config(),
            register::FIFO_DATA => self.fifo.read(),
            register::RANGE => self.registers.range,
            register::BANDWIDTH => self.registers.bandwidth,
            register::LPM1 => self.registers.lpm1,
            register::INT_CTRL => self.registers.int_ctrl,
            register::INT_IO_CONF => self.registers.int_io,
            register::INT_MAP => self.registers.int_map,
            register::SELF_TEST => self.self_test_result(now),
            _ => 0,
        }
    }

    fn write(&mut self, register: u8, value: u8, selected_at: Ps, now: Ps) {
        // A die ignores writes while it starts.
        if now < self.alive_at {
            return;
        }
        self.write_gap.written(self.suspended(), selected_at);
        match register {
            register::RANGE if value <= 4 => self.registers.range = value,
            register::BANDWIDTH if value & 0x7F <= 7 => {
                // Bit 7 always reads 1.
                self.registers.bandwidth = 0x80 | value;
                self.configure_output(now);
            }
            register::LPM1 => self.registers.lpm1 = value,
            register::INT_CTRL => self.registers.int_ctrl = value,
            register::INT_IO_CONF => self.registers.int_io = value,
            register::INT_MAP => self.registers.int_map = value,
            register::SELF_TEST if value & 1 != 0 => {
                self.self_test_done_at = Some(now + SELF_TEST_TIME);
            }
            register::FIFO_CONFIG_0 => self.fifo.clear(),
            register::FIFO_CONFIG_1 => self.fifo.configure(value),
            register::SOFTRESET if value == SOFTRESET => self.power_on(now),
            _ => {}
        }
    }

    fn deselected(&mut self, now: Ps) {
        self.write_gap.deselected(now);
    }

    fn drives_miso(&self) -> bool {
        true
    }
}

/// Output rate and 3 dB bandwidth in Hz of a GYRO_BANDWIDTH value (datasheet chapter 5.5).
fn output_filter(bandwidth: u8) -> (f64, f64) {
    match bandwidth & 0x07 {
        0 => (2_000.0, 532.0),
        1 => (2_000.0, 230.0),
        2 => (1_000.0, 116.0),
        3 => (400.0, 47.0),
        4 => (200.0, 23.0),
        5 => (100.0, 12.0),
        6 => (200.0, 64.0),
        _ => (100.0, 32.0),
    }
}
