//! Compares what a balancing robot did with what it must do.

use robot_plant::time::{MS, Ps};

use crate::{
    balancing_expected::Outcome,
    judge,
    observed::{Observed, Pose, Wire},
    row::{Arms, Group, Row},
};

/// A robot that balances and drives leans less than this.
const MOST_LEAN_RAD: f64 = 0.35;
/// Beyond 0.7 rad for 20 ms it lets go; the tilt is known to 0.05 rad, and zero is on the wires 5 ms later.
const FALLEN_RAD: f64 = 0.75;
const FALLEN_FOR: Ps = 30 * MS;
/// At 0.4 of its highest speed it drives at 1 m/s.
const DRIVES_MPS: f64 = 0.5;
const RESTS_MPS: f64 = 0.25;

/// Differences from the expectation, as text.
pub fn violations(row: &Row, seen: &Observed) -> Vec<String> {
    let wanted = &row.balancing;
    let mut all = judge::flags(&wanted.flags, seen);
    all.extend(torque_in_a_fall(wanted.outcome, seen));
    match wanted.outcome {
        Outcome::Drives => {
            all.extend(stands(seen));
            all.extend(drives(seen, "after the fault"));
        }
        Outcome::Balances => all.extend(stands(seen)),
        Outcome::OnTheSpot => {
            all.extend(stands(seen));
            all.extend(rests(seen));
            all.extend(drives(seen, "after a start from rest"));
        }
        Outcome::LetsGo { wheels, joints } => {
            all.extend(judge::group("wheels", wheels, &seen.wheels, seen, true));
            all.extend(judge::group("joints", joints, &seen.joints, seen, true));
            all.extend(lies(row, seen));
        }
        Outcome::Either if has_fallen(seen) => all.extend(lies(row, seen)),
        Outcome::Either => {}
    }
    all
}

fn has_fallen(seen: &Observed) -> bool {
    !seen.armed_at_fault_end
}

fn stands(seen: &Observed) -> Vec<String> {
    let mut all = Vec::new();
    if let Some(pose) = seen.poses.iter().find(|pose| pose.tilt_rad > MOST_LEAN_RAD) {
        let ms = pose.at as f64 / MS as f64;
        all.push(format!(
            "it leans by {:.2} rad after {ms:.0} ms",
            pose.tilt_rad
        ));
    }
    if !seen.armed_at_end {
        all.push("it is disarmed".to_owned());
    }
    all
}

fn drives(seen: &Observed, when: &str) -> Option<String> {
    let speed_mps = seen.poses.last().map_or(0.0, |pose| pose.speed_mps);
    (speed_mps < DRIVES_MPS).then(|| format!("it drives at {speed_mps:.2} m/s {when}"))
}

/// Violations by a robot that rolls at the end of the fault, or before the PC has started from rest.
fn rests(seen: &Observed) -> Vec<String> {
    let at = |when: Ps| {
        let mut poses = seen.poses.iter().rev();
        poses
            .find(|pose| pose.at <= when)
            .copied()
            .unwrap_or_default()
    };
    [
        ("at the end of the fault", seen.fault_ended),
        ("before a start from rest", seen.back),
    ]
    .into_iter()
    .filter(|(_, when)| at(*when).speed_mps.abs() > RESTS_MPS)
    .map(|(what, when)| format!("it rolls at {:.2} m/s {what}", at(when).speed_mps))
    .collect()
}

/// No motor that can be reached has torque in a fall, even if the fault alone did not ask for that.
fn torque_in_a_fall(outcome: Outcome, seen: &Observed) -> Option<String> {
    let fallen = |pose: &&Pose| pose.tilt_rad > FALLEN_RAD;
    let from = seen.poses.iter().find(fallen)?.at + FALLEN_FOR;
    let reachable: &[Wire] = match outcome {
        Outcome::LetsGo {
            wheels: Group::Unreachable,
            ..
        } => &[],
        _ => &seen.wheels,
    };
    let mut wires = reachable.iter().chain(&seen.joints);
    let ms = from as f64 / MS as f64;
    wires
        .any(|wire| wire.had_torque_in(from, seen.back))
        .then(|| format!("it has fallen, and has torque {ms:.0} ms after the start of the fault"))
}

/// Violations by a robot that should lie: it moves by itself after the fault, or stands up although nobody asks it to.
fn lies(row: &Row, seen: &Observed) -> Vec<String> {
    let mut all = Vec::new();
    let moves = |wire: &Wire| wire.told_torque_in(seen.fault_ended, seen.back);
    for (name, wires) in [("wheels", &seen.wheels[..]), ("joints", &seen.joints[..])] {
        if wires.iter().any(moves) {
            all.push(format!("{name} move by themselves after the fault"));
        }
    }
    if seen.stands_at_end() {
        all.push("it stands, and nobody has asked it to stand up again".to_owned());
    }
    match row.balancing.arms_after {
        Arms::No if seen.armed_after_fault => {
            all.push("the enable switch alone arms it".to_owned())
        }
        Arms::Yes if !seen.armed_after_fault => {
            all.push("it does not arm after the fault".to_owned())
        }
        _ => {}
    }
    all
}
