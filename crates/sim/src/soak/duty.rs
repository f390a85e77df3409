//! Which faults must stop what, and how soon (design, section 3; `tests/matrix` measures each of them alone).

use robot_plant::time::{MS, Ps};

/// A kind of actuator, on a bus of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// CAN1.
    Wheels,
    /// CAN2.
    Joints,
}

/// Zero torque on all of the group, so long after the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duty {
    pub group: Group,
    pub within: Ps,
}

/// A radio frame every 7 ms takes 3 ms; two on the way to be believed; then 3 ms to zero.
pub const SWITCH: Ps = (2 * 7 + 3 + 3) * MS;

pub fn of(fault: &str) -> Vec<Duty> {
    let all = |ms: Ps| vec![duty(Group::Wheels, ms), duty(Group::Joints, ms)];
    match fault {
        "sbus-silent" | "sbus-frame-lost" => return all(106),
        "sbus-failsafe" => return all(20),
        "imu-gone" => return all(35),
        "imu-frozen" | "imu-extreme" => return all(100),
        "battery-empty" => return all(1_100),
        "tilted" => return all(600),
        // The drives' own time limit.
        "can2-broken" | "can2-empty" | "rogue-node-can2" => return vec![duty(Group::Joints, 105)],
        _ => {}
    }
    match motor(fault) {
        Some((0 | 1, "hot")) => vec![duty(Group::Wheels, 600)],
        Some((2.., "hot")) => vec![duty(Group::Joints, 600)],
        Some((2.., "gone")) => vec![duty(Group::Joints, 60)],
        Some((2.., "wrong-id")) => vec![duty(Group::Joints, 110)],
        Some((2.., "fault")) => vec![duty(Group::Joints, 10)],
        _ => Vec::new(),
    }
}

fn duty(group: Group, ms: Ps) -> Duty {
    Duty {
        group,
        within: ms * MS,
    }
}

/// Motor and kind of a motor's fault: wheels are 0 and 1, joints follow.
pub fn motor(fault: &str) -> Option<(usize, &str)> {
    let (number, kind) = fault.strip_prefix("motor-")?.split_once('-')?;
    Some((number.parse().ok()?, kind))
}

/// True where the fault keeps the group's frames off its bus.
pub fn disturbs(fault: &str, group: Group) -> bool {
    let bus = match group {
        Group::Wheels => "can1",
        Group::Joints => "can2",
    };
    fault.contains(bus)
}

/// True where the fault hides what the other one does: a frozen report tells no temperature.
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
    fn every_duty_is_of_a_fault_that_exists() {
        let names = robot_plant::world::World::faults().iter().map(|f| f.name);
        let duties = names.map(|name| of(name).len()).sum::<usize>();
        // 8 of everything, 3 of CAN2, 2 hot wheels, 4 joints in 4 ways.
        assert_eq!(duties, 8 * 2 + 3 + 2 + 4 * 4);
    }
}
