//! Sitting down from standing.

use robot_app::domain::BalanceState;
use robot_plant::world::Terrain;

use super::{Bound, Finished, Task};
use crate::{Robots, trial::Trial};

/// Sitting down may take this long.
const LIMIT_S: f64 = 3.0;
/// For this long the robot is watched.
const WATCHED_S: f64 = 4.0;
/// From this tilt on safety takes a robot for fallen (the default of the setting `safety.max-tilt-rad`), rad.
const MAX_TILT_RAD: f64 = 0.9;
/// Speed of the body's turn, from one millisecond to the next, with which the robot lies still, rad/s.
const STILL_RPS: f64 = 0.2;

pub(super) const SIT_DOWN: Task = Task {
    name: "sit-down",
    what: "sits down on its edge and stays armed",
    figure: "speed at which the body touches",
    unit: "rad/s",
    limit: 4.0,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: sit_down,
    bisection: None,
};

fn sit_down(robots: &Robots, seed: u64) -> Finished {
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        trial.ask_to_sit();
        let begun_s = trial.now().t_s;
        let (mut touched, mut sits_at_s) = (None, None);
        let mut before_rad = trial.now().rpy_rad[1];
        let mut turn_rps = 0.0;
        for tick in 1..=(WATCHED_S * 1e3) as u32 {
            trial.run_until(begun_s + f64::from(tick) * 1e-3);
            let now = trial.now();
            let before_rps = turn_rps;
            turn_rps = (now.rpy_rad[1] - before_rad) / 1e-3;
            before_rad = now.rpy_rad[1];
            if now.body_n > 0.0 {
                touched = touched.or(Some(f64::abs(before_rps)));
            }
            let state = trial.robot().diagnostics().balance.state;
            if state == BalanceState::Sit {
                sits_at_s = sits_at_s.or(Some(now.t_s));
            }
        }
        if !trial.robot().armed() {
            return Err(trial.failed(trial.stopped_by()));
        }
        if trial.now().tilt_rad() > MAX_TILT_RAD || turn_rps.abs() > STILL_RPS {
            return Err(trial.failed("does not sit still".to_owned()));
        }
        match (touched, sits_at_s) {
            (Some(touched), Some(at_s)) if at_s - begun_s <= LIMIT_S => Ok(touched),
            _ => Err(trial.failed("has not sat down".to_owned())),
        }
    })
}
