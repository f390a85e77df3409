//! The chip's temperature sensor.

use super::*;

const APB2ENR: u32 = RCC + 0x44;
const ADC: u32 = 0x4001_2000;

/// ADC1_IN16 with 480 cycles at 21 MHz: 0.76 V at 25 °C, 2.5 mV/K.
#[test]
fn the_chip_measures_its_own_temperature() {
    let mut bench = board();
    bench.set_bits(APB2ENR, 1 << 8 | 1 << 10);
    bench.write(ADC + 0x304, 1 << 16 | 1 << 23);
    bench.write(ADC + 0x08, 1);
    bench.write(ADC + 0x0C, 7 << 18);
    bench.write(ADC + 0x34, 16);
    bench.run_until(bench.now + 20 * US);
    bench.write(ADC + 0x08, 1 | 1 << 30);
    bench.run_until(bench.now + 30 * US);
    let volts = f64::from(bench.read(ADC + 0x4C)) / 4096.0 * 3.3;
    let measured_c = (volts - 0.76) / 2.5e-3 + 25.0;
    let true_c = bench.truth("truth.chip.temperature_c");
    assert!(
        (measured_c - true_c).abs() < 0.5,
        "{measured_c}, not {true_c}"
    );
    assert!((30.0..60.0).contains(&true_c));
    assert_eq!(bench.errors(), Vec::<&str>::new());
}
