use super::*;
use crate::{
    complaint::Severity,
    physics::{PHYSICS_STEP, physics_step_s},
    time::{MS, US},
};

const SCK_HZ: u32 = 5_250_000;
const LEVEL: Motion = Motion {
    accel_mps2: [0.0, 0.0, 9.80665],
    gyro_rps: [0.0; 3],
};

/// A sensor and its clock, driven register by register.
struct Bench {
    imu: Bmi088,
    now: Ps,
    motion: Motion,
}

impl Bench {
    fn new(source: MotionSource) -> Self {
        Self {
            imu: Bmi088::new(7, source, Some(30.0)),
            now: 0,
            motion: LEVEL,
        }
    }

    /// Started as the datasheet says: dummy read, soft resets, power up, then range and rate.
    fn configured(source: MotionSource) -> Self {
        let mut bench = Self::new(source);
        bench.wait(30 * MS);
        bench.read::<3>(SpiSelect::Accel, 0x00);
        bench.write(SpiSelect::Accel, 0x7C, 0x00);
        bench.wait(500 * US);
        bench.write(SpiSelect::Accel, 0x7D, 0x04);
        bench.wait(MS);
        for (register, value) in [(0x40, 0x9A), (0x41, 0x02)] {
            bench.write(SpiSelect::Accel, register, value);
            bench.wait(10 * US);
        }
        for (register, value) in [(0x0F, 0x00), (0x10, 0x83)] {
            bench.write(SpiSelect::Gyro, register, value);
            bench.wait(10 * US);
        }
        bench.wait(100 * MS);
        bench
    }

    fn wait(&mut self, time: Ps) {
        let end = self.now + time;
        let mut step = (self.now / PHYSICS_STEP + 1) * PHYSICS_STEP;
        while step <= end {
            self.imu.step(self.motion, step, physics_step_s());
            step += PHYSICS_STEP;
        }
        self.now = end;
    }

    /// Bytes that come back after the address byte.
    fn read<const N: usize>(&mut self, device: SpiSelect, register: u8) -> [u8; N] {
        self.imu.select(device, true, self.now);
        self.imu.transfer(0x80 | register, SCK_HZ, 3, self.now);
        let bytes = std::array::from_fn(|_| self.imu.transfer(0, SCK_HZ, 3, self.now));
        self.imu.select(device, false, self.now);
        bytes
    }

    fn write(&mut self, device: SpiSelect, register: u8, value: u8) {
        self.imu.select(device, true, self.now);
        self.imu.transfer(register, SCK_HZ, 3, self.now);
        self.imu.transfer(value, SCK_HZ, 3, self.now);
        self.imu.select(device, false, self.now);
    }

    fn accel_counts(&mut self) -> [i16; 3] {
        let [_, bytes @ ..] = self.read::<7>(SpiSelect::Accel, 0x12);
        counts(bytes)
    }

    fn gyro_counts(&mut self) -> [i16; 3] {
        let bytes = self.read::<6>(SpiSelect::Gyro, 0x02);
        counts(bytes)
    }
}

fn counts(bytes: [u8; 6]) -> [i16; 3] {
    std::array::from_fn(|axis| i16::from_le_bytes([bytes[2 * axis], bytes[2 * axis + 1]]))
}

fn mean_and_deviation(samples: &[f64]) -> (f64, f64) {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    let variance = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
    (mean, variance.sqrt())
}

#[test]
fn accelerometer_speaks_spi_only_after_its_chip_select_rose_once() {
    let mut bench = Bench::new(MotionSource::Physics);
    bench.wait(10 * MS);
    assert_eq!(bench.read::<2>(SpiSelect::Accel, 0x00), [0xFF, 0xFF]);
    assert_eq!(bench.read::<2>(SpiSelect::Accel, 0x00)[1], 0x1E);
    bench.write(SpiSelect::Accel, 0x7E, 0xB6);
    bench.wait(2 * MS);
    assert_eq!(bench.read::<2>(SpiSelect::Accel, 0x00)[1], 0xFF);
    assert_eq!(bench.read::<2>(SpiSelect::Accel, 0x00)[1], 0x1E);
}

#[test]
fn gyro_answers_without_dummy_byte_but_not_in_its_first_30_ms() {
    let mut bench = Bench::new(MotionSource::Physics);
    bench.wait(29 * MS);
    assert_ne!(bench.read::<1>(SpiSelect::Gyro, 0x00), [0x0F]);
    bench.wait(MS);
    assert_eq!(bench.read::<1>(SpiSelect::Gyro, 0x00), [0x0F]);
    bench.write(SpiSelect::Gyro, 0x10, 0x03);
    assert_eq!(bench.read::<1>(SpiSelect::Gyro, 0x10), [0x83]);
}

/// 1000 Hz for 5 ms; a burst of FIFO_DATA stays at its register.
#[test]
fn gyro_keeps_its_samples_until_they_are_read() {
    let mut bench = Bench::configured(MotionSource::Recording);
    bench.motion.gyro_rps = [1.0, -2.0, 0.5];
    bench.write(SpiSelect::Gyro, 0x10, 0x82);
    bench.wait(100 * MS);
    assert_eq!(bench.read::<1>(SpiSelect::Gyro, 0x0E), [0]);
    bench.write(SpiSelect::Gyro, 0x3E, 0x80);
    bench.wait(5 * MS);
    let registers = bench.read::<15>(SpiSelect::Gyro, 0x00);
    assert_eq!(registers[14], 5);
    let burst = bench.read::<30>(SpiSelect::Gyro, 0x3F);
    for frame in burst.chunks_exact(6) {
        assert_eq!(frame, &registers[2..8]);
    }
    assert_eq!(bench.read::<1>(SpiSelect::Gyro, 0x0E), [0]);
}

/// 1 rad/s is 939 counts. STREAM mode slips again, FIFO mode does not.
#[test]
fn a_slipped_fifo_differs_from_the_registers_until_it_is_reset() {
    let slipped = ImuFaults {
        fifo_shift: true,
        ..ImuFaults::default()
    };
    let reset = |bench: &mut Bench, mode| {
        for (register, value) in [(0x3D, 0), (0x3E, 0), (0x3E, mode)] {
            bench.write(SpiSelect::Gyro, register, value);
            bench.wait(10 * US);
        }
    };
    let newest = |bench: &mut Bench| {
        bench.wait(5 * MS);
        let frames = bench.read::<1>(SpiSelect::Gyro, 0x0E)[0] & 0x7F;
        let mut newest = [0; 3];
        for _ in 0..frames {
            newest = counts(bench.read::<6>(SpiSelect::Gyro, 0x3F));
        }
        newest.map(|count| (f64::from(count) / 939.0).round())
    };
    for (mode, slips_again) in [(0x40, false), (0x80, true)] {
        let mut bench = Bench::configured(MotionSource::Recording);
        bench.motion.gyro_rps = [1.0, -2.0, 3.0];
        reset(&mut bench, mode);
        bench.wait(100 * MS);
        reset(&mut bench, mode);
        assert_eq!(newest(&mut bench), [1.0, -2.0, 3.0]);
        bench.imu.set_faults(slipped, bench.now);
        assert_eq!(newest(&mut bench), [3.0, 1.0, -2.0]);
        reset(&mut bench, mode);
        let later = (0..1_000).map(|_| newest(&mut bench));
        let wrong = later.filter(|rates| *rates != [1.0, -2.0, 3.0]).count();
        assert_eq!(wrong > 0, slips_again, "{mode:#x}: {wrong}");
    }
}

#[test]
fn a_spike_is_on_all_axes_of_registers_and_fifo() {
    let mut bench = Bench::configured(MotionSource::Physics);
    bench.write(SpiSelect::Gyro, 0x3E, 0x40);
    let spiky = ImuFaults {
        gyro_spikes: true,
        ..ImuFaults::default()
    };
    bench.imu.set_faults(spiky, bench.now);
    let mut spikes = [0; 2];
    for _ in 0..4_000 {
        bench.wait(2_500 * US);
        let registers = bench.gyro_counts();
        let newest = counts(bench.read::<6>(SpiSelect::Gyro, 0x3F));
        assert_eq!(registers, newest);
        let spike = registers.contains(&i16::MIN);
        assert!(!spike || registers == [i16::MIN; 3]);
        spikes[usize::from(spike)] += 1;
    }
    assert!((40..120).contains(&spikes[1]), "one in fifty: {spikes:?}");
}

#[test]
fn suspended_accelerometer_measures_nothing() {
    let mut bench = Bench::new(MotionSource::Physics);
    bench.wait(30 * MS);
    bench.read::<2>(SpiSelect::Accel, 0x00);
    assert_eq!(bench.accel_counts(), [0; 3]);
    bench.write(SpiSelect::Accel, 0x7C, 0x00);
    bench.wait(450 * US);
    bench.write(SpiSelect::Accel, 0x7D, 0x04);
    bench.wait(50 * MS);
    assert_eq!(bench.read::<2>(SpiSelect::Accel, 0x7D)[1], 0x04);
    assert!(bench.accel_counts()[2] > 5_000);
}

/// Datasheet, idle time after write access: 2 µs in normal mode, 450 µs in suspend mode.
#[test]
fn writes_too_soon_after_another_are_accepted_and_reported() {
    let complaint = |bench: &mut Bench| bench.imu.take_complaints().next().map(|c| c.severity);
    let mut bench = Bench::new(MotionSource::Physics);
    bench.wait(30 * MS);
    bench.read::<2>(SpiSelect::Accel, 0x00);
    bench.write(SpiSelect::Accel, 0x7C, 0x00);
    bench.wait(449 * US);
    bench.write(SpiSelect::Accel, 0x7D, 0x04);
    assert_eq!(complaint(&mut bench), Some(Severity::Suspicious));
    assert_eq!(bench.read::<2>(SpiSelect::Accel, 0x7D)[1], 0x04);
    bench.wait(US);
    bench.write(SpiSelect::Accel, 0x40, 0x9A);
    assert_eq!(complaint(&mut bench), Some(Severity::Fails));
    bench.wait(2 * US);
    bench.write(SpiSelect::Accel, 0x41, 0x02);
    // The other die has a pause of its own.
    bench.write(SpiSelect::Gyro, 0x0F, 0x00);
    assert_eq!(complaint(&mut bench), None);
    bench.write(SpiSelect::Gyro, 0x10, 0x03);
    assert_eq!(complaint(&mut bench), Some(Severity::Fails));
    assert_eq!(bench.read::<1>(SpiSelect::Gyro, 0x10), [0x83]);
}

#[test]
fn too_fast_a_clock_or_a_wrong_mode_gives_garbage() {
    let mut bench = Bench::configured(MotionSource::Physics);
    for (sck_hz, mode) in [(21_000_000, 3), (SCK_HZ, 1), (SCK_HZ, 2)] {
        let ids: Vec<u8> = (0..8)
            .map(|_| {
                bench.imu.select(SpiSelect::Gyro, true, bench.now);
                bench.imu.transfer(0x80, sck_hz, mode, bench.now);
                let id = bench.imu.transfer(0, sck_hz, mode, bench.now);
                bench.imu.select(SpiSelect::Gyro, false, bench.now);
                id
            })
            .collect();
        assert!(ids.iter().any(|&id| id != 0x0F));
        assert_eq!(bench.imu.misuse(sck_hz, mode), None);
        bench.imu.select(SpiSelect::Gyro, true, bench.now);
        let complaint = bench.imu.misuse(sck_hz, mode);
        assert_eq!(complaint.map(|c| c.severity), Some(Severity::Fails));
        assert_eq!(bench.imu.misuse(SCK_HZ, 0), None);
        bench.imu.select(SpiSelect::Gyro, false, bench.now);
    }
}

/// DJI's programs for this board clock the sensor at 10.5 MHz.
#[test]
fn a_clock_just_above_the_limit_is_suspicious_and_works() {
    let mut bench = Bench::configured(MotionSource::Physics);
    bench.imu.select(SpiSelect::Gyro, true, bench.now);
    let complaint = bench.imu.misuse(10_500_000, 3);
    assert_eq!(complaint.map(|c| c.severity), Some(Severity::Suspicious));
    bench.imu.transfer(0x80, 10_500_000, 3, bench.now);
    assert_eq!(bench.imu.transfer(0, 10_500_000, 3, bench.now), 0x0F);
}

#[test]
fn selecting_both_dies_at_once_is_reported() {
    let mut bench = Bench::configured(MotionSource::Physics);
    bench.imu.select(SpiSelect::Gyro, true, bench.now);
    bench.imu.select(SpiSelect::Accel, true, bench.now);
    let complaint = bench.imu.misuse(SCK_HZ, 3);
    assert!(complaint.is_some_and(|c| c.text.contains("both chip selects")));
}

#[test]
fn gravity_and_turn_rate_come_out_in_datasheet_counts() {
    let mut bench = Bench::configured(MotionSource::Recording);
    bench.motion.gyro_rps = [1.0, -2.0, 0.5];
    bench.wait(100 * MS);
    // ±12 g: 2730 LSB/g; ±2000 °/s: 16.384 LSB/(°/s).
    assert!((f64::from(bench.accel_counts()[2]) - 2_730.0).abs() <= 1.5);
    let expected = [938.7, -1_877.5, 469.4];
    for (count, expected) in bench.gyro_counts().into_iter().zip(expected) {
        assert!((f64::from(count) - expected).abs() <= 1.0);
    }
    bench.motion = Motion {
        accel_mps2: [500.0, -500.0, 0.0],
        gyro_rps: [100.0, -100.0, 0.0],
    };
    bench.wait(100 * MS);
    assert_eq!(bench.accel_counts(), [32_767, -32_768, 0]);
    assert_eq!(bench.gyro_counts(), [32_767, -32_768, 0]);
}

#[test]
fn noise_and_offset_stay_within_the_datasheet() {
    let mut bench = Bench::configured(MotionSource::Physics);
    let (mut accel_mg, mut gyro_dps) = (Vec::new(), Vec::new());
    for _ in 0..4_000 {
        bench.wait(5 * MS);
        accel_mg.push(f64::from(bench.accel_counts()[0]) * 12_000.0 / 32_768.0);
        gyro_dps.push(f64::from(bench.gyro_counts()[0]) / 16.384);
    }
    // White noise through a second-order filter: density · √(1.11 · bandwidth), plus 1/√12 LSB of rounding.
    let (offset_mg, accel_noise_mg) = mean_and_deviation(&accel_mg);
    let expected_mg = (0.160_f64 * 0.160 * 1.11 * 75.0 + 0.366 * 0.366 / 12.0).sqrt();
    assert!(
        (accel_noise_mg / expected_mg - 1.0).abs() < 0.1,
        "{accel_noise_mg} mg"
    );
    assert!(offset_mg.abs() <= 20.0 && offset_mg != 0.0);
    let (offset_dps, gyro_noise_dps) = mean_and_deviation(&gyro_dps);
    let expected_dps = (0.014_f64 * 0.014 * 1.11 * 47.0 + 0.061 * 0.061 / 12.0).sqrt();
    assert!(
        (gyro_noise_dps / expected_dps - 1.0).abs() < 0.1,
        "{gyro_noise_dps} °/s"
    );
    assert!(offset_dps.abs() <= 1.0 && offset_dps != 0.0);
}

#[test]
fn data_ready_comes_at_the_output_rate_and_goes_with_the_read() {
    let mut bench = Bench::configured(MotionSource::Physics);
    let mut ready = 0;
    for _ in 0..1_000 {
        bench.wait(MS);
        if bench.read::<1>(SpiSelect::Gyro, 0x0A)[0] & 0x80 != 0 {
            ready += 1;
            bench.gyro_counts();
            assert_eq!(bench.read::<1>(SpiSelect::Gyro, 0x0A)[0] & 0x80, 0);
        }
    }
    assert!((399..=401).contains(&ready), "{ready} samples in a second");
}

#[test]
fn sensor_time_counts_39_us_and_temperature_follows_the_heater() {
    let mut bench = Bench::configured(MotionSource::Physics);
    let time = |bench: &mut Bench| {
        let [_, low, middle, high] = bench.read::<4>(SpiSelect::Accel, 0x18);
        u32::from_le_bytes([low, middle, high, 0])
    };
    let before = time(&mut bench);
    bench.wait(1_000 * MS);
    assert_eq!(time(&mut bench) - before, 25_600);
    let celsius = |bench: &mut Bench| {
        let [_, msb, lsb] = bench.read::<3>(SpiSelect::Accel, 0x22);
        let u = i32::from(msb) * 8 + i32::from(lsb) / 32;
        23.0 + 0.125 * f64::from(if u > 1_023 { u - 2_048 } else { u })
    };
    let cold_c = celsius(&mut bench);
    bench.imu.set_heater_duty(1.0);
    bench.wait(20_000 * MS);
    let warm_c = celsius(&mut bench);
    assert!((29.0..31.0).contains(&cold_c), "{cold_c}");
    assert!((45.0..56.0).contains(&warm_c), "{warm_c}");
    assert!((warm_c - bench.imu.temperature_c()).abs() < 2.0);
}

#[test]
fn lost_supply_reads_all_ones_and_forgets_the_settings() {
    let mut bench = Bench::configured(MotionSource::Physics);
    bench.imu.set_faults(
        ImuFaults {
            gone: true,
            frozen: false,
            ..ImuFaults::default()
        },
        bench.now,
    );
    assert_eq!(bench.gyro_counts(), [-1; 3]);
    bench.imu.set_faults(ImuFaults::default(), bench.now);
    bench.wait(40 * MS);
    assert_eq!(bench.read::<1>(SpiSelect::Gyro, 0x10), [0x80]);
    bench.read::<2>(SpiSelect::Accel, 0x00);
    assert_eq!(bench.read::<2>(SpiSelect::Accel, 0x7D)[1], 0);
}

/// Datasheet: 24 g, 1600 Hz, both polarities; they differ by at least 1000, 1000 and 500 mg.
#[test]
fn accelerometer_self_test_moves_every_axis_as_far_as_the_datasheet_asks() {
    let mut bench = Bench::configured(MotionSource::Physics);
    bench.write(SpiSelect::Accel, 0x41, 0x03);
    bench.wait(10 * US);
    bench.write(SpiSelect::Accel, 0x40, 0xAC);
    bench.wait(3 * MS);
    let [positive, negative] = [0x0D, 0x09].map(|polarity| {
        bench.write(SpiSelect::Accel, 0x6D, polarity);
        bench.wait(60 * MS);
        bench.accel_counts()
    });
    for axis in 0..3 {
        let difference = positive[axis] - negative[axis];
        assert!(difference >= [1_365, 1_365, 682][axis], "{difference}");
    }
}
