//! Both buses through the controllers' registers, with the nodes of the test board.

use crate::{
    soc::{
        can::Can,
        peripheral::Peripheral,
        pins::{Pin, PinMode},
        test_bench::Bench,
    },
    time::{MS, Ps, US},
};

const CAN1: u32 = 0;
const CAN2: u32 = 0x400;

const MCR: u32 = 0x00;
const MSR: u32 = 0x04;
const TSR: u32 = 0x08;
const IER: u32 = 0x14;
const ESR: u32 = 0x18;
const BTR: u32 = 0x1C;
const INAK: u32 = 1;
const INRQ: u32 = 1;
/// 42 MHz / 3 / (1 + 10 + 3) = 1 Mbit/s.
const ONE_MEGABIT: u32 = 0x0029_0002;

/// Init handshake, timing, back to normal mode; filters let all standard frames into FIFO 0.
fn enable(bench: &mut Bench, can: &mut Can, base: u32, btr: u32) {
    bench.write(can, base + MCR, INRQ);
    assert_eq!(bench.read(can, base + MSR) & 3, INAK);
    bench.write(can, base + BTR, btr);
    // Banks 0 and 14 as 32-bit masks of zeros; CAN2's banks start at 14.
    bench.write(can, 0x20C, 1 | 1 << 14);
    bench.write(can, 0x21C, 1 | 1 << 14);
    bench.write(can, 0x200, 14 << 8);
    bench.write(can, base + MCR, 0);
}

/// 0x200 with the payload whose length `frame_bits` tests: 119 bits.
fn request_wheel_command(bench: &mut Bench, can: &mut Can, base: u32) {
    bench.write(can, base + 0x184, 8);
    bench.write(
        can,
        base + 0x188,
        u32::from_le_bytes([0x12, 0x34, 0xFE, 0xDC]),
    );
    bench.write(can, base + 0x18C, 0);
    bench.write(can, base + 0x180, 0x200 << 21 | 1);
}

fn run_for(bench: &mut Bench, can: &mut Can, time: Ps) {
    let until = bench.now + time;
    bench.run(can, until);
}

fn ready(base: u32) -> (Bench, Can) {
    let (mut bench, mut can) = (Bench::new(), Can::new());
    enable(&mut bench, &mut can, base, ONE_MEGABIT);
    run_for(&mut bench, &mut can, 12 * US);
    assert_eq!(bench.read(&mut can, base + MSR) & 3, 0);
    (bench, can)
}

#[test]
fn a_controller_joins_after_eleven_recessive_bits() {
    let (mut bench, mut can) = (Bench::new(), Can::new());
    enable(&mut bench, &mut can, CAN2, ONE_MEGABIT);
    run_for(&mut bench, &mut can, 11 * US - 1);
    assert_eq!(bench.read(&mut can, CAN2 + MSR) & 3, INAK);
    run_for(&mut bench, &mut can, 1);
    assert_eq!(bench.read(&mut can, CAN2 + MSR) & 3, 0);
}

#[test]
fn a_frame_going_on_keeps_a_controller_from_joining() {
    let (mut bench, mut can) = (Bench::new(), Can::new());
    let busy = |bench: &mut Bench, can: &mut Can| {
        let until = bench.now + 5 * MS;
        let before = can.stats(0).busy;
        while can.stats(0).busy == before && bench.now < until {
            run_for(bench, can, US);
        }
    };
    busy(&mut bench, &mut can);
    // A feedback frame of more than 100 µs has just begun.
    enable(&mut bench, &mut can, CAN1, ONE_MEGABIT);
    run_for(&mut bench, &mut can, 100 * US);
    assert_eq!(bench.read(&mut can, MSR) & 3, INAK);
    run_for(&mut bench, &mut can, 300 * US);
    assert_eq!(bench.read(&mut can, MSR) & 3, 0);
    assert_eq!(bench.read(&mut can, ESR), 0);
}

#[test]
fn a_frame_takes_its_bits_and_raises_the_transmit_interrupt() {
    let (mut bench, mut can) = ready(CAN2);
    bench.write(&mut can, CAN2 + IER, 1);
    request_wheel_command(&mut bench, &mut can, CAN2);
    run_for(&mut bench, &mut can, 119 * US - 1);
    assert_eq!(bench.read(&mut can, CAN2 + TSR) & 0xFF, 0);
    assert!(!bench.irq.level(63));
    run_for(&mut bench, &mut can, 1);
    // RQCP0, TXOK0.
    assert_eq!(bench.read(&mut can, CAN2 + TSR) & 0xFF, 3);
    assert!(bench.irq.level(63));
    bench.write(&mut can, CAN2 + TSR, 1);
    assert!(!bench.irq.level(63));
    run_for(&mut bench, &mut can, MS);
    let stats = can.stats(1);
    assert_eq!((stats.tx, stats.errors, stats.busy), (1, 0, 122 * US));
}

#[test]
fn feedback_fills_the_fifo_and_overruns_it() {
    let (mut bench, mut can) = ready(CAN1);
    bench.write(&mut can, CAN1 + IER, 2);
    run_for(&mut bench, &mut can, 10 * MS);
    // FMP0 = 3, FULL0, FOVR0.
    assert_eq!(bench.read(&mut can, 0x0C), 3 | 1 << 3 | 1 << 4);
    assert!(bench.irq.level(20));
    let id = bench.read(&mut can, 0x1B0) >> 21;
    assert!(id == 0x201 || id == 0x202, "{id:#x}");
    assert_eq!(bench.read(&mut can, 0x1B4) & 0xF, 8);
    for _ in 0..3 {
        bench.write(&mut can, 0x0C, 1 << 5);
    }
    assert!(!bench.irq.level(20));
    // Two controllers at 1 kHz each.
    assert!((18..=21).contains(&can.stats(0).rx), "{}", can.stats(0).rx);
}

#[test]
fn alone_on_the_bus_it_repeats_until_somebody_acknowledges() {
    let (mut bench, mut can) = ready(CAN2);
    bench.board.can[1].empty = true;
    request_wheel_command(&mut bench, &mut can, CAN2);
    run_for(&mut bench, &mut can, 10 * MS);
    // TEC stands at 128: error warning and passive, acknowledgement error, never bus-off.
    assert_eq!(bench.read(&mut can, CAN2 + ESR), 128 << 16 | 3 << 4 | 0b011);
    assert_eq!(bench.read(&mut can, CAN2 + TSR) & 0xFF, 0);
    bench.board.can[1].empty = false;
    run_for(&mut bench, &mut can, MS);
    assert_eq!(bench.read(&mut can, CAN2 + TSR) & 0xFF, 3);
    assert_eq!(bench.read(&mut can, CAN2 + ESR) >> 16, 127);
}

#[test]
fn a_shorted_bus_leads_to_bus_off_and_back_after_128_times_11_bits() {
    let (mut bench, mut can) = ready(CAN2);
    bench.board.can[1].broken = true;
    request_wheel_command(&mut bench, &mut can, CAN2);
    run_for(&mut bench, &mut can, 2 * MS);
    assert_eq!(bench.read(&mut can, CAN2 + ESR) & 7, 7);
    bench.board.can[1].broken = false;
    // ABOM is 0, so it stays off until software requests a recovery.
    run_for(&mut bench, &mut can, 5 * MS);
    assert_eq!(bench.read(&mut can, CAN2 + ESR) & 7, 7);
    bench.write(&mut can, CAN2 + MCR, INRQ);
    assert_eq!(bench.read(&mut can, CAN2 + MSR) & INAK, INAK);
    bench.write(&mut can, CAN2 + MCR, 0);
    run_for(&mut bench, &mut can, (11 + 1408) * US - 1);
    assert_eq!(bench.read(&mut can, CAN2 + ESR) & 4, 4);
    run_for(&mut bench, &mut can, 200 * US);
    assert_eq!(bench.read(&mut can, CAN2 + ESR) & 7, 0);
    // The request is still pending afterwards.
    assert_eq!(bench.read(&mut can, CAN2 + TSR) & 0xFF, 3);
}

#[test]
fn half_the_bit_rate_destroys_the_traffic_and_is_reported() {
    let (mut bench, mut can) = (Bench::new(), Can::new());
    enable(&mut bench, &mut can, CAN1, 0x0029_0005);
    run_for(&mut bench, &mut can, 20 * MS);
    assert!(
        bench
            .error_texts()
            .contains(&"CAN1: 500000 bit/s on a 1000000 bit/s bus")
    );
    assert_eq!(can.stats(0).rx, 0);
    assert!(can.stats(0).errors > 10);
    assert_ne!(bench.read(&mut can, ESR) >> 24, 0);
}

#[test]
fn a_node_with_a_lower_identifier_keeps_the_bus() {
    let (mut bench, mut can) = ready(CAN2);
    bench.board.can[1].flooded = true;
    run_for(&mut bench, &mut can, MS);
    request_wheel_command(&mut bench, &mut can, CAN2);
    run_for(&mut bench, &mut can, 5 * MS);
    assert_eq!(bench.read(&mut can, CAN2 + TSR) & 0xFF, 0);
    bench.board.can[1].flooded = false;
    run_for(&mut bench, &mut can, MS);
    assert_eq!(bench.read(&mut can, CAN2 + TSR) & 0xFF, 3);
}

#[test]
fn without_its_pins_a_controller_neither_joins_nor_drives_the_bus() {
    let (mut bench, mut can) = (Bench::new(), Can::new());
    bench.change_pin(Pin::new('D', 0), |pin| pin.mode = PinMode::Input);
    enable(&mut bench, &mut can, CAN1, ONE_MEGABIT);
    run_for(&mut bench, &mut can, 10 * MS);
    assert_eq!(bench.read(&mut can, MSR) & 3, INAK);
    assert!(bench.error_texts().iter().any(|e| e.starts_with("CAN1_RX")));

    let (mut bench, mut can) = ready(CAN2);
    bench.change_pin(Pin::new('B', 6), |pin| pin.mode = PinMode::Alternate(0));
    request_wheel_command(&mut bench, &mut can, CAN2);
    run_for(&mut bench, &mut can, 5 * MS);
    assert!(bench.error_texts().iter().any(|e| e.starts_with("CAN2_TX")));
    assert_eq!(bench.read(&mut can, CAN2 + ESR) & 4, 4);
}

#[test]
fn a_reset_silences_a_frame_on_the_bus() {
    let (mut bench, mut can) = ready(CAN2);
    request_wheel_command(&mut bench, &mut can, CAN2);
    run_for(&mut bench, &mut can, 50 * US);
    can.reset(&mut bench.ctx());
    run_for(&mut bench, &mut can, MS);
    assert_eq!(can.stats(1).tx, 0);
    // RM0090 32.9.2: MCR 0x0001_0002, MSR 0x0000_0C02.
    assert_eq!(bench.read(&mut can, CAN2 + MCR), 0x0001_0002);
    assert_eq!(bench.read(&mut can, CAN2 + MSR), 0x0000_0C02);
}

#[test]
fn a_short_in_the_middle_of_a_frame_spoils_it() {
    let (mut bench, mut can) = ready(CAN2);
    request_wheel_command(&mut bench, &mut can, CAN2);
    run_for(&mut bench, &mut can, 50 * US);
    bench.board.can[1].broken = true;
    run_for(&mut bench, &mut can, 80 * US);
    assert_eq!(can.stats(1).tx, 0);
    // Bit dominant error, TEC = 8.
    assert_eq!(bench.read(&mut can, CAN2 + ESR), 8 << 16 | 5 << 4);
}

#[test]
fn without_automatic_retransmission_one_failure_ends_the_request() {
    let (mut bench, mut can) = ready(CAN2);
    bench.write(&mut can, CAN2 + MCR, 1 << 4);
    bench.board.can[1].empty = true;
    request_wheel_command(&mut bench, &mut can, CAN2);
    run_for(&mut bench, &mut can, MS);
    // RQCP0 and TERR0, no TXOK0; mailbox 0 is empty again.
    assert_eq!(
        bench.read(&mut can, CAN2 + TSR) & (0xFF | 1 << 26),
        0b1001 | 1 << 26
    );
    assert_eq!(can.stats(1).errors, 1);
}

#[test]
fn a_frame_on_the_bus_wakes_a_sleeping_controller_that_asked_for_it() {
    let (mut bench, mut can) = (Bench::new(), Can::new());
    enable(&mut bench, &mut can, CAN1, ONE_MEGABIT);
    // SLEEP and AWUM, WKUIE.
    bench.write(&mut can, MCR, 1 << 1 | 1 << 5);
    bench.write(&mut can, IER, 1 << 16);
    assert_eq!(bench.read(&mut can, MSR) & 3, 2);
    run_for(&mut bench, &mut can, 3 * MS);
    assert!(bench.irq.level(22));
    assert_eq!(bench.read(&mut can, MSR) & (1 << 3 | 3), 1 << 3);
    bench.write(&mut can, MSR, 1 << 3);
    assert!(!bench.irq.level(22));
}

#[test]
fn bus_off_recovers_by_itself_where_abom_is_set_and_interrupts() {
    let (mut bench, mut can) = ready(CAN2);
    bench.write(&mut can, CAN2 + MCR, 1 << 6);
    // ERRIE, BOFIE.
    bench.write(&mut can, CAN2 + IER, 1 << 15 | 1 << 10);
    bench.board.can[1].broken = true;
    request_wheel_command(&mut bench, &mut can, CAN2);
    let until = bench.now + 2 * MS;
    bench.run_while(&mut can, until, |b| !b.irq.level(66));
    assert!(bench.irq.level(66));
    assert_eq!(bench.read(&mut can, CAN2 + ESR) & 4, 4);
    bench.board.can[1].broken = false;
    // 1408 recessive bits, then the waiting frame.
    run_for(&mut bench, &mut can, 1400 * US);
    assert_eq!(bench.read(&mut can, CAN2 + ESR) & 4, 4);
    run_for(&mut bench, &mut can, 200 * US);
    assert_eq!(bench.read(&mut can, CAN2 + ESR) & 4, 0);
    assert_eq!(can.stats(1).tx, 1);
}
