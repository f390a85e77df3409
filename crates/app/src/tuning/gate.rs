//! Decides whether the tuning channel may change anything.

use crate::{domain::OperatorState, safety::ArmingState};

/// Whether writes are executed (docs/safety.md#the-rules, 6).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TuningGate {
    /// Writes are executed.
    Open,
    /// The robot is armed, or the enable switch is on. Writes are refused.
    Shut,
}

impl TuningGate {
    /// The gate's state for the present state of arming and switches.
    pub fn of(arming: ArmingState, operator: &OperatorState) -> Self {
        if arming == ArmingState::Disarmed && !operator.enabled {
            Self::Open
        } else {
            Self::Shut
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gate_is_open_only_with_the_switch_off_and_the_robot_disarmed() {
        for (arming, enabled, gate) in [
            (ArmingState::Disarmed, false, TuningGate::Open),
            (ArmingState::Disarmed, true, TuningGate::Shut),
            (ArmingState::Armed, false, TuningGate::Shut),
            (ArmingState::Armed, true, TuningGate::Shut),
        ] {
            let operator = OperatorState {
                enabled,
                ..OperatorState::default()
            };
            assert_eq!(TuningGate::of(arming, &operator), gate);
        }
    }
}
