use super::*;
use crate::{
    soc::bus::RegisterPatch,
    soc::reset::ResetCause,
    time::{MS, US},
};

#[test]
fn the_pll_brings_the_board_to_168_mhz() {
    let mut bench = Bench::new();
    assert_eq!(bench.soc.clocks.hclk_hz, 16_000_000);
    bench.set_bits(RCC, 1 << 16);
    // The crystal needs time: HSERDY is bit 17.
    assert_eq!(bench.read(RCC) >> 17 & 1, 0);
    bench.clock_up();
    assert_eq!(bench.read(RCC) >> 25 & 1, 1, "PLLRDY");
    assert_eq!(bench.read(RCC + 0x08) >> 2 & 3, 2, "SWS");
    let clocks = bench.soc.clocks;
    assert_eq!(
        (clocks.hclk_hz, clocks.pclk1_hz, clocks.pclk2_hz),
        (168_000_000, 42_000_000, 84_000_000)
    );
    assert_eq!((clocks.tim1_hz, clocks.tim2_hz), (84_000_000, 168_000_000));
    assert_eq!(bench.errors(), Vec::<&str>::new());
}

#[test]
fn sysclk_waits_for_the_pll_to_lock() {
    let mut bench = Bench::new();
    bench.set_bits(RCC, 1 << 16);
    bench.run_for(2 * MS);
    bench.write(RCC + 0x04, 6 | 168 << 6 | 1 << 22 | 7 << 24);
    bench.write(FLASH_ACR, 5);
    bench.set_bits(RCC, 1 << 24);
    bench.write(RCC + 0x08, 0b10 | 0b101 << 10 | 0b100 << 13);
    assert_eq!(bench.read(RCC + 0x08) >> 2 & 3, 0, "still HSI");
    // Datasheet table 41: at most 300 µs.
    bench.run_for(300 * US);
    assert_eq!(bench.soc.clocks.hclk_hz, 168_000_000);
}

#[test]
fn wait_states_and_regulator_scale_are_checked() {
    let mut bench = Bench::new();
    bench.clock_up();
    bench.write(FLASH_ACR, 4);
    assert!(bench.has_error("4 wait states at HCLK 168000000 Hz, needs 5"));
    bench.set_bits(APB1ENR, 1 << 28);
    bench.write(PWR_CR, 0);
    assert!(bench.has_error("VOS = 0"));
}

#[test]
fn an_unclocked_block_ignores_accesses_and_is_reported() {
    let mut bench = Bench::new();
    let usart3_brr = 0x4000_4808;
    bench.write(usart3_brr, 420);
    assert_eq!(bench.read(usart3_brr), 0);
    assert!(bench.has_error("USART3: registers written while RCC APB1ENR.USART3EN is 0"));
    bench.set_bits(APB1ENR, 1 << 18);
    bench.write(usart3_brr, 420);
    assert_eq!(bench.read(usart3_brr), 420);
}

#[test]
fn the_two_can_controllers_are_gated_each_by_its_bit() {
    let mut bench = Bench::new();
    bench.set_bits(APB1ENR, 1 << 25);
    // MCR of CAN2.
    bench.write(0x4000_6800, 1);
    assert!(bench.has_error("CAN2: registers written while RCC APB1ENR.CAN2EN is 0"));
    assert!(!bench.has_error("CAN1:"));
    bench.write(APB1ENR, 1 << 26);
    bench.write(0x4000_6800, 1);
    assert!(bench.has_error("CAN2: registers written while RCC APB1ENR.CAN1EN is 0"));
}

#[test]
fn a_reset_bit_brings_back_the_reset_values() {
    let mut bench = Bench::new();
    bench.set_bits(APB1ENR, 1);
    let tim2_psc = 0x4000_0028;
    bench.write(tim2_psc, 83);
    bench.set_bits(RCC + 0x20, 1);
    bench.write(RCC + 0x20, 0);
    assert_eq!(bench.read(tim2_psc), 0);
}

#[test]
fn a_block_held_in_reset_ignores_accesses_and_is_reported() {
    let mut bench = Bench::new();
    bench.set_bits(APB1ENR, 1);
    // TIM2RST set and never cleared.
    bench.set_bits(RCC + 0x20, 1);
    let tim2_psc = 0x4000_0028;
    bench.write(tim2_psc, 83);
    assert_eq!(bench.read(tim2_psc), 0);
    assert!(bench.has_error("TIM2: registers written while RCC holds it in reset"));
}

#[test]
fn a_prescaler_that_overclocks_a_bus_is_named() {
    let mut bench = Bench::new();
    bench.clock_up();
    // APB1 at /2 instead of /4.
    bench.write(RCC + 0x08, 0b10 | 0b100 << 10 | 0b100 << 13);
    assert!(bench.has_error("PCLK1 is 84000000 Hz, more than the 42 MHz allowed"));
}

#[test]
fn stopping_a_clock_in_sleep_is_refused() {
    let mut bench = Bench::new();
    let (apb1lpenr, now) = (RCC + 0x60, bench.now);
    assert_eq!(bench.read(apb1lpenr), 0x36FE_C9FF);
    let error = bench
        .soc
        .write(apb1lpenr, 4, 0x36FE_C9FE, now, &mut bench.ram)
        .unwrap_err();
    assert_eq!(error.register, "RCC.APB1LPENR");
}

#[test]
fn reset_flags_tell_the_cause_until_removed() {
    let mut bench = Bench::new();
    let csr = RCC + 0x74;
    // RM0090 7.3.21: reset value 0x0E00 0000 after power-on.
    assert_eq!(bench.read(csr), 0x0E00_0000);
    bench.write(csr, 1 << 24);
    assert_eq!(bench.read(csr), 0);
    let now = bench.now;
    bench.soc.reset(ResetCause::IndependentWatchdog, now);
    // IWDGRSTF and PINRSTF.
    assert_eq!(bench.read(csr), 1 << 29 | 1 << 26);
}

#[test]
fn lsi_gets_ready_after_its_start_up() {
    let mut bench = Bench::new();
    bench.write(RCC + 0x74, 1);
    assert_eq!(bench.read(RCC + 0x74) & 2, 0);
    // Datasheet table 37: at most 40 µs.
    bench.run_for(40 * US);
    assert_eq!(bench.read(RCC + 0x74) & 2, 2);
    assert!(bench.soc.clocks.lsi_on);
}

#[test]
fn a_patch_changes_every_write_to_its_register() {
    let mut bench = Bench::new();
    bench.soc.add_patch(RegisterPatch {
        address: FLASH_ACR,
        mask: 7,
        value: 2,
    });
    bench.write(FLASH_ACR, 0x705);
    assert_eq!(bench.read(FLASH_ACR), 0x702);
}

#[test]
fn registers_outside_the_model_are_named() {
    let mut bench = Bench::new();
    let now = bench.now;
    let error = bench
        .soc
        .read(0x4000_1004, 4, now, &mut bench.ram)
        .unwrap_err();
    assert_eq!(error.register, "TIM6+0x4");
}
