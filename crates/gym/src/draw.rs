//! The draw of a robot and of the beginning of its episode.

use std::path::Path;

use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use robot_policy::PolicyDescription;

use crate::{
    GymError, Options, StartKind,
    specimen::{Beginning, Specimen},
};

/// Share of episodes that begin sitting, if both are wanted.
const SITS_IN: f64 = 0.5;
/// Greatest speeds in m/s, and pitch rate in rad/s, of a robot that begins standing.
const MOVING_MPS: f64 = 0.5;
const PITCHING_RPS: f64 = 0.5;
/// Draws of a robot that arms.
const MOST_DRAWS: usize = 20;

/// Returns the robot of the next episode.
pub(crate) fn start(
    specimen: &mut Specimen,
    numbers: &mut Pcg64Mcg,
    options: &Options,
) -> Result<Beginning, GymError> {
    let sits = match options.start {
        _ if options.built_in => true,
        StartKind::Sitting => true,
        StartKind::Standing => false,
        StartKind::Mixed => numbers.random_bool(SITS_IN),
    };
    if sits {
        return specimen.sitting();
    }
    let velocity = [MOVING_MPS, MOVING_MPS / 2.0].map(|most| between(numbers, -most, most));
    let pitch_rps = between(numbers, -PITCHING_RPS, PITCHING_RPS);
    specimen.standing(velocity, pitch_rps)
}

pub(crate) fn between(numbers: &mut Pcg64Mcg, low: f64, high: f64) -> f64 {
    low + (high - low) * numbers.random::<f64>()
}

/// Boots robots until one arms: one in fifty sits so steeply that its firmware takes it for fallen.
pub(crate) fn draw(
    policy: &PolicyDescription,
    numbers: &mut Pcg64Mcg,
    vary: bool,
    elf: Option<&Path>,
) -> Result<Specimen, GymError> {
    let mut boot = || {
        let seed = numbers.random();
        let Some(elf) = elf else {
            return Specimen::boot(policy, seed, vary);
        };
        #[cfg(feature = "board")]
        return Specimen::boot_board(policy, seed, vary, elf);
        #[cfg(not(feature = "board"))]
        {
            let _ = elf;
            Err(GymError::NoBoard)
        }
    };
    let mut last = boot();
    for _ in 0..MOST_DRAWS {
        if matches!(last, Ok(_) | Err(GymError::Board(_) | GymError::NoBoard)) {
            break;
        }
        last = boot();
    }
    last
}
