//! Records states and reads the file with the format's own library.

use mcap::MessageStream;
use robot_app::link::{Keys, MotorState};
use serde_json::Value;

use super::*;

fn state(time_s: f32) -> Uplink {
    let half_turn = std::f32::consts::FRAC_1_SQRT_2;
    Uplink {
        time_s,
        battery_v: 24.5,
        mcu_c: 41,
        accel_mps2: [0.0, 0.5, 9.5],
        gyro_rps: [0.25, 0.0, -1.0],
        q_xyzw: [0.0, 0.0, half_turn, half_turn],
        keys: Keys::F1 | Keys::B | Keys::START,
        motors: [MotorState {
            pos_rad: 0.5,
            vel_rps: -2.0,
        }; 6],
        ..Uplink::default()
    }
}

fn recorded(states: &[Uplink]) -> (LinkSummary, Vec<(String, u64, Value)>) {
    let name = format!("robotctl-{}-link-{}.mcap", std::process::id(), states.len());
    let path = std::env::temp_dir().join(name);
    let mut recorder = LinkRecorder::create(&path).unwrap();
    for state in states {
        recorder.add(state, &Traffic::default()).unwrap();
    }
    let summary = recorder.finish().unwrap();
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let messages = MessageStream::new(&bytes).unwrap().map(|message| {
        let message = message.unwrap();
        let json = serde_json::from_slice(&message.data).unwrap();
        (message.channel.topic.clone(), message.log_time, json)
    });
    (summary, messages.collect())
}

#[test]
fn a_state_is_recorded_with_all_its_fields() {
    let (summary, messages) = recorded(&[state(2.0), state(2.0024)]);
    assert_eq!((summary.states, summary.gaps), (2, 0));
    let (_, at_ns, first) = messages.iter().find(|m| m.0 == STATE_TOPIC).unwrap();
    assert_eq!(*at_ns, 2_000_000_000);
    assert_eq!(first["armed"], true);
    assert_eq!(first["mode"], "pc");
    assert_eq!(first["battery_v"], 24.5);
    assert_eq!(first["mcu_c"], 41);
    assert_eq!(first["accel_mps2"][2], 9.5);
    assert_eq!(first["gyro_rps"][2], -1.0);
    assert!((first["attitude"]["yaw_deg"].as_f64().unwrap() - 90.0).abs() < 1e-4);
    assert_eq!(first["wheels"]["right"]["speed_rps"], -2.0);
    assert_eq!(first["joints"]["right_rear"]["angle_rad"], 0.5);
    assert_eq!(first["radio"]["enable"], true);
    assert_eq!(first["radio"]["lost"], false);
}

#[test]
fn a_gap_is_counted_and_marked() {
    let times = [2.0, 2.0024, 2.0524, 2.0548, 2.0572];
    let (summary, messages) = recorded(&times.map(state));
    assert_eq!((summary.states, summary.gaps), (5, 1));
    assert!((summary.longest_gap_s - 0.05).abs() < 1e-5, "{summary:?}");
    assert!(
        (summary.rate_hz() - 4.0 / 0.0572).abs() < 0.1,
        "{summary:?}"
    );
    let gaps: Vec<_> = messages.iter().filter(|m| m.0 == GAP_TOPIC).collect();
    let [(_, at_ns, gap)] = gaps[..] else {
        panic!("{gaps:?}");
    };
    assert!(at_ns.abs_diff(2_052_400_000) < 1_000, "{at_ns}");
    assert!((gap["seconds"].as_f64().unwrap() - 0.05).abs() < 1e-5);
}
