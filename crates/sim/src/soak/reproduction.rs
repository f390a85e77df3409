//! A scenario that repeats the last events before a violation.

use std::{collections::BTreeSet, fmt::Write};

use robot_plant::{
    time::{Ps, SECOND, to_seconds},
    world::{CanBusId, PcDrive, PcInput, PcJoints, RemoteInput},
};

use super::invariants::Violation;
use crate::scenario::{Event, TimedEvent};

/// Time for boot, calibration and set-up before the first event.
const BOOT: Ps = 3 * SECOND;

/// The events in the span `replayed` before the violation. They begin with the switches and faults of its start.
pub fn scenario(done: &[TimedEvent], violation: &Violation, seed: u64, replayed: Ps) -> String {
    let from = violation.at.saturating_sub(replayed);
    let (earlier, replayed): (Vec<_>, Vec<_>) = done.iter().partition(|timed| timed.at < from);
    let shift = |at: Ps| to_seconds((at + BOOT).saturating_sub(from));
    let mut text = String::new();
    let what = violation.what.replace(['"', '\\'], "'");
    let seconds = shift(violation.at) + 1.0;
    let at = to_seconds(violation.at);
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "# The last events of a soak with seed {seed}, which found at {at:.3} s: {what}."
    );
    let _ = writeln!(
        text,
        "name = \"soak, seed {seed}\"\nseconds = {seconds:.3}\nplant = \"stand\"\nseed = {seed}"
    );
    for event in state(&earlier) {
        event_text(&mut text, shift(from), &event);
    }
    for timed in replayed {
        event_text(&mut text, shift(timed.at), &timed.event);
    }
    text
}

/// The smallest set of events that leads to the same switches and faults.
fn state(earlier: &[&TimedEvent]) -> Vec<Event> {
    let mut pilot = RemoteInput::default();
    let mut pc = PcInput::default();
    let mut faults = BTreeSet::new();
    for timed in earlier {
        match &timed.event {
            Event::Remote(input) => {
                pilot = RemoteInput {
                    enable: input.enable.or(pilot.enable),
                    e_stop: input.e_stop.or(pilot.e_stop),
                    vx: input.vx.or(pilot.vx),
                    wz: input.wz.or(pilot.wz),
                    mode: input.mode.or(pilot.mode),
                    left_x: input.left_x.or(pilot.left_x),
                    left_y: input.left_y.or(pilot.left_y),
                    stand: input.stand.or(pilot.stand),
                    height: input.height.or(pilot.height),
                    roll: input.roll.or(pilot.roll),
                    jump: input.jump.or(pilot.jump),
                };
            }
            Event::Pc(input) => {
                pc = PcInput {
                    on: input.on.or(pc.on),
                    rate_hz: input.rate_hz.or(pc.rate_hz),
                    wheels_rps: input.wheels_rps.or(pc.wheels_rps),
                    wheel_kd: input.wheel_kd.or(pc.wheel_kd),
                    joints: input.joints.or(pc.joints),
                    joint_kp: input.joint_kp.or(pc.joint_kp),
                    joint_kd: input.joint_kd.or(pc.joint_kd),
                    counts: input.counts.or(pc.counts),
                    drive: input.drive.or(pc.drive.filter(|_| !input.is_for_motors())),
                };
            }
            Event::StartFault(name) => {
                faults.insert(name.clone());
            }
            Event::EndFault(name) => {
                faults.remove(name);
            }
            Event::Can(..) | Event::Push(_) => {}
        }
    }
    let is_of_world = |name: &String| {
        let mut all = robot_plant::world::World::faults().iter();
        all.any(|fault| fault.name == name)
    };
    let faults = faults.into_iter().filter(is_of_world);
    let faults = faults.map(Event::StartFault);
    let pc = (pc.on == Some(true)).then_some(Event::Pc(pc));
    std::iter::once(Event::Remote(pilot))
        .chain(pc)
        .chain(faults)
        .collect()
}

fn event_text(text: &mut String, at: f64, event: &Event) {
    let what = match event {
        Event::Remote(input) => format!("remote = {{ {} }}", remote_text(input)),
        Event::Pc(input) => format!("pc = {{ {} }}", pc_text(input)),
        Event::Can(bus, frame) => {
            let bus = match bus {
                CanBusId::Can1 => 1,
                CanBusId::Can2 => 2,
            };
            let data = frame.data.get(..usize::from(frame.dlc)).unwrap_or_default();
            let id = frame.id;
            format!("can = {{ bus = {bus}, id = {id:#x}, data = {data:?} }}")
        }
        Event::Push(push) => format!("push = {{ impulse_ns = {:?} }}", push.impulse_ns),
        Event::StartFault(name) => format!("fault = \"{name}\""),
        Event::EndFault(name) => format!("end_fault = \"{name}\""),
    };
    let _ = write!(text, "\n[[at]]\nt = {at:.6}\n{what}\n");
}

fn remote_text(input: &RemoteInput) -> String {
    let mut fields = Vec::new();
    let mut field = |name: &str, value: Option<String>| {
        fields.extend(value.map(|value| format!("{name} = {value}")));
    };
    field("enable", input.enable.map(|v| v.to_string()));
    field("e_stop", input.e_stop.map(|v| v.to_string()));
    field("vx", input.vx.map(|v| format!("{v:?}")));
    field("wz", input.wz.map(|v| format!("{v:?}")));
    field("left_x", input.left_x.map(|v| format!("{v:?}")));
    field("left_y", input.left_y.map(|v| format!("{v:?}")));
    field("mode", input.mode.map(|v| v.to_string()));
    field("stand", input.stand.map(|v| v.to_string()));
    field("height", input.height.map(|v| format!("{v:?}")));
    field("roll", input.roll.map(|v| format!("{v:?}")));
    field("jump", input.jump.map(|v| v.to_string()));
    fields.join(", ")
}

fn pc_text(input: &PcInput) -> String {
    let mut fields = Vec::new();
    let mut field = |name: &str, value: Option<String>| {
        fields.extend(value.map(|value| format!("{name} = {value}")));
    };
    let number = |value: Option<f64>| value.map(|v| format!("{v:?}"));
    field("on", input.on.map(|v| v.to_string()));
    field("rate_hz", number(input.rate_hz));
    field("wheels", input.wheels_rps.map(|v| format!("{v:?}")));
    field("kd", number(input.wheel_kd));
    field(
        "joints",
        input.joints.map(|joints| match joints {
            PcJoints::Limp => "\"limp\"".to_owned(),
            PcJoints::Hold => "\"hold\"".to_owned(),
            PcJoints::At(angles) => format!("{angles:?}"),
        }),
    );
    field("joint_kp", number(input.joint_kp));
    field("joint_kd", number(input.joint_kd));
    field("counts", input.counts.map(|v| v.to_string()));
    field("drive", input.drive.map(|drive| drive_text(&drive)));
    fields.join(", ")
}

fn drive_text(drive: &PcDrive) -> String {
    let PcDrive {
        vx,
        wz,
        height,
        roll,
        jump,
    } = drive;
    format!("{{ vx = {vx:?}, wz = {wz:?}, height = {height:?}, roll = {roll:?}, jump = {jump} }}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;

    #[test]
    fn the_last_events_become_a_scenario_that_starts_with_the_state_before_them() {
        let remote = |enable, vx| {
            Event::Remote(RemoteInput {
                enable,
                vx,
                ..RemoteInput::default()
            })
        };
        let pc = |rate_hz| {
            Event::Pc(PcInput {
                on: Some(true),
                rate_hz: Some(rate_hz),
                wheels_rps: Some([1.5, 0.0]),
                joints: Some(PcJoints::Hold),
                ..PcInput::default()
            })
        };
        let timed = |s: u64, what| TimedEvent {
            at: s * SECOND,
            event: what,
        };
        let fault = |name: &str| Event::StartFault(name.to_owned());
        let done = [
            timed(10, remote(Some(true), Some(0.5))),
            timed(10, pc(200.0)),
            timed(11, fault("mag-gone")),
            timed(12, fault("imu-gone")),
            timed(13, Event::EndFault("imu-gone".to_owned())),
            timed(50, remote(None, Some(-1.0))),
            timed(50, pc(300.0)),
        ];
        let violation = Violation {
            at: 52 * SECOND,
            what: "it \"moved\"".to_owned(),
        };
        let text = scenario(&done, &violation, 7, 10 * SECOND);
        let read = Scenario::parse(&text, "soak.toml").expect("it parses");
        assert_eq!((read.seed, read.length), (7, 14 * SECOND));
        let at = |s: u64| s * SECOND;
        let repeated: Vec<_> = read
            .events
            .iter()
            .map(|a| (a.at, a.event.clone()))
            .collect();
        assert_eq!(
            repeated,
            [
                (at(3), remote(Some(true), Some(0.5))),
                (at(3), pc(200.0)),
                (at(3), fault("mag-gone")),
                (at(11), remote(None, Some(-1.0))),
                (at(11), pc(300.0)),
            ]
        );
    }
}
