//! A PC on the emulated CAN bus, through a pseudo-terminal and the LAWICEL protocol, while the shipped image runs.

mod support;

use std::{
    fs::{File, OpenOptions},
    io::{ErrorKind, Read, Write},
    os::unix::fs::OpenOptionsExt,
};

use robot_plant::{
    time::{MS, Ps},
    world::CanBusId,
};
use robot_sim::{
    can_port::CanDevice,
    job::Outcome,
    machine::LogLine,
    runner::Observer,
    scenario::Scenario,
    signals::{SignalTable, Values},
};
use rustix::fs::OFlags;

/// A tool on the PC that writes its lines at given times and keeps what it reads.
#[derive(Default)]
struct Pc {
    script: Vec<(Ps, String)>,
    reads: bool,
    device: Option<File>,
    received: String,
}

impl Pc {
    fn frames(&self, start: &str) -> usize {
        let lines = self.received.split('\r');
        lines.filter(|line| line.starts_with(start)).count()
    }
}

impl Observer for Pc {
    fn sample(&mut self, at: Ps, _: &SignalTable, _: &Values) {
        let Some(device) = &mut self.device else {
            return;
        };
        for (_, line) in self.script.extract_if(.., |(due, _)| *due <= at) {
            device
                .write_all(line.as_bytes())
                .expect("the line is short");
        }
        if self.reads {
            let mut bytes = [0; 4096];
            match device.read(&mut bytes) {
                Ok(count) => self
                    .received
                    .push_str(&String::from_utf8_lossy(&bytes[..count])),
                Err(e) => assert_eq!(e.kind(), ErrorKind::WouldBlock),
            }
        }
    }

    fn log(&mut self, _: &LogLine) {}

    fn can_port(&mut self, bus: CanBusId, device: &CanDevice) {
        assert_eq!(bus, CanBusId::Can1);
        let opened = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags((OFlags::NOCTTY | OFlags::NONBLOCK).bits().cast_signed())
            .open(device.path().expect("a terminal"));
        self.device = Some(opened.expect("the device is there"));
    }
}

fn run(pc: &mut Pc, seconds: f64) -> Outcome {
    let text = format!("name = \"pc\"\nseconds = {seconds}\nplant = \"stand\"\n");
    let mut job = support::job(Scenario::parse(&text, "pc").expect("it parses"));
    job.pc.can_on_pty = vec![CanBusId::Can1];
    let outcome = job.run(&mut [pc]).expect("the machine starts");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    outcome
}

fn received(outcome: &Outcome) -> f64 {
    let count = outcome.result.value("diag.can.0.rx_frames");
    count.expect("the firmware counts what it receives")
}

/// A new chip's flash gets its first erase later.
const BEFORE_ERASE_S: f64 = 0.5;

/// Frames 20 ms apart, so that a burst fits into the firmware's queue: 0x7A1, which it knows, and 0x3FF, which nobody
/// uses.
fn injection() -> Vec<(Ps, String)> {
    let burst = "t7A180102030405060708\rt3FF0\r".repeat(4);
    (0..10)
        .map(|n| ((300 + 20 * n) * MS, burst.clone()))
        .collect()
}

#[test]
fn a_pc_receives_the_commands_and_its_frames_reach_the_firmware() {
    let open = (100 * MS, "S8\rZ1\rO\r".to_owned());
    let mut silent = Pc {
        script: vec![open.clone()],
        reads: true,
        ..Pc::default()
    };
    let without = run(&mut silent, BEFORE_ERASE_S);
    let mut talking = Pc {
        script: [vec![open], injection()].concat(),
        reads: true,
        ..Pc::default()
    };
    let with = run(&mut talking, BEFORE_ERASE_S);

    assert!(
        talking.received.starts_with("\r\r\r"),
        "settings are acknowledged"
    );
    assert_eq!(talking.frames("z"), 80, "every frame was taken");
    assert_eq!(
        talking.frames("t7A1") + talking.frames("t3FF"),
        0,
        "no echo"
    );
    let port = &with.summary.can_ports["can1"];
    assert_eq!((port.from_pc, port.dropped), (80, 0));
    assert_eq!(received(&with) - received(&without), 80.0);

    // One command a tick and one feedback of each motor in 400 ms.
    for (start, what) in [("t2008", "commands"), ("t2018", "left"), ("t2028", "right")] {
        let count = talking.frames(start);
        assert!((390..=402).contains(&count), "{count} {what}");
    }
    let command = silent.received.split('\r').find(|l| l.starts_with("t200"));
    let stamp = command.and_then(|l| l.strip_prefix("t2008")?.strip_prefix("0000000000000000"));
    let stamp = u16::from_str_radix(stamp.expect("unarmed: all zero"), 16);
    assert!((100..=103).contains(&stamp.expect("milliseconds")));

    assert!(with.summary.external_input && !with.summary.reproducible);
}

#[test]
fn a_pc_that_never_reads_costs_frames_and_nothing_else() {
    let mut pc = Pc {
        script: vec![(100 * MS, "S8\rO\r".to_owned())],
        ..Pc::default()
    };
    let outcome = run(&mut pc, 3.0);
    let port = &outcome.summary.can_ports["can1"];
    assert!(port.dropped > 0, "{port:?}");
    // Three frames a millisecond, but only those of the motors in the 250 ms of the erase; those of the last millisecond
    // may still be on their way.
    assert!(
        (8_440..=8_460).contains(&(port.to_pc + port.dropped)),
        "{port:?}"
    );
    assert_eq!(outcome.summary.control.missed, 0);
}

#[test]
fn without_a_pc_the_run_is_reproducible() {
    let text = "name = \"alone\"\nseconds = 0.05\nplant = \"stand\"\n";
    let job = support::job(Scenario::parse(text, "alone").expect("it parses"));
    let outcome = job.run(&mut []).expect("the machine starts");
    assert!(outcome.summary.reproducible && !outcome.summary.external_input);
}
