//! Several on one wire, and what goes wrong there.

use robot_servo_model::{Fault, Servo, Version};
use robot_test_support::Random;

use crate::host::{Host, frame};

fn three() -> Host {
    let servos = (1..=3).map(|id| {
        Servo::new(Version::Volts12, 1000.0 * f64::from(id))
            .with_id(id)
            .with_return_delay(0)
    });
    Host::new(servos.collect())
}

fn sync_read() -> Vec<u8> {
    frame(0xFE, 0x82, &[56, 2, 1, 2, 3])
}

/// Position answers of the servos with these ids, one after the other.
fn positions(ids: &[u8]) -> Vec<u8> {
    let answers = ids.iter().map(|id| {
        let [low, high] = (1000 * u16::from(*id)).to_le_bytes();
        // An answer has the form of a request: its error byte is where an instruction would be.
        frame(*id, 0, &[low, high])
    });
    answers.collect::<Vec<_>>().concat()
}

#[test]
fn a_sync_read_is_answered_in_the_order_of_its_ids() {
    let mut host = three();
    assert_eq!(host.raw(&sync_read()), positions(&[1, 2, 3]));
    let other = frame(0xFE, 0x82, &[56, 2, 3, 1]);
    assert_eq!(host.raw(&other), positions(&[3, 1]));
}

#[test]
fn a_missing_servo_leaves_a_gap_and_the_others_answer() {
    let mut host = three();
    let gone = host.wire.bus().start(Fault::Gone { servo: 1 });
    assert_eq!(host.raw(&sync_read()), positions(&[1, 3]));
    host.wire.bus().end(gone);
    assert_eq!(host.raw(&sync_read()), positions(&[1, 2, 3]));
}

#[test]
fn two_of_one_id_destroy_each_others_answers() {
    let mut host = three();
    let fault = Fault::DuplicateId { servo: 2, id: 2 };
    let twins = host.wire.bus().start(fault);
    // Positions 2000 and 3000 at once: what is low in either is low.
    let both = host.raw(&frame(2, 2, &[56, 2]));
    assert_eq!(both.len(), 8);
    assert_eq!(both[5..7], ((2000_u16 & 3000).to_le_bytes()));
    assert_eq!(host.ask(2, 2, &[56, 2]), None, "no right checksum");
    // Empty answers are the same bytes at the same time: nobody notices.
    assert_eq!(host.ask(2, 1, &[]), Some((0, vec![])));
    host.wire.bus().end(twins);
    assert_eq!(host.raw(&sync_read()), positions(&[1, 2, 3]));
}

#[test]
fn a_servo_that_answers_with_another_id_has_a_right_checksum() {
    let mut host = three();
    host.wire.bus().start(Fault::WrongId { servo: 0, id: 9 });
    assert_eq!(host.raw(&frame(1, 1, &[])), frame(9, 0, &[]));
}

#[test]
fn the_echo_is_heard_before_the_answer() {
    let mut host = three();
    host.wire.bus().start(Fault::Echo);
    let ping = frame(1, 1, &[]);
    assert_eq!(host.raw(&ping), [ping.clone(), frame(1, 0, &[])].concat());
}

#[test]
fn a_host_at_another_baud_rate_is_not_understood() {
    let mut host = three();
    for baud in [500_000, 250_000, 115_200, 38_400] {
        host.wire.set_baud(baud);
        assert_eq!(host.ask(1, 1, &[]), None, "{baud}");
    }
    host.wire.set_baud(1_000_000);
    // What they took for the start of a frame ends within the longest one.
    let mut pings = 0;
    while host.ask(1, 1, &[]).is_none() {
        pings += 1;
        assert!(pings < 60);
    }
}

#[test]
fn a_ping_of_all_is_answered_by_all() {
    let mut host = three();
    let all: Vec<u8> = (1..=3).flat_map(|id| frame(id, 0, &[])).collect();
    assert_eq!(host.raw(&frame(0xFE, 1, &[])), all);
}

#[test]
fn a_broadcast_write_is_done_by_all_and_answered_by_none() {
    let mut host = three();
    assert_eq!(host.raw(&frame(0xFE, 3, &[40, 1])), [0_u8; 0]);
    assert!(host.wire.bus().view().iter().all(|view| view.has_torque));
}

// 4,000 exchanges of a request and three answers: the counts are binomial, and the bounds 6 sigma.
#[test]
fn packets_are_lost_and_changed_as_often_as_told() {
    let mut host = three();
    host.wire
        .bus()
        .start(Fault::DropPacket { probability: 0.02 });
    host.wire
        .bus()
        .start(Fault::CorruptPacket { probability: 0.05 });
    let mut whole = 0;
    for _ in 0..4000 {
        whole += i32::from(host.raw(&sync_read()) == positions(&[1, 2, 3]));
    }
    let injected = host.wire.bus().injected();
    // A request of itself is lost or changed 7 times in 100; else there are three answers.
    let packets = 4000.0 * (1.0 + 3.0 * 0.9325);
    let expect = |count: u64, p: f64| {
        let sigma = (packets * p * (1.0 - p)).sqrt();
        assert!((count as f64 - packets * p).abs() < 6.0 * sigma, "{count}");
    };
    expect(injected.dropped_packets, 0.02);
    expect(injected.corrupted_packets, 0.05 * 0.98);
    // A changed length makes those who heard it deaf for more than its own frame, so fewer are whole than by themselves.
    let all_right = 4000.0 * 0.931_f64.powi(4);
    assert!((2000.0..all_right).contains(&f64::from(whole)), "{whole}");
}

#[test]
fn a_delayed_answer_comes_after_the_hosts_patience() {
    let mut host = three();
    let late = Fault::Delay {
        probability: 1.0,
        by_ns: 20_000_000,
    };
    let late = host.wire.bus().start(late);
    assert_eq!(host.raw(&frame(1, 1, &[])), [0_u8; 0]);
    host.wire.bus().end(late);
    host.wait_s(0.1);
    // It is still there when the next is asked.
    let both = [frame(1, 0, &[]), frame(2, 0, &[])].concat();
    assert_eq!(host.raw(&frame(2, 1, &[])), both);
}

#[test]
fn a_lost_byte_costs_the_next_request_as_well() {
    let mut host = three();
    let cut = &frame(1, 2, &[56, 2])[..7];
    assert_eq!(host.raw(cut), [0_u8; 0]);
    assert_eq!(host.ask(1, 1, &[]), None);
    assert_eq!(host.ask(1, 1, &[]), Some((0, vec![])));
}

#[test]
fn random_bytes_do_no_harm() {
    let mut random = Random::new(11);
    let mut host = three();
    for _ in 0..2000 {
        let bytes: Vec<u8> = (0..100).map(|_| random.byte()).collect();
        host.raw(&bytes);
    }
    let mut pings = 0;
    while host.ask(1, 1, &[]).is_none() {
        pings += 1;
        assert!(pings < 60);
    }
}

#[test]
fn the_same_seed_gives_the_same_faults() {
    let run = || {
        let mut host = three();
        host.wire.bus().start(Fault::Corrupt { probability: 0.02 });
        host.wire.bus().start(Fault::Drop { probability: 0.02 });
        let answers: Vec<_> = (0..200).map(|_| host.raw(&sync_read())).collect();
        (answers, host.wire.bus().injected())
    };
    let (answers, injected) = run();
    assert!(injected.dropped_bytes > 50 && injected.corrupted_bytes > 50);
    assert_eq!((answers, injected), run());
}
