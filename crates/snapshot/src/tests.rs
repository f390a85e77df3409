use super::*;
use core::sync::atomic::Ordering;

/// Has padding, floats and a `bool`: what a real message looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Message {
    ts_us: u64,
    valid: bool,
    rpm: [f32; 3],
    flags: u16,
}

fn message(number: u32) -> Message {
    Message {
        ts_us: u64::from(number),
        valid: number.is_multiple_of(2),
        rpm: [number as f32; 3],
        flags: number as u16,
    }
}

#[test]
fn reads_as_the_initial_value_then_as_the_newest() {
    static SNAPSHOT: Snapshot<Message> = Snapshot::new(Message {
        ts_us: 7,
        valid: true,
        rpm: [0.5; 3],
        flags: 3,
    });
    assert_eq!(SNAPSHOT.latest().rpm, [0.5; 3]);
    let mut writer = SNAPSHOT.writer().expect("first request");
    for number in 0..5 {
        writer.publish(&message(number));
        assert_eq!(SNAPSHOT.latest(), message(number));
    }
}

#[test]
fn a_follower_starts_with_the_value_there_is_and_keeps_up() {
    let snapshot = Snapshot::new(message(3));
    let mut follower = snapshot.follower();
    assert_eq!(*follower.latest(), message(3));
    let mut writer = snapshot.writer().expect("first request");
    for number in 4..9 {
        writer.publish(&message(number));
        assert_eq!(*follower.latest(), message(number));
        assert_eq!(*follower.latest(), message(number));
    }
}

#[test]
fn a_change_is_reported_once_and_the_last_copy_stays() {
    let snapshot = Snapshot::new(message(3));
    let mut follower = snapshot.follower();
    let mut writer = snapshot.writer().expect("first request");
    assert_eq!(follower.changed(), None);
    writer.publish(&message(4));
    writer.publish(&message(5));
    assert_eq!(*follower.last(), message(3));
    assert_eq!(follower.changed(), Some(&message(5)));
    assert_eq!(follower.changed(), None);
    assert_eq!(*follower.last(), message(5));
}

#[test]
fn there_is_one_writer() {
    let snapshot = Snapshot::new(0_u64);
    assert!(snapshot.writer().is_some());
    assert!(snapshot.writer().is_none());
}

/// A reader in an interrupt that cuts a publication in two must return at once.
#[test]
fn reader_that_interrupts_a_publication_gets_the_value_before_it() {
    let snapshot = Snapshot::new(message(0));
    let mut writer = snapshot.writer().expect("first request");
    writer.publish(&message(1));
    snapshot.begun.store(2, Ordering::Relaxed);
    assert_eq!(snapshot.latest(), message(1));
    snapshot.slot(2).store(&message(2));
    assert_eq!(snapshot.latest(), message(1));
    snapshot.published.store(2, Ordering::Release);
    assert_eq!(snapshot.latest(), message(2));
}

#[test]
fn counters_may_wrap() {
    let snapshot = Snapshot::new(message(0));
    snapshot.begun.store(u32::MAX, Ordering::Relaxed);
    snapshot.published.store(u32::MAX, Ordering::Relaxed);
    let mut writer = snapshot.writer().expect("first request");
    writer.last = u32::MAX;
    for number in 1..4 {
        writer.publish(&message(number));
        assert_eq!(snapshot.latest(), message(number));
    }
}

#[test]
fn values_are_whole_and_never_go_back_between_threads() {
    const LAST: u32 = 100_000;
    let snapshot = Snapshot::new(message(0));
    std::thread::scope(|scope| {
        let reader = || {
            let mut seen = 0;
            while seen < u64::from(LAST) {
                let value = snapshot.latest();
                let number = u32::try_from(value.ts_us).expect("only small numbers are published");
                assert_eq!(value, message(number));
                assert!(value.ts_us >= seen);
                seen = value.ts_us;
            }
        };
        scope.spawn(reader);
        scope.spawn(reader);
        let mut writer = snapshot.writer().expect("first request");
        for number in 1..=LAST {
            writer.publish(&message(number));
        }
    });
}
