//! USART1 with DMA both ways, as the PC link uses it.

use crate::{
    time::{MS, Ps, US},
    wire::{LineEvent, LineFormat, Parity, UartChar},
};

use super::*;

const USART1: u32 = 0x4001_1000;
const GPIOA: u32 = 0x4002_0000;
const GPIOB: u32 = 0x4002_0400;
const DMA2: u32 = 0x4002_6400;
/// SRAM of what is sent and of what is received.
const OUT: u32 = 0x2000_1000;
const RING: u32 = 0x2000_2000;
/// Channel 4, memory increment, enabled; memory to peripheral, or circular.
const SEND: u32 = 4 << 25 | 1 << 10 | 1 << 6 | 1;
const RECEIVE: u32 = 4 << 25 | 1 << 10 | 1 << 8 | 1;

const PC: LineFormat = LineFormat {
    baud: 460_800,
    data_bits: 8,
    parity: Parity::None,
    stop_bits: 1,
};

/// 460,800 Bd on PA9 and PB7, DMA requests both ways.
fn link() -> Bench {
    let mut bench = Bench::new();
    bench.clock_up();
    bench.set_bits(AHB1ENR, 1 | 1 << 1 | 1 << 22);
    bench.set_bits(APB2ENR, 1 << 4);
    bench.set_bits(GPIOA, 0b10 << 18);
    bench.set_bits(GPIOA + 0x24, 7 << 4);
    bench.set_bits(GPIOB, 0b10 << 14);
    bench.set_bits(GPIOB + 0x20, 7 << 28);
    bench.write(USART1 + 0x08, 182);
    bench.write(USART1 + 0x14, 1 << 6 | 1 << 7);
    bench.write(USART1 + 0x0C, 1 << 13 | 1 << 3 | 1 << 2);
    bench
}

fn start_stream(bench: &mut Bench, stream: u32, memory: u32, items: u32, cr: u32) {
    let registers = DMA2 + 0x10 + stream * 0x18;
    bench.write(registers + 0x08, USART1 + 0x04);
    bench.write(registers + 0x0C, memory);
    bench.write(registers + 0x04, items);
    bench.write(registers, cr);
}

fn board(bench: &mut Bench) -> &mut TestBoard {
    bench.soc.board_as().expect("the test board")
}

/// What the board has heard.
fn sent(bench: &mut Bench) -> Vec<u8> {
    let sent = board(bench).sent.iter();
    sent.map(|(_, character, _)| character.byte).collect()
}

fn line_up(bench: &mut Bench, from: Ps, bytes: impl Iterator<Item = u8>) {
    let events = bytes.zip(0..).map(|(byte, n)| {
        LineEvent::Character(UartChar {
            start: from + n * PC.char_time(),
            byte,
            format: PC,
        })
    });
    board(bench).line.extend(events);
}

/// 94 characters of ten bits at 461,538 Bd take 2.037 ms.
#[test]
fn a_frame_leaves_without_a_gap() {
    let mut bench = link();
    let frame: Vec<u8> = (0..94_u8).map(|n| n.wrapping_mul(7)).collect();
    bench.ram.at(OUT, 94).expect("SRAM").copy_from_slice(&frame);
    let start = bench.now;
    start_stream(&mut bench, 7, OUT, 94, SEND);
    bench.run_until(start + 2_036 * US);
    assert_eq!(sent(&mut bench).len(), 93);
    bench.run_until(start + 2_037 * US);
    assert_eq!(sent(&mut bench), frame);
    // TCIF7 of HISR since the last byte went into DR; TC.
    assert_eq!(bench.read(DMA2 + 0x04) >> 27 & 1, 1);
    assert_eq!(bench.read(USART1) >> 6 & 1, 1);
    assert_eq!(bench.errors(), Vec::<&str>::new());
}

#[test]
fn both_directions_run_at_full_rate() {
    let mut bench = link();
    let start = bench.now;
    start_stream(&mut bench, 7, OUT, 94, SEND);
    start_stream(&mut bench, 5, RING, 256, RECEIVE);
    line_up(&mut bench, start, 0..=255);
    bench.run_for(6 * MS);
    let expected: Vec<u8> = (0..=255).collect();
    assert_eq!(bench.ram.at(RING, 256).expect("SRAM"), expected);
    assert_eq!(sent(&mut bench).len(), 94);
    assert_eq!(bench.errors(), Vec::<&str>::new());
}

#[test]
fn nothing_is_sent_from_ccm() {
    let mut bench = link();
    start_stream(&mut bench, 7, 0x1000_0100, 94, SEND);
    bench.run_for(3 * MS);
    assert!(bench.has_error("DMA2 stream 7 (USART1_TX): memory address 0x10000100 is in CCM"));
    assert!(sent(&mut bench).is_empty());
}

/// Stream 6 serves USART6_TX, on channel 5.
#[test]
fn a_stream_that_usart1_does_not_have_is_named() {
    let mut bench = link();
    start_stream(&mut bench, 6, OUT, 94, SEND);
    bench.run_for(3 * MS);
    let expected = "USART1_TX requests on DMA2 stream 7 channel 4, which is not enabled";
    assert!(bench.has_error(expected), "{:?}", bench.errors());
    assert!(sent(&mut bench).is_empty());
    start_stream(&mut bench, 4, RING, 64, RECEIVE);
    let now = bench.now;
    line_up(&mut bench, now, 0..4);
    bench.run_for(3 * MS);
    assert!(bench.has_error(
        "USART1_RX requests on DMA2 stream 2 channel 4, which is not enabled; or DMA2 stream 5 channel 4"
    ));
}
