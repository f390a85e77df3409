//! What a sample says of balancing, in two words.
//!
//! | byte | holds |
//! |---|---|
//! | 0 | state (3 bits), request to stand (3), airborne, slipping |
//! | 1 | part of standing up (2 bits) |
//! | 2, 3 | length of the left and the right leg in 1/500 m |
//! | 4, 5 | lean of the left and the right leg in 1/80 rad |
//! | 6, 7 | force of the left and the right wheel on the ground in 2 N |

use super::fixed_point::{fixed_byte, positive_byte};
use crate::{
    diagnostics::DiagnosticsSnapshot,
    domain::{BalanceState, BalanceStatus, StandPermit, StandUpPhase},
};

const LEG_STEPS: f32 = 500.0;
const LEAN_STEPS: f32 = 80.0;
const FORCE_STEPS: f32 = 0.5;
/// Largest state and request to stand that fit in their bits.
const MOST_CODE: u8 = 7;
const AIRBORNE: u8 = 1 << 6;
const SLIPPING: u8 = 1 << 7;

/// The last of each fits.
const _: () = assert!(
    BalanceState::CannotRise as u8 <= MOST_CODE && StandPermit::Standing as u8 <= MOST_CODE
);

/// The balance controller at one instant. Legs are recorded up to 0.51 m, leans up to ±1.6 rad and forces up to 510 N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BalanceSample {
    /// State of the controller.
    pub status: BalanceStatus,
    /// How far the pilot's request to stand has come.
    pub stand: StandPermit,
}

impl BalanceSample {
    pub(super) const fn of(report: &DiagnosticsSnapshot) -> Self {
        Self {
            status: report.balance,
            stand: report.safety.stand,
        }
    }

    pub(super) fn words(&self) -> [u32; 2] {
        let status = &self.status;
        let marks =
            if status.airborne { AIRBORNE } else { 0 } | if status.slipping { SLIPPING } else { 0 };
        let [left_m, right_m] = status.leg_m.map(|length| positive_byte(length, LEG_STEPS));
        let [left, right] = status.lean_rad.map(|lean| fixed_byte(lean, LEAN_STEPS));
        let [left_n, right_n] = status
            .contact_n
            .map(|force| positive_byte(force, FORCE_STEPS));
        let code = status.state as u8 | (self.stand as u8) << 3 | marks;
        [
            u32::from_le_bytes([code, status.phase as u8, left_m, right_m]),
            u32::from_le_bytes([left, right, left_n, right_n]),
        ]
    }

    pub(super) fn of_words([first, second]: [u32; 2]) -> Self {
        let [code, phase, left_m, right_m] = first.to_le_bytes();
        let [left, right, left_n, right_n] = second.to_le_bytes();
        Self {
            status: BalanceStatus {
                state: state_of(code & MOST_CODE),
                phase: phase_of(phase),
                airborne: code & AIRBORNE != 0,
                slipping: code & SLIPPING != 0,
                leg_m: [left_m, right_m].map(|steps| f32::from(steps) / LEG_STEPS),
                lean_rad: [left, right].map(|steps| f32::from(steps.cast_signed()) / LEAN_STEPS),
                contact_n: [left_n, right_n].map(|steps| f32::from(steps) / FORCE_STEPS),
            },
            stand: stand_of(code >> 3 & MOST_CODE),
        }
    }
}

fn state_of(code: u8) -> BalanceState {
    match code {
        1 => BalanceState::StandUp,
        2 => BalanceState::Balance,
        3 => BalanceState::Jump,
        4 => BalanceState::SitDown,
        5 => BalanceState::Fallen,
        6 => BalanceState::CannotRise,
        _ => BalanceState::Sit,
    }
}

fn stand_of(code: u8) -> StandPermit {
    match code {
        1 => StandPermit::Ready,
        2 => StandPermit::Requested,
        3 => StandPermit::StandingUp,
        4 => StandPermit::Standing,
        _ => StandPermit::SwitchMustGoDown,
    }
}

fn phase_of(code: u8) -> StandUpPhase {
    match code {
        1 => StandUpPhase::Fold,
        2 => StandUpPhase::Erect,
        3 => StandUpPhase::Extend,
        _ => StandUpPhase::None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(sample: BalanceSample) -> BalanceSample {
        BalanceSample::of_words(sample.words())
    }

    #[test]
    fn every_state_survives_its_words() {
        use BalanceState::{Balance, CannotRise, Fallen, Jump, Sit, SitDown, StandUp};
        use StandPermit::{Ready, Requested, Standing, StandingUp, SwitchMustGoDown};
        use StandUpPhase::{Erect, Extend, Fold, None};
        for state in [Sit, StandUp, Balance, Jump, SitDown, Fallen, CannotRise] {
            for stand in [SwitchMustGoDown, Ready, Requested, StandingUp, Standing] {
                for (phase, marks) in [(None, 0), (Fold, 1), (Erect, 2), (Extend, 3)] {
                    let status = BalanceStatus {
                        state,
                        phase,
                        airborne: marks & 1 != 0,
                        slipping: marks & 2 != 0,
                        leg_m: [0.11, 0.3],
                        lean_rad: [-1.5, 0.05],
                        contact_n: [0.0, 62.0],
                    };
                    let sample = BalanceSample { status, stand };
                    assert_eq!(kept(sample), sample);
                }
            }
        }
    }

    #[test]
    fn values_beyond_the_range_become_its_ends() {
        let wild = BalanceStatus {
            leg_m: [9.0, -1.0],
            lean_rad: [3.0, f32::NAN],
            contact_n: [1e9, f32::NAN],
            ..BalanceStatus::default()
        };
        let sample = BalanceSample {
            status: wild,
            ..BalanceSample::default()
        };
        let found = kept(sample).status;
        assert_eq!(found.leg_m, [0.51, 0.0]);
        assert_eq!(found.lean_rad, [127.0 / 80.0, 0.0]);
        assert_eq!(found.contact_n, [510.0, 0.0]);
    }
}
