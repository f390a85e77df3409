//! Pages of recordings made here.

use robot_app::{
    domain::{CanFrame, StandardId},
    link::{Keys, Uplink},
};

use super::*;
use crate::{can_recorder::CanRecorder, link_recorder::LinkRecorder, pc_link::Traffic};

fn path(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("robotctl-{}-{name}", std::process::id()))
}

fn page_of(path: &Path) -> String {
    let page = page(path).unwrap();
    std::fs::remove_file(path).unwrap();
    page
}

/// Two seconds at the link's rate, armed from the first one on, with a gap at 1.5 s.
fn record_states(path: &Path) {
    let mut recorder = LinkRecorder::create(path).unwrap();
    for n in (0..834).filter(|n| !(625..700).contains(n)) {
        let time_s = 10.0 + 0.0024 * n as f32;
        let mut keys = Keys::B;
        keys.set(Keys::F1, n > 416);
        let state = Uplink {
            time_s,
            battery_v: 24.0,
            accel_mps2: [0.0, 0.0, 9.8],
            q_xyzw: [0.0, 0.0, 0.0, 1.0],
            keys,
            ..Uplink::default()
        };
        recorder.add(&state, &Traffic::default()).unwrap();
    }
    recorder.finish().unwrap();
}

#[test]
fn a_recording_of_the_link_shows_all_its_signals_and_its_gap() {
    let path = path("plot-link.mcap");
    record_states(&path);
    let page = page_of(&path);
    for title in [
        "Attitude",
        "Angular rates",
        "Accelerations",
        "Wheel speeds",
        "Joint angles",
        "Sticks",
        "States and switches",
        "Battery",
        "Temperature",
        "State frames a second",
        "Longest gaps",
    ] {
        assert!(page.contains(title), "{title}");
    }
    assert!(page.contains("1, 0.18 s in all"), "{page}");
    assert!(page.contains("24.0 … 24.0 V"));
    assert!(!page.contains("NaN"));
}

#[test]
fn a_recording_that_was_killed_is_shown_as_far_as_it_goes() {
    let path = path("plot-killed.mcap");
    record_states(&path);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let page = page_of(&path);
    assert!(page.contains("The file has no end"), "{page}");
    assert!(page.contains("Attitude"));
}

#[test]
fn a_recording_of_a_bus_shows_motors_and_identifiers() {
    let path = path("plot-can.mcap");
    let mut recorder = CanRecorder::create(&path).unwrap();
    let id = StandardId::new(0x201).unwrap();
    for ms in 0..500_u64 {
        let frame = CanFrame::new(id, [0, 0, 0, ms as u8, 0x20, 0, 41, 0]);
        recorder.add(&frame, ms * 1_000_000).unwrap();
    }
    recorder.finish().unwrap();
    let page = page_of(&path);
    for text in [
        "Rotor speeds",
        "Currents measured",
        "0x201",
        "0 silences",
        "ESC 1<",
    ] {
        assert!(page.contains(text), "{text}");
    }
    assert!(!page.contains("Joint angles"));
}

#[test]
fn a_table_for_calibration_is_shown() {
    let path = path("plot.csv");
    let mut table = String::from("t,ax,ay,az,mx,my,mz\n");
    for n in 0..100 {
        let t = f64::from(n) * 0.02;
        table.push_str(&format!("{t},0,0,9.8,20,0,-40\n"));
    }
    std::fs::write(&path, table).unwrap();
    let page = page_of(&path);
    assert!(page.contains("Accelerations") && page.contains("Magnetic field"));
}

#[test]
fn a_file_of_something_else_is_refused() {
    let path = path("plot-other.mcap");
    std::fs::write(&path, "no recording").unwrap();
    assert!(page(&path).is_err());
    std::fs::remove_file(&path).unwrap();
}
