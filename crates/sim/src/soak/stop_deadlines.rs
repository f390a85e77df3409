//! The actuators that each fault must stop, and the deadlines (`tests/matrix` measures each fault alone).

use robot_plant::time::{MS, Ps};

/// A kind of actuator, on a bus of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// CAN1.
    Wheels,
    /// CAN2.
    Joints,
}

/// All actuators of the group must be without torque that long after the fault has begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopDeadline {
    pub group: Group,
    pub within: Ps,
}

/// After a switch of the pilot: two radio frames, 7 ms apart and 3 ms long, then 3 ms to zero torque.
pub const AFTER_SWITCH: Ps = (2 * 7 + 3 + 3) * MS;

/// The deadlines that follow from a fault. The list is empty for a fault that must stop nothing.
pub fn after(fault: &str) -> Vec<StopDeadline> {
    let all = |ms: Ps| vec![deadline(Group::Wheels, ms), deadline(Group::Joints, ms)];
    match fault {
        "sbus-silent" | "sbus-frame-lost" => return all(106),
        "sbus-failsafe" => return all(20),
        "imu-gone" => return all(35),
        "imu-frozen" | "imu-extreme" => return all(100),
        "battery-empty" => return all(1_100),
        "tilted" => return all(600),
        // The drives' own time limit.
        "can2-broken" | "can2-empty" | "rogue-node-can2" => {
            return vec![deadline(Group::Joints, 105)];
        }
        _ => {}
    }
    match motor(fault) {
        Some((0 | 1, "hot")) => vec![deadline(Group::Wheels, 600)],
        Some((2.., "hot")) => vec![deadline(Group::Joints, 600)],
        Some((2.., "gone")) => vec![deadline(Group::Joints, 60)],
        Some((2.., "wrong-id")) => vec![deadline(Group::Joints, 110)],
        Some((2.., "fault")) => vec![deadline(Group::Joints, 10)],
        _ => Vec::new(),
    }
}

fn deadline(group: Group, ms: Ps) -> StopDeadline {
    StopDeadline {
        group,
        within: ms * MS,
    }
}

/// Motor and kind of a motor's fault. Wheels are 0 and 1, joints follow.
pub fn motor(fault: &str) -> Option<(usize, &str)> {
    let (number, kind) = fault.strip_prefix("motor-")?.split_once('-')?;
    Some((number.parse().ok()?, kind))
}

/// Whether the fault keeps the group's frames off its bus.
pub fn disturbs(fault: &str, group: Group) -> bool {
    let bus = match group {
        Group::Wheels => "can1",
        Group::Joints => "can2",
    };
    fault.contains(bus)
}

/// Whether the fault hides the effect of the other one: a frozen report shows no temperature.
pub fn hides(fault: &str, other: &str) -> bool {
    match (motor(fault), motor(other)) {
        (Some((a, "frozen" | "gone" | "wrong-id")), Some((b, _))) => a == b,
        _ => fault == "battery-low" && other == "battery-empty",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_faults_are_taken_apart() {
        assert_eq!(motor("motor-3-wrong-id"), Some((3, "wrong-id")));
        assert_eq!(motor("mag-gone"), None);
        assert!(disturbs("rogue-node-can1", Group::Wheels));
        assert!(!disturbs("can2-empty", Group::Wheels));
        assert!(hides("motor-2-frozen", "motor-2-hot"));
        assert!(!hides("motor-2-frozen", "motor-3-hot"));
    }

    #[test]
    fn every_deadline_belongs_to_a_fault_that_exists() {
        let names = robot_plant::world::World::faults().iter().map(|f| f.name);
        let deadlines = names.map(|name| after(name).len()).sum::<usize>();
        // 8 of everything, 3 of CAN2, 2 hot wheels, 4 joints in 4 ways.
        assert_eq!(deadlines, 8 * 2 + 3 + 2 + 4 * 4);
    }
}
