//! USART3 through its registers, with a sender on its line.

mod link;

use super::Usart;
use crate::{
    soc::{dma_request::DmaRequest, peripheral::Peripheral, test_bench::Bench},
    time::{MS, Ps, US},
    wire::{LineEvent, LineFormat, Parity, UartChar},
};

const SR: u32 = 0x00;
const DR: u32 = 0x04;
const BRR: u32 = 0x08;
const CR1: u32 = 0x0C;
const CR2: u32 = 0x10;
const CR3: u32 = 0x14;

const UE_RE: u32 = 1 << 13 | 1 << 2;
/// M, PCE.
const NINE_BITS_EVEN: u32 = 1 << 12 | 1 << 10;
const IDLEIE: u32 = 1 << 4;
const TWO_STOP: u32 = 2 << 12;

const SBUS: LineFormat = LineFormat {
    baud: 100_000,
    data_bits: 8,
    parity: Parity::Even,
    stop_bits: 2,
};

/// 42 MHz / 420 = 100 kbit/s.
fn configured(cr1: u32, cr2: u32) -> (Bench, Usart) {
    let (mut bench, mut usart) = (Bench::new(), Usart::new(3));
    bench.write(&mut usart, BRR, 420);
    bench.write(&mut usart, CR2, cr2);
    bench.write(&mut usart, CR1, cr1);
    (bench, usart)
}

/// A character of another sender, whose times the test chooses.
fn send(bench: &mut Bench, usart: &mut Usart, start: Ps, byte: u8) {
    bench.now = start;
    let character = UartChar {
        start,
        byte,
        format: SBUS,
    };
    usart.line_event(LineEvent::Character(character), &mut bench.ctx());
    usart.plan_reception(&mut bench.ctx());
}

/// Only the peripheral's own events: the board's sender stays out of it.
fn run_alone(bench: &mut Bench, usart: &mut Usart, until: Ps) {
    while let Some(event) = bench.scheduler.pop_due(until) {
        bench.now = event.at;
        usart.event(event.tag, &mut bench.ctx());
    }
    bench.now = until;
}

#[test]
fn reset_values_are_those_of_the_manual() {
    let (mut bench, mut usart) = (Bench::new(), Usart::new(3));
    // RM0090 30.6.1: TXE and TC.
    assert_eq!(bench.read(&mut usart, SR), 0xC0);
    assert_eq!(bench.read(&mut usart, CR1), 0);
}

#[test]
fn idle_comes_one_character_after_the_last_one_and_clears_by_sr_then_dr() {
    let (mut bench, mut usart) = configured(UE_RE | NINE_BITS_EVEN | IDLEIE, TWO_STOP);
    run_alone(&mut bench, &mut usart, MS);
    bench.read(&mut usart, SR);
    bench.read(&mut usart, DR);
    assert!(!bench.irq.level(39));
    send(&mut bench, &mut usart, MS, 0x42);
    // End of the first stop bit: 1 + 9 + 1 bits.
    run_alone(&mut bench, &mut usart, MS + 110 * US);
    assert_eq!(bench.read(&mut usart, SR) & 0x3F, 1 << 5);
    assert_eq!(bench.read(&mut usart, DR) & 0xFF, 0x42);
    // Twelve bits of character, twelve bits of silence.
    run_alone(&mut bench, &mut usart, MS + 240 * US - 1);
    assert!(!bench.irq.level(39));
    run_alone(&mut bench, &mut usart, MS + 240 * US);
    assert!(bench.irq.level(39));
    bench.read(&mut usart, DR);
    assert!(bench.irq.level(39), "DR alone clears nothing");
    bench.read(&mut usart, SR);
    bench.read(&mut usart, DR);
    assert!(!bench.irq.level(39));
    run_alone(&mut bench, &mut usart, 10 * MS);
    assert_eq!(
        bench.read(&mut usart, SR) & 1 << 4,
        0,
        "no second IDLE without a character"
    );
}

#[test]
fn a_character_not_fetched_in_time_keeps_dr_and_loses_the_next_one() {
    let (mut bench, mut usart) = configured(UE_RE | NINE_BITS_EVEN, TWO_STOP);
    send(&mut bench, &mut usart, MS, 0x11);
    run_alone(&mut bench, &mut usart, MS + 120 * US);
    send(&mut bench, &mut usart, MS + 120 * US, 0x22);
    run_alone(&mut bench, &mut usart, MS + 239 * US);
    // RXNE and ORE.
    assert_eq!(bench.read(&mut usart, SR) & 0x2F, 1 << 5 | 1 << 3);
    assert_eq!(bench.read(&mut usart, DR) & 0xFF, 0x11);
    assert_eq!(bench.read(&mut usart, SR) & 0x2F, 0);
}

#[test]
fn a_sender_at_8e2_gives_framing_errors_at_8n1_and_says_why() {
    let (mut bench, mut usart) = configured(UE_RE, 0);
    bench.run(&mut usart, 100 * MS);
    assert_ne!(bench.read(&mut usart, SR) & 1 << 1, 0, "FE");
    let expected = "USART3: sender sends 100000 8E2, receiver is set to 100000 8N1";
    assert!(bench.error_texts().iter().any(|e| e.starts_with(expected)));
}

#[test]
fn a_sender_at_even_parity_gives_parity_errors_at_odd_parity_and_says_why() {
    // PS.
    let (mut bench, mut usart) = configured(UE_RE | NINE_BITS_EVEN | 1 << 9, TWO_STOP);
    bench.run(&mut usart, 10 * MS);
    // PE without FE.
    assert_eq!(bench.read(&mut usart, SR) & 3, 1);
    let expected = "USART3: sender sends 100000 8E2, receiver is set to 100000 8O2";
    assert!(bench.error_texts().iter().any(|e| e.starts_with(expected)));
}

#[test]
fn a_character_written_over_another_is_reported() {
    let (mut bench, mut usart) = configured(1 << 13 | 1 << 3, 0);
    for byte in [1, 2] {
        bench.write(&mut usart, DR, byte);
    }
    assert_eq!(bench.error_texts(), Vec::<&str>::new());
    bench.write(&mut usart, DR, 3);
    assert!(bench.error_texts()[0].starts_with("USART3: DR written while TXE is 0"));
}

#[test]
fn a_burst_arrives_whole_where_the_framing_fits() {
    let (mut bench, mut usart) = configured(UE_RE | NINE_BITS_EVEN, TWO_STOP);
    let mut bytes = Vec::new();
    while bytes.len() < 50 && bench.now < 100 * MS {
        let until = bench.now + 20 * US;
        bench.run(&mut usart, until);
        if bench.read(&mut usart, SR) & 1 << 5 != 0 {
            bytes.push(bench.read(&mut usart, DR) as u8);
        }
    }
    // 25 bytes from 0x0F to 0x00.
    assert_eq!(
        (bytes[0], bytes[24], bytes[25], bytes[49]),
        (0x0F, 0x00, 0x0F, 0x00)
    );
    assert_eq!(bench.error_texts(), Vec::<&str>::new());
}

#[test]
fn a_wrong_clock_is_a_wrong_baud_rate() {
    let (mut bench, mut usart) = configured(UE_RE | NINE_BITS_EVEN, TWO_STOP);
    bench.clocks.pclk1_hz = 16_000_000;
    usart.clocks_changed(&mut bench.ctx());
    bench.run(&mut usart, 50 * MS);
    assert!(
        bench
            .error_texts()
            .iter()
            .any(|e| e.contains("receiver is set to 38095 8E2"))
    );
}

#[test]
fn dma_requests_follow_rxne_and_txe() {
    let (mut bench, mut usart) = configured(UE_RE | NINE_BITS_EVEN | 1 << 3, TWO_STOP);
    bench.write(&mut usart, CR3, 1 << 6 | 1 << 7);
    assert!(bench.dma.get(DmaRequest::Usart3Tx));
    assert!(!bench.dma.get(DmaRequest::Usart3Rx));
    send(&mut bench, &mut usart, MS, 0x5A);
    run_alone(&mut bench, &mut usart, MS + 110 * US);
    assert!(bench.dma.get(DmaRequest::Usart3Rx));
    bench.read(&mut usart, DR);
    assert!(!bench.dma.get(DmaRequest::Usart3Rx));
}

#[test]
fn transmission_complete_comes_a_character_after_the_last_byte_left_dr() {
    let (mut bench, mut usart) = configured(1 << 13 | 1 << 3, 0);
    bench.read(&mut usart, SR);
    bench.write(&mut usart, DR, 0x55);
    bench.write(&mut usart, DR, 0xAA);
    // One in the shift register, one in DR: neither TXE nor TC.
    assert_eq!(bench.read(&mut usart, SR) & 0xC0, 0);
    run_alone(&mut bench, &mut usart, 100 * US);
    assert_eq!(bench.read(&mut usart, SR) & 0xC0, 1 << 7);
    run_alone(&mut bench, &mut usart, 200 * US);
    assert_eq!(bench.read(&mut usart, SR) & 0xC0, 0xC0);
}
