//! A scenario that does the last deeds before a broken rule again.

use std::{collections::BTreeSet, fmt::Write};

use robot_plant::{
    time::{Ps, SECOND, to_seconds},
    world::{CanBusId, RemoteInput},
};

use super::watch::Violation;
use crate::scenario::{Action, Deed};

/// Boot, calibration and set-up before the first deed.
const BOOT: Ps = 3 * SECOND;

/// The deeds of the last `retold` before the violation, after a boot with the switches and faults as they were then.
pub fn scenario(done: &[Action], violation: &Violation, seed: u64, retold: Ps) -> String {
    let from = violation.at.saturating_sub(retold);
    let (earlier, retold): (Vec<_>, Vec<_>) = done.iter().partition(|action| action.at < from);
    let shift = |at: Ps| to_seconds((at + BOOT).saturating_sub(from));
    let mut text = String::new();
    let what = violation.what.replace(['"', '\\'], "'");
    let seconds = shift(violation.at) + 1.0;
    let at = to_seconds(violation.at);
    // A String takes everything.
    let _ = writeln!(
        text,
        "# The last deeds of a soak with seed {seed}, which found at {at:.3} s: {what}."
    );
    let _ = writeln!(
        text,
        "name = \"soak, seed {seed}\"\nseconds = {seconds:.3}\nplant = \"stand\"\nseed = {seed}"
    );
    for deed in state(&earlier) {
        deed_text(&mut text, shift(from), &deed);
    }
    for action in retold {
        deed_text(&mut text, shift(action.at), &action.what);
    }
    text
}

/// The shortest deeds that lead where all of these led.
fn state(earlier: &[&Action]) -> Vec<Deed> {
    let mut pilot = RemoteInput::default();
    let mut faults = BTreeSet::new();
    for action in earlier {
        match &action.what {
            Deed::Remote(input) => {
                pilot = RemoteInput {
                    enable: input.enable.or(pilot.enable),
                    e_stop: input.e_stop.or(pilot.e_stop),
                    vx: input.vx.or(pilot.vx),
                    wz: input.wz.or(pilot.wz),
                    mode: input.mode.or(pilot.mode),
                    left_x: input.left_x.or(pilot.left_x),
                    left_y: input.left_y.or(pilot.left_y),
                };
            }
            Deed::StartFault(name) => {
                faults.insert(name.clone());
            }
            Deed::EndFault(name) => {
                faults.remove(name);
            }
            Deed::Can(..) => {}
        }
    }
    let is_of_world = |name: &String| {
        let mut all = robot_plant::world::World::faults().iter();
        all.any(|fault| fault.name == name)
    };
    let faults = faults.into_iter().filter(is_of_world);
    let faults = faults.map(Deed::StartFault);
    std::iter::once(Deed::Remote(pilot)).chain(faults).collect()
}

fn deed_text(text: &mut String, at: f64, deed: &Deed) {
    let what = match deed {
        Deed::Remote(input) => format!("remote = {{ {} }}", remote_text(input)),
        Deed::Can(bus, frame) => {
            let bus = match bus {
                CanBusId::Can1 => 1,
                CanBusId::Can2 => 2,
            };
            let data = frame.data.get(..usize::from(frame.dlc)).unwrap_or_default();
            let id = frame.id;
            format!("can = {{ bus = {bus}, id = {id:#x}, data = {data:?} }}")
        }
        Deed::StartFault(name) => format!("fault = \"{name}\""),
        Deed::EndFault(name) => format!("end_fault = \"{name}\""),
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
    fields.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;

    #[test]
    fn the_last_deeds_are_a_scenario_with_the_state_before_them() {
        let remote = |enable, vx| {
            Deed::Remote(RemoteInput {
                enable,
                vx,
                ..RemoteInput::default()
            })
        };
        let action = |s: u64, what| Action {
            at: s * SECOND,
            what,
        };
        let fault = |name: &str| Deed::StartFault(name.to_owned());
        let done = [
            action(10, remote(Some(true), Some(0.5))),
            action(11, fault("mag-gone")),
            action(12, fault("imu-gone")),
            action(13, Deed::EndFault("imu-gone".to_owned())),
            action(50, remote(None, Some(-1.0))),
        ];
        let violation = Violation {
            at: 52 * SECOND,
            what: "it \"moved\"".to_owned(),
        };
        let text = scenario(&done, &violation, 7, 10 * SECOND);
        let read = Scenario::parse(&text, "soak.toml").expect("it parses");
        assert_eq!((read.seed, read.length), (7, 14 * SECOND));
        let at = |s: u64| s * SECOND;
        let told: Vec<_> = read
            .actions
            .iter()
            .map(|a| (a.at, a.what.clone()))
            .collect();
        assert_eq!(
            told,
            [
                (at(3), remote(Some(true), Some(0.5))),
                (at(3), fault("mag-gone")),
                (at(11), remote(None, Some(-1.0))),
            ]
        );
    }
}
