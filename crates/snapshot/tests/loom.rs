//! Interleavings and the values the memory model lets a reader see, explored by loom:
//! `RUSTFLAGS="--cfg loom" cargo test -p robot-snapshot --release --target host-tuple`
//!
//! One reader is enough: readers store nothing, so they cannot disturb the writer or each other.
#![cfg(loom)]

use loom::{model::Builder, sync::Arc, thread};
use robot_snapshot::Snapshot;

/// Runs `reader` against a writer that publishes `[1, 1]` up to `[publications; 2]`.
fn explore(publications: u32, preemptions: usize, reader: fn(&Snapshot<[u32; 2]>)) {
    let mut builder = Builder::new();
    builder.preemption_bound = Some(preemptions);
    builder.check(move || {
        let snapshot = Arc::new(Snapshot::new([0_u32; 2]));
        let shared = Arc::clone(&snapshot);
        let reading = thread::spawn(move || reader(&shared));
        let mut writer = snapshot.writer().expect("first request");
        for number in 1..=publications {
            writer.publish(&[number, number]);
        }
        reading.join().expect("the reader finished");
    });
}

/// Three publications: the second reuses the slot of the initial value, the third that of the first.
#[test]
fn a_value_is_whole() {
    explore(3, 3, |snapshot| {
        let [first, second] = snapshot.latest();
        assert_eq!(first, second, "torn value");
    });
}

#[test]
fn a_follower_sees_whole_values_that_never_go_back() {
    explore(3, 3, |snapshot| {
        let mut follower = snapshot.follower();
        let [first, second] = *follower.latest();
        assert_eq!(first, second, "torn value");
        let [after, second] = *follower.latest();
        assert_eq!(after, second, "torn value");
        assert!(after >= first, "{after} followed after {first}");
    });
}

#[test]
fn values_never_go_back() {
    explore(2, 2, |snapshot| {
        let [before, _] = snapshot.latest();
        let [after, _] = snapshot.latest();
        assert!(after >= before, "{after} read after {before}");
    });
}
