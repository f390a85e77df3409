//! USART1 both ways: characters, settings that differ from the other end's, and lines that are disturbed.

use super::*;
use crate::{
    soc::pins::{ExternalConnection, Pin, PinMode, Pull},
    time::{NS, SECOND},
    wire::UartPort,
};

const TE: u32 = 1 << 3;
const UE: u32 = 1 << 13;
const RX: Pin = Pin::new('B', 7);
const TX: Pin = Pin::new('A', 9);
const FE: u32 = 1 << 1;
const NE: u32 = 1 << 2;
const IDLE: u32 = 1 << 4;
const RXNE: u32 = 1 << 5;

const PC: LineFormat = LineFormat {
    baud: 460_800,
    data_bits: 8,
    parity: Parity::None,
    stop_bits: 1,
};
const BIT: Ps = SECOND / 460_800;
/// A bit of the chip: 84 MHz / 182 are 461,538 Bd.
const OWN_BIT: Ps = 182 * SECOND / 84_000_000;

fn link(brr: u32) -> (Bench, Usart) {
    let (mut bench, mut usart) = (Bench::new(), Usart::new(1));
    bench.write(&mut usart, BRR, brr);
    bench.write(&mut usart, CR1, UE_RE | TE);
    (bench, usart)
}

fn character(start: Ps, byte: u8) -> LineEvent {
    LineEvent::Character(UartChar {
        start,
        byte,
        format: PC,
    })
}

/// SR and DR, as a driver reads them.
fn received(bench: &mut Bench, usart: &mut Usart) -> (u32, u8) {
    let flags = bench.read(usart, SR) & 0x3F;
    (flags, bench.read(usart, DR) as u8)
}

#[test]
fn characters_reach_the_board_with_the_format_of_the_registers() {
    let (mut bench, mut usart) = link(182);
    bench.run(&mut usart, MS);
    for byte in [0xFE, 0x00] {
        bench.write(&mut usart, DR, byte);
    }
    bench.run(&mut usart, 2 * MS);
    let sent: Vec<_> = bench.board.sent.iter().map(|s| (s.0, s.1.byte)).collect();
    assert_eq!(sent, [(UartPort::Usart1, 0xFE), (UartPort::Usart1, 0x00)]);
    let [(_, first, first_end), (_, second, second_end)] = bench.board.sent[..] else {
        panic!("two characters");
    };
    assert_eq!(first.format.to_string(), "461538 8N1");
    // One after the other, each delivered at the end of its stop bit.
    let near = |is: Ps, wanted: Ps| assert!(is.abs_diff(wanted) < NS, "{is}, not {wanted}");
    assert_eq!((first.start, second.start), (MS, first_end));
    near(first_end, MS + 10 * OWN_BIT);
    near(second_end, MS + 20 * OWN_BIT);
    assert_eq!(bench.error_texts(), Vec::<&str>::new());
}

/// 9-bit word with odd parity, two stop bits, 84 MHz / 8 / 21 = 500,000 Bd with OVER8.
#[test]
fn the_format_that_is_sent_follows_the_registers() {
    let (mut bench, mut usart) = (Bench::new(), Usart::new(1));
    bench.write(&mut usart, BRR, 21 << 4);
    bench.write(&mut usart, CR2, TWO_STOP);
    bench.write(&mut usart, CR1, UE | TE | NINE_BITS_EVEN | 1 << 9 | 1 << 15);
    bench.write(&mut usart, DR, 0x55);
    bench.run(&mut usart, MS);
    assert_eq!(bench.board.sent[0].1.format.to_string(), "500000 8O2");
}

#[test]
fn a_character_on_a_pin_of_another_function_is_not_heard() {
    let (mut bench, mut usart) = link(182);
    for (mode, expected) in [
        (PinMode::Input, "USART1_TX: PA9 is an input, needs AF7"),
        (PinMode::Alternate(8), "USART1_TX: PA9 is AF8, needs AF7"),
    ] {
        bench.change_pin(TX, |pin| pin.mode = mode);
        bench.write(&mut usart, DR, 0x55);
        let until = bench.now + MS;
        bench.run(&mut usart, until);
        let last = bench.error_texts().pop().expect("an error");
        assert!(last.starts_with(expected), "{last}");
    }
    assert!(bench.board.sent.is_empty());
    assert_ne!(bench.read(&mut usart, SR) & 1 << 6, 0, "TC all the same");
}

#[test]
fn a_character_cut_off_by_te_is_lost_and_reported() {
    let (mut bench, mut usart) = link(182);
    bench.write(&mut usart, DR, 0x55);
    bench.run(&mut usart, 10 * US);
    bench.write(&mut usart, CR1, UE_RE);
    bench.run(&mut usart, MS);
    assert!(bench.error_texts()[0].starts_with("USART1: TE cleared while"));
    assert!(bench.board.sent.is_empty());
}

#[test]
fn characters_of_the_other_end_are_received_at_full_rate() {
    let (mut bench, mut usart) = link(182);
    let start = MS;
    let bytes: Vec<u8> = (0..=255).collect();
    let events = bytes.iter().zip(0..);
    bench.board.line = events
        .map(|(byte, n): (_, Ps)| character(start + n * 10 * BIT, *byte))
        .collect();
    let mut got = Vec::new();
    while bench.now < 8 * MS {
        let until = bench.now + 5 * US;
        bench.run(&mut usart, until);
        if bench.read(&mut usart, SR) & RXNE != 0 {
            got.push(received(&mut bench, &mut usart));
        }
    }
    let clean: Vec<_> = bytes.iter().map(|byte| (RXNE, *byte)).collect();
    let flagged: Vec<_> = got.iter().map(|(f, b)| (f & !IDLE, *b)).collect();
    assert_eq!(flagged, clean);
    assert_eq!(bench.error_texts(), Vec::<&str>::new());
}

/// 84 MHz / 168 = 500,000 Bd.
#[test]
fn a_rate_that_differs_from_the_other_ends_is_reported() {
    let (mut bench, mut usart) = link(168);
    bench.board.line.push_back(character(MS, 0x55));
    bench.run(&mut usart, 2 * MS);
    let expected = "USART1: sender sends 460800 8N1, receiver is set to 500000 8N1";
    assert!(bench.error_texts()[0].starts_with(expected));
}

/// The firmware took PA10, which the board routes elsewhere.
#[test]
fn a_receiver_without_its_pin_is_reported_though_nobody_sends() {
    let (mut bench, mut usart) = link(182);
    bench.change_pin(RX, |pin| pin.mode = PinMode::Input);
    bench.run(&mut usart, MS - 1);
    assert_eq!(bench.error_texts(), Vec::<&str>::new());
    bench.run(&mut usart, MS);
    let expected = "USART1_RX: PB7 is an input, needs AF7";
    assert!(bench.error_texts()[0].starts_with(expected));
    bench.board.line.push_back(character(2 * MS, 0x55));
    bench.run(&mut usart, 3 * MS);
    assert_eq!(bench.read(&mut usart, SR) & RXNE, 0);
}

#[test]
fn an_input_that_floats_is_suspicious_unless_it_is_pulled_up() {
    for (pull, doubts) in [(Pull::None, 1), (Pull::Up, 0)] {
        let (mut bench, mut usart) = link(182);
        bench.pins.connect(RX, ExternalConnection::Nothing);
        bench.change_pin(RX, |pin| pin.pull = pull);
        bench.run(&mut usart, 2 * MS);
        let texts = bench.suspicion_texts();
        assert_eq!(texts.len(), doubts);
        assert!(texts.iter().all(|t| t.starts_with("USART1_RX: PB7 floats")));
    }
}

/// RM0090 30.3.3: a break is a framing error with a data register of 0, and no further start edge comes before its end.
#[test]
fn a_line_held_low_is_one_character_with_a_framing_error() {
    let (mut bench, mut usart) = link(182);
    let released = MS + 500 * US;
    bench.board.line.extend([
        LineEvent::Low {
            from: MS,
            until: released,
        },
        character(released + 100 * US, 0x42),
    ]);
    bench.run(&mut usart, MS);
    received(&mut bench, &mut usart);
    bench.run(&mut usart, released - 1);
    assert_eq!(received(&mut bench, &mut usart), (RXNE | FE, 0));
    // Idle only after a character's time of high level.
    bench.run(&mut usart, released + 10 * OWN_BIT - 10 * NS);
    assert_eq!(bench.read(&mut usart, SR) & (RXNE | IDLE), 0);
    bench.run(&mut usart, released + 10 * OWN_BIT + 10 * NS);
    assert_eq!(received(&mut bench, &mut usart).0, IDLE);
    bench.run(&mut usart, released + 200 * US);
    let (flags, byte) = received(&mut bench, &mut usart);
    assert_eq!((flags & !IDLE, byte), (RXNE, 0x42));
    assert_eq!(bench.error_texts(), Vec::<&str>::new());
}

/// A third of a bit is not a start bit; inside a character it is noise, and the majority of three samples decides.
#[test]
fn glitches_are_no_characters_but_noise() {
    let (mut bench, mut usart) = link(182);
    let glitch = |from: Ps, length: Ps| LineEvent::Low {
        from,
        until: from + length,
    };
    // Bits of 0xFF are high; the first of the three samples falls 1/32 before the middle of a bit, 68 ns.
    let middle = 2 * MS + 4 * OWN_BIT + OWN_BIT / 2;
    bench.board.line.extend([
        glitch(MS, BIT / 3),
        character(2 * MS, 0xFF),
        glitch(middle - 90 * NS, 60 * NS),
    ]);
    bench.run(&mut usart, 2 * MS - 1);
    assert_eq!(bench.read(&mut usart, SR) & RXNE, 0);
    received(&mut bench, &mut usart);
    bench.run(&mut usart, 3 * MS);
    let (flags, byte) = received(&mut bench, &mut usart);
    assert_eq!((flags & !IDLE, byte), (RXNE | NE, 0xFF));
}

#[test]
fn a_glitch_after_a_character_does_not_take_its_idle_line_away() {
    let (mut bench, mut usart) = link(182);
    bench.run(&mut usart, MS);
    received(&mut bench, &mut usart);
    bench.board.line.extend([
        character(MS, 0x42),
        LineEvent::Low {
            from: MS + 15 * BIT,
            until: MS + 15 * BIT + BIT / 3,
        },
    ]);
    bench.run(&mut usart, MS + 30 * BIT);
    assert_eq!(received(&mut bench, &mut usart), (RXNE | IDLE, 0x42));
}

#[test]
fn usart6_sends_as_usart1_does() {
    let (mut bench, mut usart) = (Bench::new(), Usart::new(6));
    bench.write(&mut usart, BRR, 182);
    bench.write(&mut usart, CR1, UE | TE);
    bench.write(&mut usart, DR, 0x55);
    bench.run(&mut usart, MS);
    // The test board does not route it.
    assert!(bench.board.sent.is_empty());
    assert_ne!(bench.read(&mut usart, SR) & 1 << 6, 0);
}
