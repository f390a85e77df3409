//! A frame that was cut is given up after 20 ms of silence.

use robot_app::link::{Downlink, Received, RobotReceiver};
use robot_test_support::Random;

use super::streams::tunnel_frame;

fn command(speed_rps: f32) -> [u8; 38] {
    let mut downlink = Downlink::default();
    downlink.wheels[0].speed_rps = speed_rps;
    downlink.encode()
}

/// Number of commands and tunnelled frames.
fn received(receiver: &mut RobotReceiver, bytes: &[u8], ts_us: u64) -> [usize; 2] {
    let mut count = [0; 2];
    receiver.feed(bytes, ts_us, |received| match received {
        Received::Command(_) => count[0] += 1,
        Received::Tunnel(_) => count[1] += 1,
    });
    count
}

#[test]
fn a_frame_with_a_pause_counts_only_if_the_pause_is_short() {
    for cut in 1..38 {
        for (pause_us, commands) in [(19_000, 1), (21_000, 0)] {
            let mut receiver = RobotReceiver::new();
            let (first, second) = (command(1.0), command(2.0));
            assert_eq!(received(&mut receiver, &first, 1_000_000), [1, 0]);
            received(&mut receiver, &second[..cut], 1_010_000);
            let rest_us = (38 - cut) as u64 * 22;
            let end_us = 1_010_000 + pause_us + rest_us;
            let count = received(&mut receiver, &second[cut..], end_us);
            assert_eq!(count, [commands, 0], "{cut} {pause_us}");
        }
    }
}

/// The next frame is found at once, and used from the one after it on.
#[test]
fn after_a_cut_and_silence_the_next_frames_need_no_further_bytes() {
    for cut in 1..38 {
        let mut receiver = RobotReceiver::new();
        received(&mut receiver, &command(1.0)[..cut], 1_000_000);
        for (n, commands) in [(1, 0), (2, 1), (3, 1)] {
            let ts_us = 1_000_000 + n * 50_000;
            let count = received(&mut receiver, &command(n as f32), ts_us);
            assert_eq!(count, [commands, 0], "{cut}");
        }
        let health = receiver.health(1_200_000);
        assert_eq!((health.good, health.unconfirmed, health.resyncs), (3, 1, 1));
        assert_eq!(health.discarded_bytes, cut as u32);
        assert_eq!(health.crc_errors, 0);
    }
}

/// A false header hides a request only until the line has been silent: a call without bytes is enough to find it. It is
/// used when it is repeated.
#[test]
fn a_request_behind_a_false_header_arrives_when_repeated() {
    let mut random = Random::new(3);
    for garbage in [&[0xFE][..], &[0xFE, 0x00, 0x00], &[0xFD], &[0x12, 0xFE]] {
        let mut receiver = RobotReceiver::new();
        let request = tunnel_frame(&mut random);
        let bytes = [garbage, &request].concat();
        let before = received(&mut receiver, &bytes, 1_000_000);
        let after = received(&mut receiver, &[], 1_020_000);
        assert_eq!((before[1], after[1]), (0, 0), "{garbage:?}");
        assert_eq!(receiver.health(1_020_000).unconfirmed, 1, "{garbage:?}");
        assert_eq!(received(&mut receiver, &request, 1_250_000)[1], 1);
    }
}

#[test]
fn silence_between_whole_frames_is_no_damage() {
    let mut receiver = RobotReceiver::new();
    for n in 1..=5 {
        assert_eq!(
            received(&mut receiver, &command(1.0), n * 2_000_000),
            [1, 0]
        );
        assert_eq!(
            received(&mut receiver, &[], n * 2_000_000 + 500_000),
            [0, 0]
        );
    }
    assert_eq!(receiver.health(10_000_000).resyncs, 0);
}

/// The line error may have cost bytes that no one has seen.
#[test]
fn after_a_line_error_one_frame_is_not_used() {
    for at in 0..=38 {
        let mut receiver = RobotReceiver::new();
        received(&mut receiver, &command(1.0), 1_000_000);
        let second = command(2.0);
        let early = received(&mut receiver, &second[..at], 1_010_000)[0];
        assert_eq!(early, usize::from(at == 38), "{at}");
        receiver.feed_damaged(&second[at..], 2, 1_011_000);
        let expected = usize::from(at != 38);
        assert_eq!(
            received(&mut receiver, &command(3.0), 1_020_000)[0],
            expected
        );
        assert_eq!(received(&mut receiver, &command(4.0), 1_030_000)[0], 1);
        assert_eq!(receiver.health(1_030_000).line_errors, 2);
    }
}

/// The flagged byte may lie in any of the frames that are among the damaged bytes, in whole or in part.
#[test]
fn no_frame_among_damaged_bytes_is_used() {
    for cut in 0..=38 {
        let mut receiver = RobotReceiver::new();
        let [first, second, third] = [1.0, 2.0, 3.0].map(command);
        received(&mut receiver, &first, 1_000_000);
        let damaged = [&first[..], &second, &third[..cut]].concat();
        receiver.feed_damaged(&damaged, 1, 1_002_000);
        let rest = received(&mut receiver, &third[cut..], 1_003_000)[0];
        // A third frame that is not among them follows directly on the second one.
        assert_eq!(rest, usize::from(cut == 0), "{cut}");
        assert_eq!(received(&mut receiver, &command(4.0), 1_004_000)[0], 1);
        let unconfirmed = 2 + u32::from(cut != 0);
        assert_eq!(receiver.health(1_004_000).unconfirmed, unconfirmed);
    }
}

#[test]
fn equal_commands_keep_the_time_of_the_first() {
    let mut receiver = RobotReceiver::new();
    let mut changed_us = Vec::new();
    for (n, speed_rps) in [(1, 1.0), (2, 1.0), (3, 1.0), (4, 1.1), (5, 1.1), (6, 1.0)] {
        receiver.feed(&command(speed_rps), n * 10_000, |received| {
            if let Received::Command(command) = received {
                assert_eq!(command.ts_us, n * 10_000);
                changed_us.push(command.changed_us);
            }
        });
    }
    let expected_ms = [10, 10, 10, 40, 40, 60];
    assert_eq!(changed_us, expected_ms.map(|ms| ms * 1_000));
}
