//! Slopes, ramps and steps.

use robot_plant::world::Terrain;

use super::{Bound, Finished, Task};
use crate::{
    Robots,
    trial::{Failure, Trial},
};

const SLOPE_RAD: f64 = 15.0 * std::f64::consts::PI / 180.0;
const RAMP_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// Where each course begins, m ahead of the start.
const BEGINS_M: f64 = 1.5;
const STEP_DOWN_M: f64 = 0.15;
const STEP_UP_M: f64 = 0.04;
const DROP_M: f64 = 0.28;
const GRAVITY_MPS2: f64 = 9.80665;

pub(super) const SLOPE: Task = Task {
    name: "slope",
    what: "drives up 15° at 0.6 m/s, stands there for 3 s, and comes back",
    figure: "roll",
    unit: "rad",
    limit: 0.15,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: slope,
    bisection: None,
};

pub(super) const RAMP: Task = Task {
    name: "ramp",
    what: "drives over a ramp of 10° under one wheel at 1 m/s",
    figure: "roll",
    unit: "rad",
    limit: 0.15,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: ramp,
    bisection: None,
};

pub(super) const STEP_DOWN: Task = Task {
    name: "step-down",
    what: "drives off a step of 0.15 m at 1 m/s",
    figure: "pitch",
    unit: "°",
    limit: 40.0,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: step_down,
    bisection: None,
};

pub(super) const STEP_UP: Task = Task {
    name: "step-up",
    what: "drives up a step of 0.04 m at 1 m/s",
    figure: "pitch",
    unit: "°",
    limit: 40.0,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: step_up,
    bisection: None,
};

pub(super) const DROP: Task = Task {
    name: "drop",
    what: "is thrown up by 0.28 m and lands",
    figure: "pitch",
    unit: "°",
    limit: 40.0,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: drop,
    bisection: None,
};

/// Stick for a speed.
fn share(robots: &Robots, mps: f64) -> f64 {
    mps / robots.robot.control.limits.max_speed_mps
}

fn slope(robots: &Robots, seed: u64) -> Finished {
    let terrain = Terrain::Slope {
        start_m: BEGINS_M,
        angle_rad: SLOPE_RAD,
        length_m: 6.0,
    };
    let share = share(robots, 0.6);
    Finished::standing(Trial::standing(robots, seed, terrain), |trial| {
        let mut roll_rad = 0.0_f64;
        trial.sticks(share, 0.0);
        trial.watch(5.0, |sample| {
            roll_rad = roll_rad.max(sample.rpy_rad[0].abs())
        });
        trial.sticks(0.0, 0.0);
        trial.watch(2.0, |sample| {
            roll_rad = roll_rad.max(sample.rpy_rad[0].abs())
        });
        trial.require_upright()?;
        if trial.now().place_m[0] < BEGINS_M + 0.3 {
            return Err(trial.failed("never came up".to_owned()));
        }
        let from_m = trial.now().place_m[0];
        trial.watch(3.0, |sample| {
            roll_rad = roll_rad.max(sample.rpy_rad[0].abs())
        });
        trial.require_upright()?;
        let rolled_m = (trial.now().place_m[0] - from_m).abs();
        if rolled_m > 0.3 {
            return Err(trial.failed(format!("rolled by {rolled_m:.2} m while it should stand")));
        }
        trial.sticks(-share, 0.0);
        trial.watch(5.0, |_| ());
        trial.sticks(0.0, 0.0);
        trial.watch(2.0, |_| ());
        trial.require_upright()?;
        Ok(roll_rad)
    })
}

fn ramp(robots: &Robots, seed: u64) -> Finished {
    let terrain = Terrain::OneSidedRamp {
        start_m: BEGINS_M,
        angle_rad: RAMP_RAD,
        height_m: 0.12,
        top_m: 0.5,
    };
    let share = share(robots, 1.0);
    Finished::standing(Trial::standing(robots, seed, terrain), |trial| {
        let mut roll_rad = 0.0_f64;
        trial.sticks(share, 0.0);
        trial.watch(5.0, |sample| {
            roll_rad = roll_rad.max(sample.rpy_rad[0].abs())
        });
        trial.require_upright()?;
        arrived(trial, BEGINS_M + 1.0)?;
        Ok(roll_rad)
    })
}

fn step_down(robots: &Robots, seed: u64) -> Finished {
    step(robots, seed, -STEP_DOWN_M)
}

fn step_up(robots: &Robots, seed: u64) -> Finished {
    step(robots, seed, STEP_UP_M)
}

/// Largest pitch on the way over a step, in degrees.
fn step(robots: &Robots, seed: u64, height_m: f64) -> Finished {
    let terrain = Terrain::Step {
        at_m: BEGINS_M,
        height_m,
    };
    let share = share(robots, 1.0);
    Finished::standing(Trial::standing(robots, seed, terrain), |trial| {
        trial.sticks(share, 0.0);
        let mut pitch_rad = 0.0_f64;
        trial.watch(3.5, |sample| {
            pitch_rad = pitch_rad.max(sample.rpy_rad[1].abs())
        });
        trial.require_upright()?;
        trial.sticks(0.0, 0.0);
        trial.watch(2.0, |_| ());
        trial.require_upright()?;
        arrived(trial, BEGINS_M + 0.3)?;
        Ok(pitch_rad.to_degrees())
    })
}

/// It falls from where it has no speed any more.
fn drop(robots: &Robots, seed: u64) -> Finished {
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        trial.push([0.0, 0.0, (2.0 * GRAVITY_MPS2 * DROP_M).sqrt()]);
        let mut pitch_rad = 0.0_f64;
        trial.watch(2.5, |sample| {
            pitch_rad = pitch_rad.max(sample.rpy_rad[1].abs())
        });
        trial.require_upright()?;
        Ok(pitch_rad.to_degrees())
    })
}

fn arrived(trial: &Trial, at_m: f64) -> Result<(), Failure> {
    let [x_m, ..] = trial.now().place_m;
    if x_m < at_m {
        return Err(trial.failed(format!("only {x_m:.2} m of {at_m:.2} m")));
    }
    Ok(())
}
