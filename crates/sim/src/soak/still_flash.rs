//! Flash is left alone while the robot is armed or may be in a moment.

use robot_plant::time::{MS, Ps, to_seconds};

use crate::machine::{
    Machine,
    flash::{FlashStep, FlashStepKind},
};

/// Rest before a step: half a second, of which the soak's grid hides a little.
const REST: Ps = 490 * MS;
/// From the reset on, what a power cut left half programmed is made to last.
const BOOT_WORK: Ps = 100 * MS;
/// The switch's way to the firmware, and a record that has begun.
const SWITCH_SEEN: Ps = 40 * MS;

/// An erase takes a quarter of a second; then its sector is read and marked, which is the same step.
const ERASE_STEP: Ps = 300 * MS;

/// What the rule looks at besides the flash.
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    /// By the firmware's word, a millisecond ago and now.
    pub armed: bool,
    pub last_armed: Option<Ps>,
    pub booted: Ps,
    /// The pilot wants to drive since then, and the firmware hears it.
    pub enabled: Option<Ps>,
}

#[derive(Debug, Default)]
pub struct StillFlash {
    /// Steps.
    judged: usize,
    /// When the last one began.
    erase: Option<Ps>,
}

impl StillFlash {
    /// The first new step that had to wait.
    pub fn look(&mut self, machine: &Machine, rest: &Rest) -> Option<String> {
        let steps = machine.flash_steps();
        let new = steps.get(self.judged..).unwrap_or_default();
        self.judged = steps.len();
        let wrong = new.iter().find_map(|step| {
            if step.kind == FlashStepKind::Erase {
                self.erase = Some(step.at);
            }
            Some((step, objection(step, self.erase, rest)?))
        });
        wrong.map(|(step, why)| {
            let FlashStep { at, kind, address } = step;
            let at = to_seconds(*at);
            format!("flash: {kind:?} of {address:#010x} at {at:.4} s, {why}")
        })
    }
}

fn objection(step: &FlashStep, erase: Option<Ps>, rest: &Rest) -> Option<&'static str> {
    let within = |from: Ps, time: Ps| (from..from + time).contains(&step.at);
    let programs = step.kind == FlashStepKind::Program;
    if rest.armed {
        return Some("armed");
    }
    if programs && within(rest.booted, BOOT_WORK) {
        return None;
    }
    if within(rest.booted, REST) {
        return Some("right after the boot");
    }
    let armed = rest.last_armed.filter(|at| *at > rest.booted);
    if armed.is_some_and(|armed| step.at < armed + REST) {
        return Some("armed a moment ago");
    }
    let enabled = rest.enabled.filter(|at| *at > rest.booted);
    let begun = erase.filter(|erase| step.at < erase + ERASE_STEP);
    enabled
        .is_some_and(|at| begun.unwrap_or(step.at) > at + SWITCH_SEEN)
        .then_some("the enable switch is on")
}

#[cfg(test)]
mod tests {
    use super::*;

    const CALM: Rest = Rest {
        armed: false,
        last_armed: Some(1_000 * MS),
        booted: 0,
        enabled: None,
    };

    fn is_fine(kind: FlashStepKind, ms: Ps, rest: Rest) -> bool {
        let step = FlashStep {
            at: ms * MS,
            kind,
            address: 0x0800_4000,
        };
        objection(&step, Some(2_950 * MS), &rest).is_none()
    }

    #[test]
    fn flash_is_worked_on_after_half_a_second_of_rest_only() {
        use FlashStepKind::{Erase, Program};
        assert!(is_fine(Program, 1_500, CALM));
        assert!(!is_fine(Program, 1_400, CALM));
        let armed = Rest {
            armed: true,
            ..CALM
        };
        assert!(!is_fine(Program, 9_000, armed));
        let booted = Rest {
            booted: 2_000 * MS,
            ..CALM
        };
        assert!(is_fine(Program, 2_050, booted));
        assert!(!is_fine(Erase, 2_050, booted));
        assert!(!is_fine(Program, 2_200, booted));
        let enabled = Rest {
            enabled: Some(3_000 * MS),
            ..CALM
        };
        assert!(
            is_fine(Program, 3_210, enabled),
            "what belongs to the erase"
        );
        assert!(!is_fine(Program, 3_300, enabled));
    }
}
