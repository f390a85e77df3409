//! Pushes in one instant.

use robot_plant::world::Terrain;

use super::{Bound, Finished, Task};
use crate::{
    Robots,
    course::Ripple,
    limit::Bisection,
    trial::{Failure, Trial},
};

/// Change of speed that a push along the wheels gives, m/s.
const PUSH_MPS: f64 = 1.5;
/// The same for a push at 45°.
const DIAGONAL_MPS: f64 = 0.75;
/// The robot must have recovered after this.
const RECOVERS_S: f64 = 1.0;
/// Largest difference of the speed from that before, m/s.
const SPEED_MPS: f64 = 0.05;

pub(super) const PUSH: Task = Task {
    name: "push",
    what: "is pushed by 1.5 m/s along its wheels, within 5 cm/s and 2° after 1 s",
    figure: "pitch error after 1 s",
    unit: "°",
    limit: 2.0,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: push,
    bisection: Some(&Bisection {
        what: "push along the wheels that half survive",
        unit: "m/s",
        from: 0.5,
        to: 4.0,
        survives: survives_push,
    }),
};

pub(super) const PUSH_DIAGONAL: Task = Task {
    name: "push-diagonal",
    what: "is pushed by 0.75 m/s at 45°, within 5 cm/s and 2° after 1 s",
    figure: "pitch error after 1 s",
    unit: "°",
    limit: 2.0,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: push_diagonal,
    bisection: None,
};

fn push(robots: &Robots, seed: u64) -> Finished {
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        recover(trial, along_wheels(seed, PUSH_MPS))
    })
}

fn push_diagonal(robots: &Robots, seed: u64) -> Finished {
    let part = DIAGONAL_MPS * std::f64::consts::FRAC_1_SQRT_2;
    let ahead = if seed & 1 == 0 { part } else { -part };
    let left = if seed & 2 == 0 { part } else { -part };
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        recover(trial, [ahead, left, 0.0])
    })
}

/// Even seeds are pushed from behind, odd ones from the front.
fn along_wheels(seed: u64, mps: f64) -> [f64; 3] {
    let sign = if seed.is_multiple_of(2) { 1.0 } else { -1.0 };
    [sign * mps, 0.0, 0.0]
}

fn recover(trial: &mut Trial, change_mps: [f64; 3]) -> Result<f64, Failure> {
    let (mut pitch, mut speed) = (Ripple::default(), Ripple::default());
    trial.watch(0.5, |sample| {
        pitch.add(sample.rpy_rad[1]);
        speed.add(sample.forward_mps);
    });
    trial.push(change_mps);
    trial.watch(RECOVERS_S, |_| ());
    trial.require_upright()?;
    let now = *trial.now();
    // What counts is where it stays, so that 0.1 s decide.
    let (mut pitch_off, mut speed_off) = (0.0_f64, 0.0_f64);
    let (pitch_before, speed_before) = (pitch.mean(), speed.mean());
    trial.watch(0.1, |sample| {
        pitch_off = pitch_off.max((sample.rpy_rad[1] - pitch_before).abs());
        speed_off = speed_off.max((sample.forward_mps - speed_before).abs());
    });
    trial.watch(1.4, |_| ());
    trial.require_upright()?;
    if speed_off > SPEED_MPS {
        return Err(crate::Failure {
            at_s: now.t_s,
            what: format!("{speed_off:.2} m/s off after 1 s"),
        });
    }
    Ok(pitch_off.to_degrees())
}

fn survives_push(robots: &Robots, seed: u64, mps: f64) -> bool {
    let Ok(mut trial) = Trial::standing(robots, seed, Terrain::Flat) else {
        return false;
    };
    trial.push(along_wheels(seed, mps));
    trial.watch(2.5, |_| ());
    trial.require_upright().is_ok()
}
