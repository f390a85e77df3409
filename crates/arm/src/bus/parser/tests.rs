use super::*;

/// Numbers without a pattern, from a seed (xorshift64*).
struct Noise(u64);

impl Noise {
    fn byte(&mut self) -> u8 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 56) as u8
    }
}

/// Feeds noise in which headers are frequent. Returns how many frames it had, and checks each by its own sum.
fn frames_in_noise(bytes: u64, seed: u64) -> u64 {
    let mut noise = Noise(seed);
    let mut parser = Parser::default();
    let (mut frames, mut in_frames) = (0, 0);
    for number in 0..bytes {
        let byte = match noise.byte() {
            0..0x60 => 0xFF,
            0x60..0x90 => number as u8 % 8,
            byte => byte,
        };
        parser.push(byte);
        while let Some(found) = parser.next(|_| true) {
            let Found::Frame(frame) = found else { continue };
            let sum: u32 = frame.bytes()[2..].iter().map(|b| u32::from(*b)).sum();
            assert_eq!(sum % 256, 255);
            assert_eq!(usize::from(frame.bytes()[3]) + 4, frame.bytes().len());
            frames += 1;
            in_frames += frame.bytes().len() as u64;
        }
        assert!(parser.bytes.len() < longest());
    }
    // Every byte is in a frame, skipped, or still waiting.
    assert_eq!(
        in_frames + parser.skipped() + parser.bytes.len() as u64,
        bytes
    );
    frames
}

/// `ROBOT_ARM_NOISE_BYTES` sets how many.
#[test]
fn ten_million_random_bytes_go_through() {
    let bytes = std::env::var("ROBOT_ARM_NOISE_BYTES")
        .ok()
        .and_then(|n| n.parse().ok());
    let frames = frames_in_noise(bytes.unwrap_or(10_000_000), 0x5EED);
    // A frame of chance takes a header and a checksum of one in 256.
    assert!(frames > 100, "{frames}");
}

#[test]
fn a_frame_cut_short_gives_way_to_the_one_behind_it() {
    let ping = [0xFF, 0xFF, 1, 2, 0, 0xFC];
    let mut parser = Parser::default();
    for byte in [&[0xFF, 0xFF, 2, 9, 0, 1], &ping[..]].concat() {
        parser.push(byte);
        assert_eq!(parser.next(|_| true), None);
    }
    assert!(parser.give_up());
    let Some(Found::Frame(frame)) = parser.next(|_| true) else {
        panic!("the frame behind was lost");
    };
    assert_eq!(frame.bytes(), ping);
    assert!(!parser.give_up());
    assert_eq!(parser.skipped(), 6);
}
