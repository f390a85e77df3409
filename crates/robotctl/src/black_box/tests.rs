use std::time::Duration;

use robot_app::{
    black_box::{BANK_BYTES, BlackBox, BlackBoxMemory, LAYOUT_VERSION},
    domain::{
        BalanceState, BalanceStatus, CrashCause, EventKind, ResetCause, StandPermit,
        WheelOdomConfig,
    },
    safety::{ArmingBlockers, ArmingState, DriveEnd, SafetyFlags},
    tuning::Refusal,
};

use super::*;
use crate::{
    plot,
    tuning::{
        TuningClient, TuningError,
        testing::{Bus, robot},
    },
};

const AT_ONCE: ReleaseTimeouts = ReleaseTimeouts {
    pause: Duration::ZERO,
    looks: 10,
};

/// A robot that drove and then fell; its black box is complete.
fn fallen() -> (Bus, TuningClient) {
    let (bus, client) = robot();
    let memory: &'static BlackBoxMemory = Box::leak(Box::default());
    let mut black_box = BlackBox::boot(memory, ResetCause::PowerOn, CrashCause::Silent);
    {
        let robot = &mut *bus.0.borrow_mut();
        robot.black_box = Some(memory);
        let report = &mut robot.diagnostics;
        report.safety.flags = SafetyFlags::NONE;
        report.battery_v = 24.0;
        let mut run = |report: &mut robot_app::diagnostics::DiagnosticsSnapshot, samples: u64| {
            for _ in 0..samples {
                report.ts_us += 10_000;
                black_box.step(report, &WheelOdomConfig::default());
            }
            report.black_box = *black_box.status();
        };
        report.arming.state = ArmingState::Armed;
        report.remote_diag.age_us = 7_000;
        report.safety.stand = StandPermit::Standing;
        report.balance = BalanceStatus {
            state: BalanceState::Balance,
            airborne: true,
            leg_m: [0.18, 0.2],
            lean_rad: [0.35, 0.35],
            contact_n: [4.0, 0.0],
            ..BalanceStatus::SIT
        };
        run(report, 600);
        report.arming.state = ArmingState::Disarmed;
        report.safety.flags = SafetyFlags::TILT;
        report.drive_end = DriveEnd {
            blockers: ArmingBlockers::SAFETY_STOP,
            flags: SafetyFlags::TILT,
        };
        run(report, 100);
    }
    (bus, client)
}

#[test]
fn an_event_is_downloaded_told_and_released() {
    let (bus, mut client) = fallen();
    let (banks, overwritten) = contents(&mut client).expect("it answers");
    assert_eq!(overwritten, 0);
    let [bank] = banks[..] else {
        panic!("{banks:?}");
    };
    assert_eq!((bank.kind, bank.is_closing), (EventKind::Stop, false));
    let mut received = Vec::new();
    let event = download(&mut client, bank, |bytes| received.push(bytes)).expect("it is whole");
    assert!(received.is_sorted(), "{received:?}");
    assert_eq!(received.last(), Some(&14_336));
    assert_eq!(event.samples.len(), 198);
    assert!((event.seconds() - 6.01).abs() < 1e-6);
    assert!(event.samples.is_sorted_by_key(|sample| sample.time));
    assert!(event.just_before().armed);
    let story = paragraphs(&event);
    assert_eq!(
        story[0],
        "The robot was stopped 6.01 s after it had booted: it fell over (tilt)."
    );
    assert!(
        story[1].contains("Just before (10 ms), it was armed"),
        "{story:?}"
    );
    assert!(story[1].contains("battery 24.0 V; last radio frame 7 ms old"));
    assert!(
        story[1].ends_with(
            "Balance: balance, airborne; legs 0.18 and 0.20 m, leaning +20° and +20°, wheels on the ground with 4 and 0 N."
        ),
        "{story:?}"
    );
    // The robot empties the bank some time after its reply.
    bus.0.borrow_mut().looks_to_release = Some(5);
    release(&mut client, bank, AT_ONCE).expect("it is released");
    let (banks, _) = contents(&mut client).expect("it answers");
    assert_eq!(banks, []);
    // As a request does whose first reply was lost.
    release(&mut client, bank, AT_ONCE).expect("it was released before");
}

#[test]
fn an_event_that_stays_or_is_gone_is_told_without_riddles() {
    let (bus, mut client) = fallen();
    let (banks, _) = contents(&mut client).expect("it answers");
    bus.0.borrow_mut().looks_to_release = None;
    let stays = release(&mut client, banks[0], AT_ONCE).expect_err("it stays");
    assert!(stays.to_string().contains("still holds it"), "{stays}");
    bus.0.borrow_mut().diagnostics.black_box.banks = Default::default();
    let gone = download(&mut client, banks[0], |_| {}).expect_err("nothing is there");
    assert!(gone.to_string().starts_with("the event is gone"), "{gone}");
}

#[test]
fn lost_frames_are_asked_for_again() {
    let (bus, mut client) = fallen();
    bus.0.borrow_mut().block_frames_to_lose = 3;
    let (banks, _) = contents(&mut client).expect("it answers");
    let event = download(&mut client, banks[0], |_| {}).expect("it is whole");
    assert_eq!(event.samples.len(), 198);
    bus.0.borrow_mut().block_frames_to_lose = usize::MAX;
    let lost = download(&mut client, banks[0], |_| {});
    assert!(matches!(lost, Err(DownloadError::Lost)), "{lost:?}");
}

#[test]
fn an_armed_robot_shows_what_is_there_but_gives_nothing() {
    let (bus, mut client) = fallen();
    bus.0.borrow_mut().diagnostics.arming.state = ArmingState::Armed;
    let (banks, _) = contents(&mut client).expect("it answers");
    let refused = download(&mut client, banks[0], |_| {});
    assert!(
        matches!(
            refused,
            Err(DownloadError::Robot(TuningError::Refused {
                reason: Ok(Refusal::Armed),
                ..
            }))
        ),
        "{refused:?}"
    );
}

#[test]
fn a_recording_of_the_sensors_refuses_the_download_with_advice() {
    let (_, mut client) = fallen();
    let (banks, _) = contents(&mut client).expect("it answers");
    client.start_recording(60).expect("it is disarmed");
    let refused = download(&mut client, banks[0], |_| {}).expect_err("it is refused");
    let text = refused.to_string();
    assert!(
        text.contains("wait for the program that started it"),
        "{text}"
    );
    client.start_recording(0).expect("it ends");
    download(&mut client, banks[0], |_| {}).expect("it is whole");
}

/// A partial stop whose only trace is that the PC must begin from rest.
#[test]
fn a_short_gap_in_the_pcs_commands_is_told() {
    let (_, mut client) = fallen();
    let (banks, _) = contents(&mut client).expect("it answers");
    let mut event = download(&mut client, banks[0], |_| {}).expect("it is whole");
    event.event.flags = SafetyFlags::PC_AWAITED.union(SafetyFlags::TILT);
    assert_eq!(event.causes(), SafetyFlags::TILT, "the PC did not stop it");
    event.event.kind = EventKind::PartialStop;
    event.event.flags = SafetyFlags::PC_AWAITED;
    assert_eq!(summary(&event)["causes"], serde_json::json!(["pc-awaited"]));
    let story = first_sentence(&event);
    for words in [
        "had to begin from rest again",
        "gap in its commands",
        "(pc-awaited)",
    ] {
        assert!(story.contains(words), "{story}");
    }
}

#[test]
fn a_firmware_without_a_black_box_is_told_apart() {
    let (bus, mut client) = fallen();
    bus.0.borrow_mut().is_old = true;
    assert!(matches!(contents(&mut client), Err(DownloadError::TooOld)));
}

#[test]
fn an_event_becomes_a_recording_and_a_page() {
    let (_, mut client) = fallen();
    let (banks, _) = contents(&mut client).expect("it answers");
    let event = download(&mut client, banks[0], |_| {}).expect("it is whole");
    let path = std::env::temp_dir().join(format!("robotctl-black-box-{}.mcap", std::process::id()));
    write(&event, &path).expect("a file");
    let refused = plot::page(&path).expect_err("it has a page already");
    let its_page = path.with_extension("html");
    assert!(
        refused.to_string().contains(&*its_page.to_string_lossy()),
        "{refused}"
    );
    let bytes = std::fs::read(&path).expect("it is there");
    let mut count = [0; 2];
    for message in mcap::MessageStream::new(&bytes).expect("an MCAP file") {
        let message = message.expect("a message");
        let json: serde_json::Value = serde_json::from_slice(&message.data).expect("JSON");
        match message.channel.topic.as_str() {
            SAMPLE_TOPIC => {
                count[0] += 1;
                assert_eq!(
                    message.log_time,
                    (json["time_s"].as_f64().unwrap() * 1e9).round() as u64
                );
            }
            EVENT_TOPIC => {
                count[1] += 1;
                assert_eq!(json["causes"], serde_json::json!(["tilt"]));
            }
            _ => {}
        }
    }
    assert_eq!(count, [198, 1]);
    let page = plot::event_page(&event).expect("a page");
    for text in [
        "it fell over (tilt)",
        "Attitude",
        "Wheel currents",
        "tilt raised",
    ] {
        assert!(page.contains(text), "{text}");
    }
}

/// Returns the bank as a firmware with layout 1 would hold it: records end after word 15.
fn in_layout_1(bank: &[u8]) -> Vec<u8> {
    let crc = |bytes: &[u8]| {
        let mut crc = flate2::Crc::new();
        crc.update(bytes);
        crc.sum().to_le_bytes()
    };
    let number = &bank[4..8];
    let mut first = bank[..64].to_vec();
    first[3] = 1;
    let begun = [number, &first[..12], &[0; 48]].concat();
    first[12..16].copy_from_slice(&crc(&begun));
    for record in bank[64..].chunks_exact(72) {
        first.extend(&record[..60]);
        first.extend(crc(&[&record[..60], number].concat()));
    }
    first.resize(BANK_BYTES, 0);
    first
}

#[test]
fn an_event_of_an_older_firmware_is_read() {
    let (bus, _) = fallen();
    let memory = bus.0.borrow().black_box.expect("a black box");
    let bank: Vec<u8> = (0..BANK_BYTES).map(|at| memory.byte(0, at)).collect();
    let first = in_layout_1(&bank);
    assert!(RecordedEvent::decode(&first, LAYOUT_VERSION).is_none());
    let old = RecordedEvent::decode(&first, 1).expect("an event");
    let new = RecordedEvent::decode(&bank, LAYOUT_VERSION).expect("an event");
    assert_eq!((old.event, old.samples.len()), (new.event, 198));
    for (old, new) in old.samples.iter().zip(&new.samples) {
        assert_eq!(old.balance, None);
        assert!(new.balance.is_some());
        assert_eq!((old.time, old.flags), (new.time, new.flags));
        assert_eq!(old.wheel_rps, new.wheel_rps);
    }
    assert!(paragraphs(&old)[1].ends_with("last radio frame 7 ms old."));
    assert_eq!(paragraphs(&old)[0], paragraphs(&new)[0]);
}

/// No panic and no event from noise, half an event, or nothing.
#[test]
fn bytes_that_are_no_event_give_none() {
    let mut noise = 1_u32;
    let mut bytes = vec![0; 14_336];
    assert!(RecordedEvent::decode(&bytes, LAYOUT_VERSION).is_none());
    for byte in &mut bytes {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *byte = (noise >> 24) as u8;
    }
    assert!(RecordedEvent::decode(&bytes, LAYOUT_VERSION).is_none());
    assert!(RecordedEvent::decode(&bytes[..100], LAYOUT_VERSION).is_none());
}
