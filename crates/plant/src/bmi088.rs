//! BMI088 inertial sensor: two dies in one package, each an SPI device of its own (Bosch BST-BMI088-DS000 rev 1.8).

mod accel;
mod die;
mod fifo;
mod gyro;
mod low_pass;
mod sample_clock;
mod thermal;
mod transaction;
mod write_gap;

use crate::{
    complaint::Complaint,
    motion::{Motion, MotionSource},
    random::{Random, Stream},
    time::Ps,
    wire::SpiSelect,
};
use accel::AccelDie;
use die::Die;
use gyro::GyroDie;
use thermal::Thermal;
use transaction::Transaction;

/// Fastest serial clock of both dies.
const MAX_SCK_HZ: u32 = 10_000_000;
/// Above the limit, but DJI's own programs for this board use it and work.
const SCK_SEEN_TO_WORK_HZ: u32 = 10_500_000;

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ImuFaults {
    /// No supply: neither die answers, and all settings are lost.
    pub gone: bool,
    /// The data registers never change again.
    pub frozen: bool,
    /// Every new sample is at an end of the range.
    pub extreme: bool,
    /// The gyro's FIFO slips by one axis (ArduPilot pull request 20434).
    pub fifo_shift: bool,
    /// Some gyro samples are −32768 on all axes (ArduPilot issues 22710 and 25178).
    pub gyro_spikes: bool,
}

#[derive(Clone)]
pub(crate) struct Bmi088 {
    accel: AccelDie,
    gyro: GyroDie,
    accel_wire: Transaction,
    gyro_wire: Transaction,
    thermal: Thermal,
    faults: ImuFaults,
    garbage: Random,
}

impl Bmi088 {
    pub(crate) fn new(seed: u64, source: MotionSource, temperature_c: Option<f64>) -> Self {
        Self {
            accel: AccelDie::new(Random::new(seed, Stream::Accel), source),
            gyro: GyroDie::new(Random::new(seed, Stream::Gyro), source),
            accel_wire: Transaction::default(),
            gyro_wire: Transaction::default(),
            thermal: Thermal::new(temperature_c),
            faults: ImuFaults::default(),
            garbage: Random::new(seed, Stream::SpiGarbage),
        }
    }

    pub(crate) fn set_faults(&mut self, faults: ImuFaults, now: Ps) {
        if self.faults.gone && !faults.gone {
            self.accel.power_on(now);
            self.gyro.power_on(now);
        }
        if faults.fifo_shift && !self.faults.fifo_shift {
            self.gyro.slip_fifo();
        }
        self.faults = faults;
    }

    pub(crate) fn set_heater_duty(&mut self, duty: f64) {
        self.thermal.heater_duty = duty.clamp(0.0, 1.0);
    }

    pub(crate) fn heater_duty(&self) -> f64 {
        self.thermal.heater_duty
    }

    pub(crate) fn temperature_c(&self) -> f64 {
        self.thermal.temperature_c()
    }

    /// Temperature of the board around it, °C.
    pub(crate) fn board_c(&self) -> f64 {
        self.thermal.board_c()
    }

    /// Complaints of writes that came too soon after another.
    pub(crate) fn take_complaints(&mut self) -> impl Iterator<Item = Complaint> {
        let dies = [
            self.accel.take_write_complaint(),
            self.gyro.take_write_complaint(),
        ];
        dies.into_iter().flatten()
    }

    /// One step of the analogue chain, ending at `now`.
    pub(crate) fn step(&mut self, motion: Motion, now: Ps, dt_s: f64) {
        self.thermal.step(dt_s);
        if self.faults.gone || self.faults.frozen {
            return;
        }
        let accel_sampled = self.accel.step(
            motion.accel_mps2,
            self.thermal.temperature_c(),
            self.accel_wire.selected,
            now,
        );
        let gyro_sampled = self
            .gyro
            .step(motion.gyro_rps, self.gyro_wire.selected, now);
        if self.faults.extreme && accel_sampled {
            self.accel.replace_sample(extremes(&mut self.garbage));
        }
        if gyro_sampled {
            self.spoil_gyro_sample();
        }
    }

    fn spoil_gyro_sample(&mut self) {
        const SAMPLES_TO_SPIKE: u32 = 50;
        const SAMPLES_TO_SLIP: u32 = 1_000;
        if self.faults.extreme {
            self.gyro.replace_sample(extremes(&mut self.garbage));
        }
        if self.faults.gyro_spikes && self.garbage.below(SAMPLES_TO_SPIKE) == 0 {
            self.gyro.replace_sample([i16::MIN; 3]);
        }
        let may_slip = self.faults.fifo_shift && self.gyro.streams();
        if may_slip && self.garbage.below(SAMPLES_TO_SLIP) == 0 {
            self.gyro.slip_fifo();
        }
    }

    pub(crate) fn select(&mut self, device: SpiSelect, selected: bool, now: Ps) {
        let wire = match device {
            SpiSelect::Accel => &mut self.accel_wire,
            SpiSelect::Gyro => &mut self.gyro_wire,
        };
        if wire.selected == selected {
            return;
        }
        *wire = Transaction::begin(selected, now);
        if !selected {
            match device {
                SpiSelect::Accel => self.accel.deselected(now),
                SpiSelect::Gyro => self.gyro.deselected(now),
            }
        }
    }

    /// The misuse by which the selected dies may not understand the master, if there is one.
    pub(crate) fn misuse(&self, sck_hz: u32, mode: u8) -> Option<Complaint> {
        let too_fast = || format!("BMI088: SCK at {sck_hz} Hz, at most {MAX_SCK_HZ} Hz");
        if self.accel_wire.selected && self.gyro_wire.selected {
            Some(Complaint::fails(
                "BMI088: both chip selects are low: the dies fight over MISO",
            ))
        } else if !(self.accel_wire.selected || self.gyro_wire.selected) {
            None
        } else if !matches!(mode, 0 | 3) {
            let text = format!("BMI088: SPI mode {mode}, needs 0 or 3: garbage");
            Some(Complaint::fails(text))
        } else if sck_hz > SCK_SEEN_TO_WORK_HZ {
            Some(Complaint::fails(too_fast() + ": garbage"))
        } else if sck_hz > MAX_SCK_HZ {
            Some(Complaint::suspicious(too_fast()))
        } else {
            None
        }
    }

    pub(crate) fn transfer(&mut self, mosi: u8, sck_hz: u32, mode: u8, now: Ps) -> u8 {
        if self.faults.gone || !(self.accel_wire.selected || self.gyro_wire.selected) {
            return 0xFF;
        }
        if sck_hz > SCK_SEEN_TO_WORK_HZ || !matches!(mode, 0 | 3) {
            return self.garbage.byte();
        }
        let mut miso = 0xFF;
        // Two dies selected at once fight over MISO; the low driver wins.
        if self.accel_wire.selected {
            miso &= self.accel_wire.exchange(&mut self.accel, mosi, now);
        }
        if self.gyro_wire.selected {
            miso &= self.gyro_wire.exchange(&mut self.gyro, mosi, now);
        }
        miso
    }
}

/// Three axes, each at a random end of the range.
fn extremes(random: &mut Random) -> [i16; 3] {
    const ENDS: [i16; 3] = [i16::MAX, i16::MIN, -i16::MAX];
    std::array::from_fn(|_| ENDS[random.below(3) as usize])
}

#[cfg(test)]
mod tests;
