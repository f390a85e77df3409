//! No flash step may begin while the robot is armed or about to arm.

use robot_plant::time::{MS, Ps, to_seconds};

use crate::machine::{
    Machine,
    flash::{FlashStep, FlashStepKind},
};

/// Least time at rest before a step: half a second less the resolution of the soak's grid.
const REST: Ps = 490 * MS;
/// Time after a reset in which the image may program again what a power cut has left half programmed.
const BOOT_WORK: Ps = 100 * MS;
/// Time until the firmware has seen the switch and has ended a record that had begun.
const SWITCH_SEEN: Ps = 40 * MS;

/// An erase takes a quarter of a second; then its sector is read and marked, which is the same step.
const ERASE_STEP: Ps = 300 * MS;

/// The state of the robot that decides whether flash may be written.
#[derive(Clone, Copy, Debug)]
pub struct RobotState {
    /// Whether the firmware reported to be armed, a millisecond ago and now.
    pub armed: bool,
    pub last_armed: Option<Ps>,
    pub booted: Ps,
    /// Time at which the enable switch went on, if the firmware receives it.
    pub enabled: Option<Ps>,
}

/// Checks each flash step once.
#[derive(Debug, Default)]
pub struct FlashAtRest {
    /// Number of steps that were checked.
    judged: usize,
    /// Time at which the last erase began.
    erase: Option<Ps>,
}

impl FlashAtRest {
    /// The violation by the first new step that was not allowed.
    pub fn check(&mut self, machine: &Machine, state: &RobotState) -> Option<String> {
        let steps = machine.flash_steps();
        let new = steps.get(self.judged..).unwrap_or_default();
        self.judged = steps.len();
        let wrong = new.iter().find_map(|step| {
            if step.kind == FlashStepKind::Erase {
                self.erase = Some(step.at);
            }
            Some((step, violation(step, self.erase, state)?))
        });
        wrong.map(|(step, why)| {
            let FlashStep { at, kind, address } = step;
            let at = to_seconds(*at);
            format!("flash: {kind:?} of {address:#010x} at {at:.4} s, {why}")
        })
    }
}

fn violation(step: &FlashStep, erase: Option<Ps>, state: &RobotState) -> Option<&'static str> {
    let within = |from: Ps, time: Ps| (from..from + time).contains(&step.at);
    let programs = step.kind == FlashStepKind::Program;
    if state.armed {
        return Some("armed");
    }
    if programs && within(state.booted, BOOT_WORK) {
        return None;
    }
    if within(state.booted, REST) {
        return Some("right after the boot");
    }
    let armed = state.last_armed.filter(|at| *at > state.booted);
    if armed.is_some_and(|armed| step.at < armed + REST) {
        return Some("armed a moment ago");
    }
    let enabled = state.enabled.filter(|at| *at > state.booted);
    let begun = erase.filter(|erase| step.at < erase + ERASE_STEP);
    enabled
        .is_some_and(|at| begun.unwrap_or(step.at) > at + SWITCH_SEEN)
        .then_some("the enable switch is on")
}

#[cfg(test)]
mod tests {
    use super::*;

    const RESTING: RobotState = RobotState {
        armed: false,
        last_armed: Some(1_000 * MS),
        booted: 0,
        enabled: None,
    };

    fn is_fine(kind: FlashStepKind, ms: Ps, state: RobotState) -> bool {
        let step = FlashStep {
            at: ms * MS,
            kind,
            address: 0x0800_4000,
        };
        violation(&step, Some(2_950 * MS), &state).is_none()
    }

    #[test]
    fn flash_is_worked_on_after_half_a_second_of_rest_only() {
        use FlashStepKind::{Erase, Program};
        assert!(is_fine(Program, 1_500, RESTING));
        assert!(!is_fine(Program, 1_400, RESTING));
        let armed = RobotState {
            armed: true,
            ..RESTING
        };
        assert!(!is_fine(Program, 9_000, armed));
        let booted = RobotState {
            booted: 2_000 * MS,
            ..RESTING
        };
        assert!(is_fine(Program, 2_050, booted));
        assert!(!is_fine(Erase, 2_050, booted));
        assert!(!is_fine(Program, 2_200, booted));
        let enabled = RobotState {
            enabled: Some(3_000 * MS),
            ..RESTING
        };
        assert!(
            is_fine(Program, 3_210, enabled),
            "what belongs to the erase"
        );
        assert!(!is_fine(Program, 3_300, enabled));
    }
}
