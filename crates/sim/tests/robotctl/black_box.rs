//! What robotctl reads of the black box after a stop of the shipped image.

use std::path::PathBuf;

use robot_app::domain::{BalanceState, EventKind, StandPermit};
use robot_plant::{
    time::{MS, from_seconds},
    world::{CanBusId, RemoteInput},
};
use robot_sim::{machine::Machine, scenario::Scenario};
use robotctl::{
    black_box::{self, RecordedEvent},
    transport::Transport,
    tuning::TuningClient,
};
use serde_json::json;

use crate::{
    support,
    tool::{TIMEOUT, Tool},
};

/// The robot drives from 3 s on. What happens at 4 s differs.
const DRIVING: &str = "\
name = \"black box\"
seconds = 16
plant = \"stand\"
[[at]]
t = 2.5
remote = { enable = true }
[[at]]
t = 3.0
remote = { vx = 0.4 }
";
const STOP_S: f64 = 4.0;

/// All events in the robot, and what the tool finds after their release.
fn read(client: &mut TuningClient) -> anyhow::Result<(Vec<RecordedEvent>, usize)> {
    let (banks, _) = black_box::contents(client)?;
    let mut events = Vec::new();
    for bank in banks {
        anyhow::ensure!(!bank.is_closing, "{bank:?}");
        events.push(black_box::download(client, bank, |_| {})?);
        client.release_event(bank.index, bank.number)?;
    }
    // The robot's next look at released events comes within 20 ms, and each request takes 4 ms.
    for _ in 0..10 {
        black_box::contents(client)?;
    }
    Ok((events, black_box::contents(client)?.0.len()))
}

#[derive(Clone, Copy, PartialEq)]
enum Way {
    Can,
    Link,
}

/// The events of a robot to which `what` happens while it drives.
fn events_after(what: &str, way: Way) -> Vec<RecordedEvent> {
    events_of(&format!("{DRIVING}{what}"), way)
}

fn events_of(text: &str, way: Way) -> Vec<RecordedEvent> {
    let mut job = support::job(Scenario::parse(text, "black_box").expect("it parses"));
    let flash = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let flash = flash.join(format!("black-box-{:?}.bin", std::thread::current().id()));
    std::fs::write(&flash, crate::clean_flash()).expect("a file for its flash");
    job.flash_file = Some(flash);
    let tool = match way {
        Way::Can => {
            job.pc.can_on_pty = vec![CanBusId::Can1];
            Tool::new(read)
        }
        Way::Link => {
            job.pc.link_on_pty = true;
            Tool::at_link(|port| {
                let link = Transport::Link(port.to_owned()).open()?;
                read(&mut TuningClient::new(link, TIMEOUT))
            })
        }
    };
    let mut tool = tool.starting_at(from_seconds(7.0));
    let outcome = job.run(&mut [&mut tool]).expect("the machine starts");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(outcome.summary.control.missed, 0);
    let (events, left) = tool.result().expect("the robot answers");
    assert_eq!(left, 0, "released");
    events
}

fn fault(name: &str, rest: &str) -> String {
    format!("[[at]]\nt = {STOP_S:.1}\nfault = \"{name}\"\n{rest}")
}

fn only(events: &[RecordedEvent]) -> &RecordedEvent {
    let [event] = events else {
        panic!("{} events", events.len());
    };
    event
}

/// The robot drove until about this many seconds before the event.
fn must_show_the_drive(event: &RecordedEvent) {
    let before = event.just_before();
    assert!(before.armed, "{before:?}");
    // 0.57 m/s on wheels of 75 mm.
    assert!(before.wheel_rps.iter().all(|w| *w > 6.4), "{before:?}");
    assert!((before.drive - 0.4).abs() < 0.01, "{before:?}");
    assert!((20.0..27.0).contains(&before.battery_v), "{before:?}");
    let first = event.after_s(&event.samples[0]);
    assert!((-4.0..-2.8).contains(&first), "{first}");
}

#[test]
fn a_fall_is_told_with_the_drive_before_it() {
    let events = events_after(&fault("tilted", ""), Way::Can);
    let event = only(&events);
    assert_eq!(event.event.kind, EventKind::Stop);
    let summary = black_box::summary(event);
    assert_eq!(summary["causes"], json!(["tilt"]), "{summary}");
    // The attitude follows a jump of the accelerometer within half a second, and a tilt must last 50 ms.
    let fell_s = event.seconds() - STOP_S;
    assert!((0.05..0.7).contains(&fell_s), "{summary}");
    must_show_the_drive(event);
    let last = event.samples.last().expect("samples");
    assert!(!last.armed && (0.6..0.8).contains(&event.after_s(last)));
}

/// A hand pushes a standing robot over.
#[test]
fn a_fall_while_balancing_is_told_with_legs_and_lean() {
    let text = "name = \"balance\"\nseconds = 16\nplant = \"free\"\nseed = 7\n\
                [[at]]\nt = 2.5\nremote = { enable = true }\n\
                [[at]]\nt = 3.0\nremote = { stand = true }\n\
                [[at]]\nt = 5.5\nfault = \"tilted\"\n";
    let events = events_of(text, Way::Can);
    let event = only(&events);
    let summary = black_box::summary(event);
    assert_eq!(event.event.kind, EventKind::Stop, "{summary}");
    let at = |after_s: f64| {
        let mut samples = event.samples.iter().rev();
        let sample = samples.find(|sample| event.after_s(sample) <= after_s);
        sample.and_then(|sample| sample.balance).expect("a sample")
    };
    let stood = at(-0.6);
    assert_eq!(stood.stand, StandPermit::Standing);
    let stood = stood.status;
    assert_eq!(stood.state, BalanceState::Balance, "{stood:?}");
    assert!(
        stood.leg_m.iter().all(|leg| (0.15..0.3).contains(leg)),
        "{stood:?}"
    );
    assert!(
        stood.lean_rad.iter().all(|lean| lean.abs() < 0.2),
        "{stood:?}"
    );
    let weight_n: f32 = stood.contact_n.iter().sum();
    assert!((40.0..90.0).contains(&weight_n), "6.5 kg: {stood:?}");
    assert!(!at(-0.01).status.sits());
    let told = black_box::paragraphs(event).join(" ");
    assert!(told.contains("Balance: "), "{told}");
}

#[test]
fn a_lost_radio_is_told_over_the_pc_link() {
    let events = events_after(&fault("sbus-silent", "duration = 1.0\n"), Way::Link);
    let event = only(&events);
    assert_eq!(event.event.kind, EventKind::Stop);
    let summary = black_box::summary(event);
    assert_eq!(summary["causes"], json!(["remote-lost"]), "{summary}");
    assert!(event.just_before().radio_age_ms >= 80, "{summary}");
    must_show_the_drive(event);
}

#[test]
fn a_latched_partial_stop_is_told() {
    let frozen = fault("motor-0-frozen", "duration = 1.0\n");
    let disarmed = "[[at]]\nt = 6.0\nremote = { enable = false, vx = 0.0 }\n";
    let events = events_after(&format!("{frozen}{disarmed}"), Way::Can);
    let event = only(&events);
    assert_eq!(event.event.kind, EventKind::PartialStop);
    let summary = black_box::summary(event);
    assert_eq!(summary["causes"], json!(["wheel-frozen"]), "{summary}");
}

#[test]
fn a_panic_is_told_after_the_reset() {
    let events = events_after(&fault("panic", ""), Way::Can);
    let event = only(&events);
    assert_eq!(event.event.kind, EventKind::Reset);
    let summary = black_box::summary(event);
    let reset = json!({ "cause": "IndependentWatchdog", "last_words": "panic" });
    assert_eq!(summary["reset"], reset, "{summary}");
    must_show_the_drive(event);
}

#[test]
fn a_hang_is_told_after_the_reset() {
    let events = events_after(&fault("task-stuck-control", ""), Way::Can);
    let event = only(&events);
    assert_eq!(event.event.kind, EventKind::Reset);
    let summary = black_box::summary(event);
    assert_eq!(summary["reset"]["last_words"], "nothing was reported");
    assert!((event.seconds() - STOP_S).abs() < 0.1, "{summary}");
    must_show_the_drive(event);
}

#[test]
fn the_pilots_e_stop_is_no_event() {
    let what = format!("[[at]]\nt = {STOP_S:.1}\nremote = {{ e_stop = true }}\n");
    assert!(events_after(&what, Way::Can).is_empty());
}

#[test]
fn nothing_is_left_after_the_power_was_off() {
    let fall = fault("tilted", "duration = 1.0\n");
    let off = "[[at]]\nt = 5.5\nfault = \"power-cut\"\nduration = 0.2\n";
    assert!(events_after(&format!("{fall}{off}"), Way::Can).is_empty());
}

/// A robot that panics while it drives, a moment before the watchdog resets it.
fn panicked() -> Machine {
    let text = "name = \"damage\"\nseconds = 5\nplant = \"stand\"\n";
    let job = support::job(Scenario::parse(text, "damage").expect("it parses"));
    let mut machine = job.machine().expect("the machine starts");
    let mut pilot = |at_s: f64, input: RemoteInput| {
        machine.run_until(from_seconds(at_s)).expect("it runs");
        machine.with_world(|world| world.set_remote(input));
    };
    pilot(
        2.5,
        RemoteInput {
            enable: Some(true),
            ..RemoteInput::default()
        },
    );
    machine.run_until(from_seconds(3.5)).expect("it runs");
    machine.set_fault("panic", true).expect("a fault");
    machine
        .run_until(from_seconds(3.5) + 5 * MS)
        .expect("it runs");
    assert_eq!(machine.resets(), 0);
    machine
}

/// The state of bank 0 after the reset.
fn bank_after_reset(mut machine: Machine) -> f64 {
    machine.run_until(from_seconds(4.5)).expect("it runs");
    assert_eq!(machine.resets(), 1);
    let mut diag = Vec::new();
    assert!(machine.sample_diag(&mut diag), "it runs again");
    let names = machine.diag_names();
    let state = |name: &String| name == "diag.black_box.banks.0.state";
    diag[names.iter().position(state).expect("the state of bank 0")]
}

/// A recording whose header is damaged is taken for none; whole, it is an event.
#[test]
fn damaged_memory_is_no_event() {
    const MEMORY: &str = "::black_box_memory::MEMORY";
    const RECORDING: f64 = 1.0;
    const EVENT: f64 = 3.0;
    assert_eq!(bank_after_reset(panicked()), EVENT);
    let mut damaged = panicked();
    assert!(
        damaged.flip_bits(MEMORY, 4, 0x10),
        "the number in its header"
    );
    assert_eq!(bank_after_reset(damaged), RECORDING);
}
