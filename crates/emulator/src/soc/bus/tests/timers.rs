use crate::time::{MS, NS, US};

use super::*;

const TIM2: u32 = 0x4000_0000;
const TIM2_IRQ: u8 = 28;

/// TIM2 as Embassy sets it up: 1 MHz, 16 bits, overflow and half-period interrupts.
fn time_driver() -> Bench {
    let mut bench = Bench::new();
    bench.clock_up();
    bench.set_bits(APB1ENR, 1);
    bench.write(TIM2 + 0x28, 83);
    bench.write(TIM2 + 0x2C, 0xFFFF);
    bench.write(TIM2, 1 << 2);
    bench.write(TIM2 + 0x14, 1);
    bench.write(TIM2, 0);
    bench.write(TIM2 + 0x34, 0x8000);
    bench.write(TIM2 + 0x0C, 0b11);
    bench.write(TIM2, 1);
    bench
}

#[test]
fn the_time_driver_counts_microseconds() {
    let mut bench = time_driver();
    let start = bench.now;
    bench.run_until(start + 1234 * US - NS);
    assert_eq!(bench.read(TIM2 + 0x24), 1233);
    bench.run_until(start + 1234 * US + NS);
    assert_eq!(bench.read(TIM2 + 0x24), 1234);
}

#[test]
fn half_period_and_overflow_interrupt_to_the_nanosecond() {
    let mut bench = time_driver();
    let start = bench.now;
    bench.soc.irq.take_risen();
    bench.run_until(start + 32_768 * US - NS);
    assert!(!bench.soc.irq.level(TIM2_IRQ));
    bench.run_until(start + 32_768 * US);
    assert!(bench.soc.irq.level(TIM2_IRQ));
    assert_eq!(bench.read(TIM2 + 0x10) & 0b11, 0b10);
    bench.write(TIM2 + 0x10, !0b10);
    assert!(!bench.soc.irq.level(TIM2_IRQ));
    bench.run_until(start + 65_536 * US);
    assert_eq!(bench.read(TIM2 + 0x10) & 0b11, 0b01);
}

#[test]
fn an_alarm_fires_at_its_compare_value_and_not_before() {
    let mut bench = time_driver();
    let start = bench.now;
    bench.run_until(start + 500 * US);
    bench.write(TIM2 + 0x38, 1500);
    bench.write(TIM2 + 0x0C, 0b111);
    bench.run_until(start + 1500 * US - NS);
    assert!(!bench.soc.irq.level(TIM2_IRQ));
    bench.run_until(start + 1500 * US);
    assert!(bench.soc.irq.level(TIM2_IRQ));
}

#[test]
fn an_alarm_moved_earlier_still_comes_in_time() {
    let mut bench = time_driver();
    let start = bench.now;
    bench.write(TIM2 + 0x38, 9000);
    bench.write(TIM2 + 0x0C, 0b111);
    bench.write(TIM2 + 0x38, 40);
    bench.run_until(start + 40 * US);
    assert!(bench.soc.irq.level(TIM2_IRQ));
}

#[test]
fn a_clock_change_keeps_the_count() {
    let mut bench = Bench::new();
    bench.set_bits(APB1ENR, 1);
    bench.write(TIM2 + 0x28, 15);
    bench.write(TIM2 + 0x14, 1);
    bench.write(TIM2, 1);
    // 1 MHz from the 16 MHz HSI, then HPRE = /2 slows it to 500 kHz.
    bench.run_until(MS);
    bench.write(RCC + 0x08, 0b1000 << 4);
    bench.run_until(3 * MS);
    assert_eq!(bench.read(TIM2 + 0x24), 2000);
}
