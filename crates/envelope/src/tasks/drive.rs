//! Driving and turning.

use robot_plant::world::Terrain;

use super::{Bound, Finished, Task};
use crate::{
    Robots,
    trial::{Failure, Trial},
};

/// A stick all the way must give at least this share of the speed.
const REACHED: f64 = 0.95;
/// Speed of a robot that has stopped, m/s.
const STOPPED_MPS: f64 = 0.1;
/// Turn rate of one that has, rad/s.
const STOPPED_RPS: f64 = 0.2;
/// Full speed and full turn rate that are asked of the robot.
const FULL_MPS: f64 = 2.5;
const FULL_RPS: f64 = 8.0;
const SPEEDS_UP_S: f64 = 4.0;
const STOPS_S: f64 = 3.0;

pub(super) const DRIVE: Task = Task {
    name: "drive",
    what: "drives to 2.5 m/s and stops",
    figure: "overshoot",
    unit: "%",
    limit: 15.0,
    bound: Bound::AtMost,
    wanted: 0.995,
    run: drive,
    bisection: None,
};

pub(super) const SPIN: Task = Task {
    name: "spin",
    what: "turns on the spot at 8 rad/s and stops",
    figure: "overshoot",
    unit: "%",
    limit: 15.0,
    bound: Bound::AtMost,
    wanted: 0.995,
    run: spin,
    bisection: None,
};

fn drive(robots: &Robots, seed: u64) -> Finished {
    let share = FULL_MPS / robots.robot.control.limits.max_speed_mps;
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        full_speed(trial, (share, 0.0), FULL_MPS, STOPPED_MPS, |sample| {
            sample.forward_mps
        })
    })
}

fn spin(robots: &Robots, seed: u64) -> Finished {
    let share = FULL_RPS / robots.robot.control.limits.max_yaw_rps;
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        full_speed(trial, (0.0, share), FULL_RPS, STOPPED_RPS, |sample| {
            sample.yaw_rps
        })
    })
}

/// Overshoot of speeding up and of stopping, whichever is worse, in per cent of the full speed.
fn full_speed(
    trial: &mut Trial,
    (forward, left): (f64, f64),
    full: f64,
    stopped: f64,
    speed: impl Fn(&crate::Sample) -> f64,
) -> Result<f64, Failure> {
    trial.sticks(forward, left);
    let mut fastest = f64::NEG_INFINITY;
    trial.watch(SPEEDS_UP_S, |sample| fastest = fastest.max(speed(sample)));
    trial.require_upright()?;
    let reached = speed(trial.now());
    if reached < REACHED * full {
        return Err(trial.failed(format!("reached {reached:.2} of {full:.2}")));
    }
    trial.sticks(0.0, 0.0);
    let mut slowest = f64::INFINITY;
    trial.watch(STOPS_S, |sample| slowest = slowest.min(speed(sample)));
    trial.require_upright()?;
    let left = speed(trial.now());
    if left.abs() > stopped {
        return Err(trial.failed(format!("still at {left:.2}")));
    }
    Ok(100.0 * (fastest - full).max(-slowest).max(0.0) / full)
}
