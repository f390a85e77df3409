//! Programs that know nothing of this project play the PC while the shipped image runs: python-can with its slcan interface,
//! python-can with the `can-waveshare` package, and a UDP client written from the gateway's document.

#[path = "../support/program.rs"]
mod program;
#[path = "../support/mod.rs"]
mod support;

use std::path::{Path, PathBuf};

use program::{Program, Wanted};
use robot_plant::world::CanBusId;
use robot_sim::{can_port::PortStats, job::Outcome, pc::PcAccess, scenario::Scenario};
use robot_test_support::Python;

/// What the robot has saved before. Sectors with a record need no erase, during which requests would be lost.
const SCENARIO: &str = r#"
name = "a foreign client"
seconds = 5
plant = "stand"
[[flash.record]]
group = 1
values = [0.06, 0.4375, 19.2, 1, -1]
"#;
const TRACK: &str = "track 0.4375";

fn script(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign_clients");
    folder.join(name)
}

/// Runs the robot with a program on CAN1. Returns what it said and its frames.
fn run(mut program: Program, pc: PcAccess) -> (Vec<String>, PortStats, Outcome) {
    let mut job = support::job(Scenario::parse(SCENARIO, "foreign client").expect("it parses"));
    job.pc = pc;
    let outcome = job.run(&mut [&mut program]).expect("the machine starts");
    let said = program.said();
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(outcome.summary.control.missed, 0);
    let port = outcome.summary.can_ports["can1"];
    (said, port, outcome)
}

fn gateway(address: &str) -> PcAccess {
    PcAccess {
        gateway: Some(address.parse().expect("an address")),
        ..PcAccess::default()
    }
}

fn python_can(interface: &str, pc: PcAccess) {
    let Some(python) = Python::with_packages() else {
        return;
    };
    let program = Program::new(
        &python,
        &script("python_can.py"),
        &[interface],
        Wanted::Can(CanBusId::Can1),
    );
    let (said, port, _) = run(program, pc);
    let [counts, track] = &said[..] else {
        panic!("{said:?}");
    };
    // One command a tick and one feedback of each motor.
    let counts: Vec<u32> = counts.split(' ').filter_map(|n| n.parse().ok()).collect();
    assert!(
        counts.len() == 3 && counts.iter().all(|n| (100..=102).contains(n)),
        "{counts:?}"
    );
    assert_eq!(track, TRACK);
    let PortStats {
        from_pc,
        refused,
        malformed,
        ..
    } = port;
    assert_eq!((from_pc, refused, malformed), (4, 0, 0));
}

#[test]
fn python_can_with_slcan_hears_the_motors_and_reads_a_setting() {
    let pc = PcAccess {
        can_on_pty: vec![CanBusId::Can1],
        ..PcAccess::default()
    };
    python_can("slcan", pc);
}

#[test]
fn python_can_with_can_waveshare_hears_the_motors_and_reads_a_setting() {
    python_can("waveshare", gateway("tcp:0"));
}

#[test]
fn a_udp_client_written_from_the_document_hears_the_motors_and_reads_a_setting() {
    let Some(python) = Python::with_packages() else {
        return;
    };
    let program = Program::new(
        &python,
        &script("can_to_eth.py"),
        &[],
        Wanted::Can(CanBusId::Can1),
    );
    let (said, port, _) = run(program, gateway("udp:0"));
    let [batch, track] = &said[..] else {
        panic!("{said:?}");
    };
    let frames: u32 = batch
        .strip_prefix("batch ")
        .and_then(|n| n.parse().ok())
        .expect("a number");
    assert!(frames >= 3, "frames of a millisecond share a packet");
    assert_eq!(track, TRACK);
    // Three frames that are none, and a packet with a rest.
    assert_eq!((port.from_pc, port.refused, port.malformed), (5, 0, 4));
}
