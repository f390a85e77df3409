//! Records frames and reads the file with the format's own library.

use std::path::PathBuf;

use mcap::MessageStream;
use robot_app::domain::StandardId;
use serde_json::Value;

use super::*;

fn frame(id: u16, payload: &[u8]) -> CanFrame {
    CanFrame::from_payload(StandardId::new(id).unwrap(), payload).unwrap()
}

fn path(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("robotctl-{}-{name}.mcap", std::process::id()))
}

#[test]
fn frames_are_recorded_raw_and_the_motors_in_words() {
    let path = path("can");
    let mut recorder = CanRecorder::create(&path).unwrap();
    // Vectors of docs/hardware.md#test-vectors.
    let feedback = frame(0x201, &[0x1F, 0xFF, 0xFE, 0x0C, 0x20, 0x00, 41, 0]);
    let command = frame(0x200, &[0x03, 0xE8, 0xFC, 0x18, 0x40, 0x00, 0xC0, 0x00]);
    let stranger = frame(0x6F0, &[1, 2]);
    for (ms, frame) in [(1, &command), (3, &feedback), (11, &stranger)] {
        recorder.add(frame, ms * 1_000_000).unwrap();
    }
    let summary = recorder.finish().unwrap();
    assert_eq!(summary.frames, 3);
    assert_eq!(summary.longest_gap, Duration::from_millis(8));
    assert_eq!(summary.rate_hz(), 300.0);
    assert_eq!(summary.of_id[&0x6F0], 1);

    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let messages = MessageStream::new(&bytes).unwrap().map(|message| {
        let message = message.unwrap();
        let json: Value = serde_json::from_slice(&message.data).unwrap();
        (message.channel.topic.clone(), message.log_time, json)
    });
    let messages: Vec<_> = messages.collect();
    let find = |topic: &'static str| messages.iter().filter(move |m| m.0 == topic);
    let texts: Vec<_> = find("/can").map(|m| m.2["text"].clone()).collect();
    assert_eq!(
        texts,
        ["200#03E8FC184000C000", "201#1FFFFE0C20002900", "6F0#0102"]
    );
    let (_, at_ns, esc) = find("/esc/1").next().unwrap();
    assert_eq!(*at_ns, 3_000_000);
    assert_eq!(esc["rotor_rpm"], -500);
    assert_eq!(esc["current_a"], 10.0);
    let (_, _, command) = find("/esc/command").next().unwrap();
    assert_eq!(command["current_3_a"], 20.0);
    assert_eq!(messages.len(), 5);
}
