use super::*;
use crate::{
    soc::pins::{ExternalConnection, Pin, PinMode},
    time::US,
};

const GPIOA: u32 = 0x4002_0000;
const GPIOB: u32 = 0x4002_0400;
const GPIOC: u32 = 0x4002_0800;
const GPIOE: u32 = 0x4002_1000;
const EXTI: u32 = 0x4001_3C00;
const SYSCFG: u32 = 0x4001_3800;

fn ports_on() -> Bench {
    let mut bench = Bench::new();
    bench.set_bits(AHB1ENR, 0x1FF);
    bench
}

#[test]
fn debug_pins_start_on_their_alternate_function() {
    let mut bench = ports_on();
    // RM0090 8.4.1.
    assert_eq!(bench.read(GPIOA), 0xA800_0000);
    assert_eq!(bench.read(GPIOB), 0x0000_0280);
    assert_eq!(bench.soc.pins.mode(Pin::new('B', 3)), PinMode::Alternate(0));
}

#[test]
fn setting_wins_over_resetting_in_bsrr() {
    let mut bench = ports_on();
    bench.write(GPIOA, 0b01 << 8 | 0xA800_0000);
    bench.write(GPIOA + 0x18, 1 << 4 | 1 << 20);
    assert_eq!(bench.soc.pins.level(Pin::new('A', 4)), Some(true));
    assert_eq!(bench.read(GPIOA + 0x10) >> 4 & 1, 1);
    bench.write(GPIOA + 0x18, 1 << 20);
    assert_eq!(bench.soc.pins.level(Pin::new('A', 4)), Some(false));
}

#[test]
fn an_open_drain_output_pulls_down_and_lets_go() {
    let mut bench = ports_on();
    let pa5 = Pin::new('A', 5);
    bench.write(GPIOA + 0x04, 1 << 5);
    bench.write(GPIOA, 0b01 << 10 | 0xA800_0000);
    assert_eq!(bench.soc.pins.level(pa5), Some(false));
    bench.write(GPIOA + 0x18, 1 << 5);
    assert_eq!(bench.soc.pins.level(pa5), None);
    bench
        .soc
        .pins
        .connect(pa5, ExternalConnection::Drives(false));
    assert_eq!(bench.soc.pins.level(pa5), Some(false));
}

#[test]
fn a_pin_nobody_drives_reads_noise_and_a_pulled_one_its_resistor() {
    let mut bench = ports_on();
    let read_pe2 = |bench: &mut Bench, pull: u32| {
        bench.write(GPIOE + 0x0C, pull << 4);
        let reads = (0..64).map(|_| {
            bench.now += US;
            bench.read(GPIOE + 0x10) >> 2 & 1
        });
        reads.sum::<u32>()
    };
    let floating = read_pe2(&mut bench, 0b00);
    assert!((16..48).contains(&floating), "{floating} of 64");
    assert_eq!(read_pe2(&mut bench, 0b01), 64);
    assert_eq!(read_pe2(&mut bench, 0b10), 0);
    // The board's pull-up wins over the chip's 40 kΩ.
    bench.write(GPIOA + 0x0C, 0b10);
    assert_eq!(bench.read(GPIOA + 0x10) & 1, 1);
}

#[test]
fn two_outputs_on_a_wire_are_named() {
    let mut bench = ports_on();
    bench.write(GPIOC, 0b01 << 22);
    assert_eq!(
        bench.errors(),
        ["PC11 is an output, and so is what the board has there"]
    );
}

#[test]
fn alternate_functions_reach_the_pin() {
    let mut bench = ports_on();
    bench.write(GPIOA, 0b10 << 14 | 0xA800_0000);
    bench.write(GPIOA + 0x20, 5 << 28);
    assert_eq!(bench.soc.pins.mode(Pin::new('A', 7)), PinMode::Alternate(5));
}

#[test]
fn an_edge_on_the_selected_port_raises_exti3() {
    let mut bench = ports_on();
    bench.set_bits(APB2ENR, 1 << 14);
    bench.write(GPIOE + 0x18, 1 << 3);
    bench.write(GPIOE, 0b01 << 6);
    // EXTI3 from port E (4), falling edge, unmasked (RM0090 9.2.3, 12.3).
    bench.write(SYSCFG + 0x08, 4 << 12);
    bench.write(EXTI + 0x0C, 1 << 3);
    bench.write(EXTI, 1 << 3);
    assert!(!bench.soc.irq.level(9));
    bench.write(GPIOE + 0x18, 1 << 19);
    assert!(bench.soc.irq.level(9));
    bench.write(EXTI + 0x14, 1 << 3);
    assert!(!bench.soc.irq.level(9));
    assert_eq!(bench.errors(), Vec::<&str>::new());
}

#[test]
fn waiting_for_an_edge_nobody_makes_is_named() {
    let mut bench = ports_on();
    bench.set_bits(APB2ENR, 1 << 14);
    // EXTI5 from port C (2), where the board has nothing.
    bench.write(SYSCFG + 0x0C, 2 << 4);
    bench.write(EXTI + 0x0C, 1 << 5);
    bench.write(EXTI, 1 << 5);
    assert_eq!(
        bench.errors(),
        ["EXTI5: nothing modelled drives PC5: no edge ever comes"]
    );
}
