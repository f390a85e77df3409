//! The SBUS receiver on streams that no radio should send, judged from the specification (docs/hardware.md#sbus),
//! written here without the parser's own code.

use proptest::prelude::*;
use robot_app::input::{DbusParser, SbusFrame, SbusParser};
use robot_test_support::Random;

const FRAME_LEN: usize = 25;
/// 12 bit at 100 kbaud.
const BYTE_US: u64 = 120;

/// Footers of SBUS and SBUS2, and that of the Futaba R7003SB (bolderflight/sbus#79).
const FOOTERS: [u8; 6] = [0x00, 0x04, 0x14, 0x24, 0x34, 0x08];

/// Decodes 25 bytes by the specification: channels, frame-lost flag and failsafe flag. `None` if they are not a frame.
/// After silence on the line they are framed, and makers use arbitrary values in the last one. The next frame's header in that place means that a byte is missing.
fn specified(bytes: &[u8], after_silence: bool) -> Option<([u16; 16], bool, bool)> {
    let ends = FOOTERS.contains(&bytes[24]) || after_silence && bytes[24] != 0x0F;
    if bytes[0] != 0x0F || !ends {
        return None;
    }
    let bit = |index: usize| u16::from(bytes[1 + index / 8] >> (index % 8) & 1);
    let channels = std::array::from_fn(|channel| {
        (0..11).fold(0, |value, place| value | bit(channel * 11 + place) << place)
    });
    Some((channels, bytes[23] & 4 != 0, bytes[23] & 8 != 0))
}

fn random_frame(random: &mut Random) -> [u8; FRAME_LEN] {
    let mut frame = [0; FRAME_LEN];
    frame.fill_with(|| random.byte());
    frame[0] = 0x0F;
    frame[23] &= 0x0F;
    frame[24] = FOOTERS[random.below(6)];
    frame
}

/// Random bytes, good frames and damaged frames, without end.
fn append_mutated(stream: &mut Vec<u8>, random: &mut Random) {
    match random.below(4) {
        0 => stream.extend((0..random.below(80)).map(|_| random.byte())),
        1 => stream.extend(random_frame(random)),
        2 => {
            let mut frame = random_frame(random);
            let at = random.below(FRAME_LEN);
            frame[at] ^= 1 << random.below(8);
            stream.extend(frame);
        }
        _ => {
            let frame = random_frame(random);
            let cut = random.below(FRAME_LEN);
            stream.extend(&frame[..cut]);
        }
    }
}

/// Every delivered frame must be 25 bytes in a row, ending where it was delivered, that the specification accepts, and
/// no two may share a byte.
#[test]
fn ten_million_bytes_without_a_frame_that_the_specification_rejects() {
    let mut random = Random::new(0x5B05);
    let mut parser = SbusParser::new();
    let (mut stream, mut now_us, mut total, mut delivered) = (Vec::new(), 0, 0usize, 0usize);
    while total < 10_000_000 {
        stream.clear();
        while stream.len() < 4_096 {
            append_mutated(&mut stream, &mut random);
        }
        let mut free_from = 0;
        let mut silent_before = 0;
        for end in 1..=stream.len() {
            // The line is silent from time to time.
            now_us += match random.below(40) {
                0 => {
                    silent_before = end - 1;
                    4_000
                }
                _ => BYTE_US,
            };
            parser.feed(&stream[end - 1..end], now_us, |frame: SbusFrame| {
                let start = end.checked_sub(FRAME_LEN).expect("25 bytes came first");
                assert!(start >= free_from, "two frames share bytes");
                free_from = end;
                let (channels, lost, failsafe) =
                    specified(&stream[start..end], start == silent_before)
                        .expect("the specification accepts it");
                assert_eq!(frame.channels, channels);
                assert_eq!((frame.frame_lost, frame.failsafe), (lost, failsafe));
                delivered += 1;
            });
        }
        total += stream.len();
        now_us += 10_000;
        parser.feed(&[0], now_us, |_| panic!("one byte is no frame"));
        now_us += 10_000;
    }
    assert!(
        delivered > 10_000,
        "only {delivered} frames in {total} bytes"
    );
}

/// Garbage of any kind, then frames as a radio sends them: the second at the latest is delivered, and all after it.
#[test]
fn two_frames_after_any_garbage_the_parser_is_synchronised() {
    let mut random = Random::new(0xBAD);
    for round in 0..20_000 {
        let mut parser = SbusParser::new();
        let garbage: Vec<u8> = (0..random.below(120)).map(|_| random.byte()).collect();
        let mut now_us = 1_000_000;
        parser.feed(&garbage, now_us, |_| ());
        let mut good = 0;
        for frame in 0..6 {
            let bytes = random_frame(&mut random);
            now_us += 7_000;
            // DMA may hand the frame over in two pieces.
            let cut = random.below(FRAME_LEN);
            let early_us = now_us - (FRAME_LEN - cut) as u64 * BYTE_US;
            parser.feed(&bytes[..cut], early_us, |_| good += 1);
            parser.feed(&bytes[cut..], now_us, |_| good += 1);
            assert!(
                good >= frame,
                "round {round}, frame {frame}: {good} delivered"
            );
        }
    }
}

/// The same without any silence between garbage and frames, for frames in which no other place looks like a frame.
#[test]
fn two_frames_after_garbage_without_idle_lines_the_parser_is_synchronised() {
    let mut random = Random::new(0xCAFE);
    let frame: [u8; FRAME_LEN] = [
        0x0F, 0xE0, 0x03, 0x1F, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0xE0, 0x03, 0x1F,
        0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0x00, 0x00,
    ];
    for _ in 0..20_000 {
        // No 0x0F: garbage that happens to start a frame may cost more.
        let mut stream: Vec<u8> = (0..random.below(60))
            .map(|_| random.byte() | 0x10)
            .collect();
        for _ in 0..4 {
            stream.extend(frame);
        }
        let mut good = 0;
        SbusParser::new().feed(&stream, 1_000_000, |_| good += 1);
        assert!(good >= 3, "{good} of 4");
    }
}

/// A byte lost in the middle of a frame spoils that frame only.
#[test]
fn a_lost_byte_costs_one_frame() {
    let mut random = Random::new(0x10);
    for lost in 0..FRAME_LEN {
        let mut parser = SbusParser::new();
        let mut good = Vec::new();
        for index in 0..5u64 {
            let mut frame = random_frame(&mut random).to_vec();
            if index == 2 {
                frame.remove(lost);
            }
            parser.feed(&frame, 100_000 + index * 7_000, |_| good.push(index));
        }
        assert!(
            good.starts_with(&[0, 1]) && good.ends_with(&[3, 4]),
            "{good:?}"
        );
    }
}

proptest! {
    /// Any bytes at any times, even times that run backwards.
    #[test]
    fn dbus_delivers_only_frames_inside_their_ranges(
        chunks in prop::collection::vec((prop::collection::vec(any::<u8>(), 0..40), any::<u64>()), 0..40)
    ) {
        let mut parser = DbusParser::new();
        for (bytes, ts_us) in chunks {
            parser.feed(&bytes, ts_us, |frame| {
                assert!(frame.sticks.iter().all(|stick| (324..=1724).contains(stick)));
            });
        }
    }
}

/// Frames after garbage of any length, 14 ms apart.
#[test]
fn dbus_finds_the_first_frame_after_silence() {
    let mut random = Random::new(0xD8);
    let centred: [u8; 18] = [
        0x00, 0x04, 0x20, 0x00, 0x01, 0xF8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x04,
    ];
    for _ in 0..5_000 {
        let mut parser = DbusParser::new();
        let garbage: Vec<u8> = (0..random.below(60)).map(|_| random.byte()).collect();
        parser.feed(&garbage, 100_000, |_| ());
        let mut good = 0;
        for index in 1..=3u64 {
            let now_us = 100_000 + index * 14_000;
            let cut = random.below(18);
            let early_us = now_us - (18 - cut) as u64 * 110;
            parser.feed(&centred[..cut], early_us, |_| good += 1);
            parser.feed(&centred[cut..], now_us, |_| good += 1);
            assert_eq!(good, index);
        }
    }
}
