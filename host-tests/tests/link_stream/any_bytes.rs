//! Ten million bytes through each receiver, in chunks of any length.

use robot_app::domain::{PcDrive, PcKind};
use robot_app::link::{Heard, PcReceiver, Received, RobotReceiver};
use robot_test_support::Random;

use super::{
    specification::{Direction, Place, search},
    streams::append_anything,
};

const BYTES: usize = 10_000_000;
const STREAM: usize = 100_000;
/// Ten bits at 460,800 baud.
const BYTE_NS: u64 = 21_701;

fn streams(direction: Direction) -> impl Iterator<Item = Vec<u8>> {
    (0..BYTES / STREAM).map(move |seed| {
        let mut random = Random::new(seed as u64);
        let mut stream = Vec::new();
        while stream.len() < STREAM {
            // Every eighth stream is noise alone.
            if seed % 8 == 0 {
                stream.push(random.byte());
            } else {
                append_anything(&mut stream, &mut random, direction);
            }
        }
        stream
    })
}

/// Calls `feed` with chunks of a stream and the number of bytes up to the end of each.
fn in_chunks(stream: &[u8], longest: usize, mut feed: impl FnMut(&[u8], usize)) {
    let mut random = Random::new(longest as u64);
    let mut at = 0;
    while at < stream.len() {
        let end = stream.len().min(at + 1 + random.below(longest));
        feed(&stream[at..end], end);
        at = end;
    }
}

fn time_us(bytes: usize) -> u64 {
    1_000_000 + bytes as u64 * BYTE_NS / 1_000
}

/// Code of the wheel's or joint's first field in the frame, for a comparison by frame.
fn first_fields(frame: &[u8]) -> [f64; 6] {
    std::array::from_fn(|motor| {
        let at = 1 + 6 * motor;
        let code = f64::from(u16::from_le_bytes([frame[at], frame[at + 1]]));
        let max = if motor < 2 { 200.0 } else { 3.2 };
        code / 65_535.0 * 2.0 * max - max
    })
}

fn assert_received(received: &[Received], stream: &[u8], frames: &[Place]) {
    let given = frames.iter().filter(|place| place.contiguous);
    assert_eq!(received.len(), given.clone().count());
    for (received, place) in received.iter().zip(given) {
        let end = place.start + place.len;
        let frame = &stream[place.start..end];
        match received {
            Received::Tunnel(can_frame) => {
                let id = can_frame.id().raw();
                assert_eq!((0xFD, id as u8 & 0x0F), (frame[0], frame[1] & 0x0F));
                assert_eq!(can_frame.padded_payload(), frame[3..11]);
            }
            Received::Command(command) if command.kind == PcKind::Drive => {
                let PcDrive {
                    vx,
                    wz,
                    height,
                    roll,
                    jump,
                    count,
                } = command.drive;
                assert_eq!(frame[0], 0xFC);
                for (place, share) in [vx, wz, height, roll].into_iter().enumerate() {
                    let at = 1 + 2 * place;
                    let code = f64::from(u16::from_le_bytes([frame[at], frame[at + 1]]));
                    assert!((f64::from(share) - (code / 32_767.5 - 1.0)).abs() < 1e-6);
                }
                assert_eq!([u8::from(jump), count], frame[9..11]);
            }
            Received::Command(command) => {
                assert_eq!(frame.len(), 38);
                let wheels = command.wheels.map(|wheel| wheel.speed_rps);
                let joints = command.joints.map(|joint| joint.pos_rad);
                let targets = wheels.iter().chain(&joints);
                for (target, expected) in targets.zip(first_fields(frame)) {
                    assert!((f64::from(*target) - expected).abs() < 1e-4);
                }
                assert!(command.ts_us.abs_diff(time_us(end)) <= 2, "{command:?}");
            }
        }
    }
}

#[test]
fn the_robot_finds_the_frames_of_ten_million_bytes_and_no_others() {
    let (mut commands, mut unconfirmed) = (0, 0);
    for stream in streams(Direction::ToRobot) {
        let verdict = search(&stream, Direction::ToRobot);
        let unconfirmed_here = verdict.frames.iter().filter(|place| !place.contiguous);
        let unconfirmed_here = unconfirmed_here.count() as u32;
        for longest in [1, 64, STREAM] {
            let mut receiver = RobotReceiver::new();
            let mut received = Vec::new();
            in_chunks(&stream, longest, |chunk, end| {
                receiver.feed(chunk, time_us(end), |frame| received.push(frame));
            });
            assert_received(&received, &stream, &verdict.frames);
            let health = receiver.health(time_us(stream.len()));
            assert_eq!(health.good as usize, verdict.frames.len());
            assert_eq!(health.discarded_bytes, verdict.discarded_bytes);
            assert_eq!(health.unconfirmed, unconfirmed_here);
        }
        commands += verdict
            .frames
            .iter()
            .filter(|place| place.contiguous)
            .count();
        unconfirmed += unconfirmed_here;
    }
    assert!(
        commands > 5_000 && unconfirmed > 5_000,
        "{commands} {unconfirmed}"
    );
}

#[test]
fn a_pc_finds_the_frames_of_ten_million_bytes_and_no_others() {
    let mut states = 0;
    for stream in streams(Direction::ToPc) {
        let verdict = search(&stream, Direction::ToPc);
        for longest in [1, 64, STREAM] {
            let mut receiver = PcReceiver::new();
            let mut places = verdict.frames.iter();
            in_chunks(&stream, longest, |chunk, _| {
                receiver.feed(chunk, |heard| {
                    let place = places.next().expect("a frame that is in the stream");
                    let frame = &stream[place.start..][..place.len];
                    match heard {
                        Heard::Uplink(state) => {
                            assert_eq!(frame[6], state.mcu_c as u8);
                            assert_eq!(frame[1..5], state.time_s.to_le_bytes());
                            states += 1;
                        }
                        Heard::Tunnel(can_frame) => {
                            assert_eq!(can_frame.padded_payload(), frame[3..11]);
                        }
                    }
                });
            });
            assert_eq!(places.next(), None);
            let counters = receiver.counters();
            assert_eq!(counters.good as usize, verdict.frames.len());
            assert_eq!(counters.discarded_bytes, verdict.discarded_bytes);
        }
    }
    assert!(states > 20_000, "{states}");
}

/// At the line's full rate 10 million random bytes take 217 s. Each of some 40,000 headers has one chance in 256.
#[test]
fn noise_alone_gives_no_command() {
    let mut receiver = RobotReceiver::new();
    let mut random = Random::new(1);
    let mut commands = 0;
    for at in 0..BYTES {
        receiver.feed(&[random.byte()], time_us(at), |received| {
            commands += u32::from(matches!(received, Received::Command(_)));
        });
    }
    let health = receiver.health(time_us(BYTES));
    assert_eq!(commands, 0);
    assert!((100..200).contains(&health.unconfirmed), "{health:?}");
    assert_eq!(health.tunnelled, 0);
}
