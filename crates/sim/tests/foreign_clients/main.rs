//! Programs that know nothing of this project play the PC while the shipped image runs: python-can with its slcan interface,
//! python-can with the `can-waveshare` package, a UDP client written from the gateway's document, and pyserial on the PC link.

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
const TRACK_M: f64 = 0.4375;

fn script(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign_clients");
    folder.join(name)
}

/// Runs the robot with a program. Returns what it said.
fn run(mut program: Program, pc: PcAccess) -> (Vec<String>, Outcome) {
    let mut job = support::job(Scenario::parse(SCENARIO, "foreign client").expect("it parses"));
    job.pc = pc;
    let outcome = job.run(&mut [&mut program]).expect("the machine starts");
    let said = program.said();
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(outcome.summary.control.missed, 0);
    (said, outcome)
}

/// The numbers of the line that begins with `what`.
fn numbers(said: &[String], what: &str) -> Vec<f64> {
    let mut lines = said.iter().map(|line| line.split(' '));
    let line = lines.find_map(|mut words| (words.next() == Some(what)).then_some(words));
    let words = line.unwrap_or_else(|| panic!("no {what} in {said:?}"));
    words.map(|word| word.parse().expect("a number")).collect()
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
    let (said, outcome) = run(program, pc);
    // One command a tick and one feedback of each motor.
    let counts = numbers(&said, "counts");
    assert!(
        counts.len() == 3 && counts.iter().all(|n| (100.0..=102.0).contains(n)),
        "{counts:?}"
    );
    assert_eq!(numbers(&said, "track"), [TRACK_M]);
    let PortStats {
        from_pc,
        refused,
        malformed,
        ..
    } = outcome.summary.can_ports["can1"];
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
    let (said, outcome) = run(program, gateway("udp:0"));
    let batch = numbers(&said, "batch");
    assert!(batch[0] >= 3.0, "frames of a millisecond share a packet");
    assert_eq!(numbers(&said, "track"), [TRACK_M]);
    let port = outcome.summary.can_ports["can1"];
    // Three frames that are none, and a packet with a rest.
    assert_eq!((port.from_pc, port.refused, port.malformed), (5, 0, 4));
}

#[test]
fn pyserial_reads_whole_states_at_the_links_rate_and_its_commands_arrive() {
    let Some(python) = Python::with_packages() else {
        return;
    };
    let program = Program::new(&python, &script("serial_link.py"), &[], Wanted::Link);
    let pc = PcAccess {
        link_on_pty: true,
        ..PcAccess::default()
    };
    let (said, outcome) = run(program, pc);
    // A computer that is too slow loses bytes. Frames in a row tell the rate.
    assert!(numbers(&said, "run")[0] >= 100.0, "{said:?}");
    let [rate_hz] = numbers(&said, "rate")[..] else {
        panic!("{said:?}");
    };
    assert!((410.0..425.0).contains(&rate_hz), "{said:?}");
    // A frame every 2.4 ms has the newest of states that are 2 ms apart: never the same one again, and none is older.
    let steps_s = numbers(&said, "steps");
    let mut steps_s = steps_s.iter();
    assert!(steps_s.all(|s| (0.0019..0.0041).contains(s)), "{said:?}");
    let value = |name: &str| outcome.result.value(&format!("diag.link.{name}"));
    assert_eq!(value("good"), Some(numbers(&said, "sent")[0]));
    assert_eq!(value("crc_errors"), Some(0.0));
    assert_eq!(value("resyncs"), Some(0.0));
}
