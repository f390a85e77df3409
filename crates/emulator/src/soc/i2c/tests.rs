//! Transfer sequences of RM0090 figures 242 and 243 with a device on the bus.

use super::I2c;
use crate::{
    soc::{
        dma_request::DmaRequest,
        peripheral::Peripheral,
        pins::{Pin, PinMode},
        test_bench::Bench,
        test_board::{I2C_DEVICE, I2C_IDENTITY},
    },
    time::{MS, Ps, US},
};

const CR1: u32 = 0x00;
const CR2: u32 = 0x04;
const DR: u32 = 0x10;
const SR1: u32 = 0x14;
const SR2: u32 = 0x18;
const CCR: u32 = 0x1C;
const TRISE: u32 = 0x20;

const PE: u32 = 1;
const START: u32 = 1 << 8;
const STOP: u32 = 1 << 9;
const ACK: u32 = 1 << 10;

const SB: u32 = 1;
const ADDR: u32 = 1 << 1;
const BTF: u32 = 1 << 2;
const RXNE: u32 = 1 << 6;
const TXE: u32 = 1 << 7;
const AF: u32 = 1 << 10;

/// The device of the test board, and the register that holds its identity.
const DEVICE: u32 = I2C_DEVICE as u32;
const IDENTITY: u32 = 0x00;
const IDENTITY_VALUE: u32 = I2C_IDENTITY as u32;

/// Fast mode, 42 MHz / (3 × 35) = 400 kHz: a byte with its acknowledge is 22.5 µs.
fn ready() -> (Bench, I2c) {
    let (mut bench, mut i2c) = (Bench::new(), I2c::new());
    bench.write(&mut i2c, CR2, 42);
    bench.write(&mut i2c, CCR, 1 << 15 | 35);
    // 300 ns at 42 MHz are 12 cycles, plus 1.
    bench.write(&mut i2c, TRISE, 13);
    bench.write(&mut i2c, CR1, PE);
    (bench, i2c)
}

fn wait_for(bench: &mut Bench, i2c: &mut I2c, flag: u32) -> Ps {
    let start = bench.now;
    while bench.read(i2c, SR1) & flag == 0 {
        assert!(
            bench.now < start + MS,
            "flag {flag:#x} never came, SR1 = {:#x}",
            bench.read(i2c, SR1)
        );
        let until = bench.now + 500_000;
        bench.run(i2c, until);
    }
    bench.now - start
}

fn address(bench: &mut Bench, i2c: &mut I2c, byte: u32, cr1: u32) {
    bench.write(i2c, CR1, PE | START | cr1);
    wait_for(bench, i2c, SB);
    assert_eq!(bench.read(i2c, CR1) & START, 0);
    bench.write(i2c, DR, byte);
    let time = wait_for(bench, i2c, ADDR | AF);
    assert!((22 * US..24 * US).contains(&time), "{time} ps");
}

fn point_at(bench: &mut Bench, i2c: &mut I2c, register: u32) {
    address(bench, i2c, DEVICE << 1, 0);
    // MSL, BUSY, TRA.
    assert_eq!(bench.read(i2c, SR2), 7);
    assert_eq!(bench.read(i2c, SR1), TXE);
    bench.write(i2c, DR, register);
    wait_for(bench, i2c, BTF);
}

#[test]
fn who_am_i_by_write_repeated_start_and_a_single_byte_read() {
    let (mut bench, mut i2c) = ready();
    point_at(&mut bench, &mut i2c, IDENTITY);
    address(&mut bench, &mut i2c, DEVICE << 1 | 1, ACK);
    // A single byte: ACK = 0 before ADDR is cleared, STOP after.
    bench.write(&mut i2c, CR1, PE);
    assert_eq!(bench.read(&mut i2c, SR2), 3);
    bench.write(&mut i2c, CR1, PE | STOP);
    wait_for(&mut bench, &mut i2c, RXNE);
    assert_eq!(bench.read(&mut i2c, DR), IDENTITY_VALUE);
    let until = bench.now + 5 * US;
    bench.run(&mut i2c, until);
    // The bus is free, STOP has cleared itself.
    assert_eq!(bench.read(&mut i2c, SR2), 0);
    assert_eq!(bench.read(&mut i2c, CR1), PE);
    assert_eq!(bench.error_texts(), Vec::<&str>::new());
}

#[test]
fn an_absent_device_gives_af_and_the_error_interrupt() {
    let (mut bench, mut i2c) = ready();
    bench.write(&mut i2c, CR2, 42 | 1 << 8);
    address(&mut bench, &mut i2c, 0x2A << 1, 0);
    assert_eq!(bench.read(&mut i2c, SR1) & (ADDR | AF), AF);
    assert!(bench.irq.level(73));
    bench.write(&mut i2c, SR1, !AF);
    assert!(!bench.irq.level(73));
    // The bus stays ours until STOP.
    assert_eq!(bench.read(&mut i2c, SR2) & 3, 3);
    bench.write(&mut i2c, CR1, PE | STOP);
    let until = bench.now + 5 * US;
    bench.run(&mut i2c, until);
    assert_eq!(bench.read(&mut i2c, SR2), 0);
}

#[test]
fn dma_reads_six_bytes_and_refuses_the_last_one() {
    let (mut bench, mut i2c) = ready();
    point_at(&mut bench, &mut i2c, 0x03);
    // DMAEN, LAST.
    bench.write(&mut i2c, CR2, 42 | 1 << 11 | 1 << 12);
    address(&mut bench, &mut i2c, DEVICE << 1 | 1, ACK);
    bench.read(&mut i2c, SR2);
    for left in (1..=6).rev() {
        bench.dma.set_last(DmaRequest::I2c3Rx, left == 1);
        let until = bench.now + MS;
        bench.run_while(&mut i2c, until, |b| !b.dma.get(DmaRequest::I2c3Rx));
        assert!(bench.dma.get(DmaRequest::I2c3Rx), "{left} left");
        bench.read(&mut i2c, DR);
    }
    // Nothing follows the refused byte; the bus waits for STOP.
    let until = bench.now + MS;
    bench.run(&mut i2c, until);
    assert_eq!(bench.read(&mut i2c, SR1), 0);
    assert_eq!(bench.read(&mut i2c, SR2) & 3, 3);
    bench.write(&mut i2c, CR1, PE | STOP);
    let until = bench.now + 5 * US;
    bench.run(&mut i2c, until);
    assert_eq!(bench.read(&mut i2c, SR2), 0);
}

#[test]
fn two_bytes_nobody_fetches_stretch_the_clock() {
    let (mut bench, mut i2c) = ready();
    point_at(&mut bench, &mut i2c, IDENTITY);
    address(&mut bench, &mut i2c, DEVICE << 1 | 1, ACK);
    bench.read(&mut i2c, SR2);
    let until = bench.now + MS;
    bench.run(&mut i2c, until);
    assert_eq!(bench.read(&mut i2c, SR1), RXNE | BTF);
    assert_eq!(bench.read(&mut i2c, DR), IDENTITY_VALUE);
    assert_eq!(bench.read(&mut i2c, SR1), RXNE);
}

#[test]
fn a_held_bus_stays_busy_and_start_waits_for_it() {
    let (mut bench, mut i2c) = ready();
    bench.board.i2c_held = true;
    assert_eq!(bench.read(&mut i2c, SR2), 2);
    bench.write(&mut i2c, CR1, PE | START);
    let until = bench.now + 10 * MS;
    bench.run(&mut i2c, until);
    assert_eq!(bench.read(&mut i2c, SR1), 0);
    bench.board.i2c_held = false;
    wait_for(&mut bench, &mut i2c, SB);
}

#[test]
fn the_event_interrupt_follows_its_flags() {
    let (mut bench, mut i2c) = ready();
    bench.write(&mut i2c, CR2, 42 | 1 << 9);
    bench.write(&mut i2c, CR1, PE | START);
    let until = bench.now + 10 * US;
    bench.run(&mut i2c, until);
    assert!(bench.irq.level(72));
    bench.read(&mut i2c, SR1);
    bench.write(&mut i2c, DR, DEVICE << 1);
    assert!(!bench.irq.level(72));
}

#[test]
fn wrong_wiring_and_a_wrong_clock_are_reported() {
    let (mut bench, mut i2c) = ready();
    bench.write(&mut i2c, CR2, 16);
    bench.change_pin(Pin::new('C', 9), |pin| pin.mode = PinMode::Input);
    address(&mut bench, &mut i2c, DEVICE << 1, 0);
    assert_eq!(bench.read(&mut i2c, SR1) & (ADDR | AF), AF);
    let texts = bench.error_texts();
    assert!(texts.iter().any(|e| e.starts_with("I2C3_SDA")));
    assert!(texts.contains(&"I2C3: CR2.FREQ says 16 MHz, pclk1 runs at 42 MHz"));
}

#[test]
fn a_push_pull_stage_on_the_bus_is_reported() {
    let (mut bench, mut i2c) = ready();
    bench.change_pin(Pin::new('A', 8), |pin| pin.open_drain = false);
    address(&mut bench, &mut i2c, DEVICE << 1, 0);
    assert_eq!(bench.read(&mut i2c, SR1) & (ADDR | AF), AF);
    let expected = "I2C3_SCL: PA8 is push-pull, needs open-drain: the device is not connected";
    assert_eq!(bench.error_texts(), [expected]);
}

#[test]
fn wrong_timing_is_reported() {
    let (mut bench, mut i2c) = ready();
    // 42 MHz / (3 × 34) = 411.8 kHz.
    bench.write(&mut i2c, CCR, 1 << 15 | 34);
    bench.write(&mut i2c, CR1, 0);
    bench.write(&mut i2c, TRISE, 43);
    bench.write(&mut i2c, CR1, PE | START);
    let expected = [
        "I2C3: CCR written while PE is 1: SCL is undefined",
        "I2C3: SCL at 411764 Hz, fast mode ends at 400000 Hz",
    ];
    assert_eq!(bench.error_texts(), expected);
    let rise_time = "I2C3: TRISE is 43, fast mode needs 13 for 300 ns";
    assert_eq!(bench.suspicion_texts(), [rise_time]);
}

/// As embassy-stm32 0.6 does where a transfer follows another at once.
#[test]
fn a_start_written_while_stop_is_pending_hangs_the_bus_until_a_reset() {
    let (mut bench, mut i2c) = ready();
    point_at(&mut bench, &mut i2c, IDENTITY);
    bench.write(&mut i2c, CR1, PE | STOP);
    let until = bench.now + 1_000_000;
    bench.run(&mut i2c, until);
    let cr1 = bench.read(&mut i2c, CR1);
    assert_eq!(cr1, PE | STOP);
    bench.write(&mut i2c, CR1, cr1 | START);
    let until = bench.now + MS;
    bench.run(&mut i2c, until);
    assert_eq!(bench.read(&mut i2c, SR1), 0, "no SB");
    let expected =
        "I2C3: CR1 written while STOP is pending: it cuts off the START, and the bus hangs";
    assert_eq!(bench.error_texts(), [expected]);
    bench.write(&mut i2c, CR1, 0);
    bench.write(&mut i2c, CR1, PE | START);
    wait_for(&mut bench, &mut i2c, SB);
}

#[test]
fn cr1_is_left_alone_until_start_and_stop_are_out() {
    let (mut bench, mut i2c) = ready();
    bench.write(&mut i2c, CR1, PE | START);
    bench.write(&mut i2c, CR1, PE | START | ACK);
    wait_for(&mut bench, &mut i2c, SB);
    bench.write(&mut i2c, CR1, PE | STOP);
    bench.write(&mut i2c, CR1, PE | STOP | ACK);
    let texts = bench.error_texts();
    assert!(texts[0].contains("START is pending: it may be sent twice"));
    assert!(texts[1].contains("STOP is pending: it may be sent twice"));
}

#[test]
fn a_software_reset_frees_the_bus() {
    let (mut bench, mut i2c) = ready();
    address(&mut bench, &mut i2c, DEVICE << 1, 0);
    bench.write(&mut i2c, CR1, 1 << 15);
    bench.write(&mut i2c, CR1, 0);
    assert_eq!(bench.read(&mut i2c, SR2), 0);
    assert_eq!(bench.read(&mut i2c, CCR), 0);
    i2c.reset(&mut bench.ctx());
    assert_eq!(bench.read(&mut i2c, TRISE), 2, "after reset");
}
