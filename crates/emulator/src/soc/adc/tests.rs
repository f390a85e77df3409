//! Single conversions of a pin, of the temperature sensor and of the internal reference.

use super::{Adc, temperature_counts, vrefint_counts};
use crate::{
    soc::{
        clocks::cycles_to_ps,
        peripheral::Peripheral,
        pins::{Pin, PinMode},
        test_bench::Bench,
    },
    time::US,
};

const SR: u32 = 0x200;
const CR2: u32 = 0x208;
const SMPR2: u32 = 0x210;
const SQR1: u32 = 0x22C;
const SQR3: u32 = 0x234;
const DR: u32 = 0x24C;
const CCR: u32 = 0x304;
const ADON: u32 = 1;
const SWSTART: u32 = 1 << 30;

/// IN8 with 56 cycles of sampling, ADCCLK = 84 MHz / 4.
fn ready() -> (Bench, Adc) {
    let (mut bench, mut adc) = (Bench::new(), Adc::new());
    bench.write(&mut adc, CCR, 1 << 16);
    bench.write(&mut adc, CR2, ADON);
    bench.write(&mut adc, SMPR2, 3 << 24);
    bench.write(&mut adc, SQR3, 8);
    bench.now = 5 * US;
    (bench, adc)
}

#[test]
fn a_conversion_takes_sampling_and_twelve_cycles_and_reads_the_pin() {
    let (mut bench, mut adc) = ready();
    bench.write(&mut adc, CR2, ADON | SWSTART);
    let time = cycles_to_ps(56 + 12, 21_000_000);
    let start = bench.now;
    bench.run(&mut adc, start + time - 1);
    // STRT.
    assert_eq!(bench.read(&mut adc, SR), 1 << 4);
    bench.run(&mut adc, start + time);
    assert_eq!(bench.read(&mut adc, SR), 1 << 4 | 1 << 1);
    let volts = f64::from(bench.read(&mut adc, DR)) / 4096.0 * 3.3;
    assert!((volts - bench.board.analog_v).abs() < 0.002, "{volts}");
    assert_eq!(
        bench.read(&mut adc, SR) & 1 << 1,
        0,
        "reading DR clears EOC"
    );
}

/// IN17 of ADC1 with 480 cycles, TSVREFE.
fn reference_ready() -> (Bench, Adc) {
    let (mut bench, mut adc) = (Bench::new(), Adc::new());
    bench.write(&mut adc, CCR, 1 << 16 | 1 << 23);
    bench.write(&mut adc, 0x08, ADON);
    bench.write(&mut adc, 0x0C, 7 << 21);
    bench.write(&mut adc, 0x34, 17);
    bench.now = 20 * US;
    (bench, adc)
}

/// DS8626: 1.18 to 1.24 V; 480 and 12 cycles of 21 MHz take 23.4 us.
#[test]
fn the_internal_reference_tells_the_supply() {
    for supply_v in [3.3, 3.4, 3.2] {
        let (mut bench, mut adc) = reference_ready();
        bench.board.vdda_v = supply_v;
        bench.write(&mut adc, 0x08, ADON | SWSTART);
        bench.run(&mut adc, bench.now + 24 * US);
        let counts = f64::from(bench.read(&mut adc, 0x4C));
        let calibration = f64::from(vrefint_counts(3.3));
        assert!((1.18..1.24).contains(&(calibration / 4095.0 * 3.3)));
        let seen_v = 3.3 * calibration / counts;
        assert!((seen_v - supply_v).abs() < 0.005, "{seen_v}");
        assert!(bench.error_texts().is_empty());
    }
}

#[test]
fn the_internal_reference_wants_its_bit_and_time() {
    let (mut bench, mut adc) = reference_ready();
    bench.write(&mut adc, CCR, 1 << 16);
    bench.write(&mut adc, 0x08, ADON | SWSTART);
    bench.run(&mut adc, bench.now + 24 * US);
    assert_eq!(bench.read(&mut adc, 0x4C), 0);
    bench.write(&mut adc, CCR, 1 << 16 | 1 << 23);
    bench.write(&mut adc, 0x0C, 1 << 21);
    bench.write(&mut adc, 0x08, ADON | SWSTART);
    bench.run(&mut adc, bench.now + 2 * US);
    assert!(bench.error_texts()[0].contains("TSVREFE is 0"));
    let texts = bench.suspicion_texts();
    for part in ["less than 10 us:", "less than 10 us after"] {
        assert!(texts.iter().any(|text| text.contains(part)), "{texts:?}");
    }
}

/// IN16 of ADC1 with the sampling of `smpr1`, TSVREFE.
fn measured_temperature(bench: &mut Bench, smpr1: u32) -> f64 {
    let mut adc = Adc::new();
    bench.write(&mut adc, CCR, 1 << 16 | 1 << 23);
    bench.write(&mut adc, 0x08, ADON);
    bench.write(&mut adc, 0x0C, smpr1);
    bench.write(&mut adc, 0x34, 16);
    bench.now += 20 * US;
    bench.write(&mut adc, 0x08, ADON | SWSTART);
    bench.run(&mut adc, bench.now + 24 * US);
    f64::from(bench.read(&mut adc, 0x4C))
}

const LONG_ENOUGH: u32 = 7 << 18;

/// DS8626: 0.76 V at 25 °C and 2.5 mV/K; 0.76 V are 943 of 4096 at 3.3 V.
#[test]
fn the_temperature_sensor_has_the_datasheets_line_and_calibration() {
    for celsius in [-20.0, 25.0, 38.0, 90.0] {
        let mut bench = Bench::new();
        bench.board.chip_temperature_c = celsius;
        let counts = measured_temperature(&mut bench, LONG_ENOUGH);
        let typical = (counts / 4096.0 * 3.3 - 0.76) / 2.5e-3 + 25.0;
        assert!((typical - celsius).abs() < 0.5, "{typical}");
        let [cold, hot] = [30.0, 110.0].map(|c| f64::from(temperature_counts(c)));
        let calibrated = (counts - cold) * (110.0 - 30.0) / (hot - cold) + 30.0;
        assert!((calibrated - celsius).abs() < 1.0, "{calibrated}");
        assert!(bench.error_texts().is_empty() && bench.suspicion_texts().is_empty());
    }
    assert_eq!(measured_temperature(&mut Bench::new(), LONG_ENOUGH), 943.0);
}

/// A ratio to the supply: at 3.4 V the same voltage is fewer counts.
#[test]
fn the_temperature_is_measured_against_the_supply() {
    let mut bench = Bench::new();
    bench.board.vdda_v = 3.4;
    assert_eq!(measured_temperature(&mut bench, LONG_ENOUGH), 915.0);
}

/// 112 cycles of 21 MHz are 5.3 us.
#[test]
fn the_temperature_sensor_wants_its_bit_and_time() {
    let mut bench = Bench::new();
    measured_temperature(&mut bench, 5 << 18);
    let texts = bench.suspicion_texts();
    let expected = "ADC1: the temperature sensor is sampled for less than 10 us";
    assert!(
        texts.len() == 1 && texts[0].starts_with(expected),
        "{texts:?}"
    );
    let (mut bench, mut adc) = reference_ready();
    bench.write(&mut adc, CCR, 1 << 16);
    bench.write(&mut adc, 0x34, 16);
    bench.write(&mut adc, 0x08, ADON | SWSTART);
    bench.run(&mut adc, bench.now + 24 * US);
    assert!(
        bench.error_texts()[0].starts_with("ADC: the temperature sensor converted while TSVREFE")
    );
}

/// The sensor hangs on ADC1 alone (RM0090 13.10).
#[test]
fn only_adc1_has_the_temperature_sensor() {
    let (mut bench, mut adc) = ready();
    bench.write(&mut adc, SQR3, 16);
    assert!(adc.write(CR2, 4, ADON | SWSTART, &mut bench.ctx()).is_err());
}

#[test]
fn a_pin_left_digital_reads_nothing() {
    let (mut bench, mut adc) = ready();
    bench.change_pin(Pin::new('F', 10), |pin| pin.mode = PinMode::Input);
    bench.write(&mut adc, CR2, ADON | SWSTART);
    bench.run(&mut adc, 20 * US);
    assert_eq!(bench.read(&mut adc, DR), 0);
    assert!(bench.error_texts()[0].starts_with("ADC3_IN8"));
}

#[test]
fn exceeded_limits_of_the_converter_are_reported() {
    let (mut bench, mut adc) = ready();
    bench.write(&mut adc, CCR, 0);
    bench.write(&mut adc, CR2, 0);
    bench.write(&mut adc, CR2, ADON);
    bench.write(&mut adc, CR2, ADON | SWSTART);
    let texts = bench.suspicion_texts();
    assert!(texts.iter().any(|e| e.contains("less than 3 us")));
    assert!(texts.iter().any(|e| e.contains("42000000 Hz")));
    // Two conversions in the sequence.
    bench.write(&mut adc, SQR1, 1 << 20);
    assert!(adc.write(CR2, 4, ADON | SWSTART, &mut bench.ctx()).is_err());
}
