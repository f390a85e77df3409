//! Falls that no controller could prevent.

use robot_plant::world::Terrain;

use super::{Bound, Finished, Task};
use crate::{Robots, trial::Trial};

/// A push of this many metres a second along the wheels throws every robot.
const THROWN_MPS: f64 = 8.0;
/// From this tilt on the robot has fallen (the default of the setting `safety.max-tilt-rad`), rad.
const MAX_TILT_RAD: f64 = 0.9;
/// The estimate may be off by this, rad.
const ESTIMATE_RAD: f64 = 0.1;

pub(super) const LOST: Task = Task {
    name: "lost",
    what: "is pushed by 8 m/s, falls, and has no torque before its body hits the ground",
    figure: "torque after the tilt limit",
    unit: "ms",
    // 50 ms to be sure of a tilt (docs/safety.md), one period of the joints, and the motors' own delays.
    limit: 80.0,
    bound: Bound::AtMost,
    wanted: 0.99,
    run: lost,
    bisection: None,
};

fn lost(robots: &Robots, seed: u64) -> Finished {
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        let sign = if seed.is_multiple_of(2) { 1.0 } else { -1.0 };
        trial.push([sign * THROWN_MPS, 0.0, 0.0]);
        let mut fallen_at_s = None;
        let mut torque_until_s = trial.now().t_s;
        let from_s = trial.now().t_s;
        let mut hits_at_s = f64::INFINITY;
        for tick in 1..=3_000 {
            trial.run_until(from_s + f64::from(tick) * 1e-3);
            let now = trial.now();
            if now.tilt_rad() > MAX_TILT_RAD + ESTIMATE_RAD {
                fallen_at_s = fallen_at_s.or(Some(now.t_s));
            }
            if now.body_n > 0.0 {
                hits_at_s = hits_at_s.min(now.t_s);
            }
            if has_torque(trial) {
                torque_until_s = now.t_s;
            }
        }
        if torque_until_s >= hits_at_s {
            return Err(trial.failed("has torque when its body hits the ground".to_owned()));
        }
        match fallen_at_s {
            None => Err(trial.failed("did not fall".to_owned())),
            Some(fallen_at_s) => Ok(1_000.0 * (torque_until_s - fallen_at_s).max(0.0)),
        }
    })
}

const ENABLED: [&str; 4] = [
    "can.joint.0.enabled",
    "can.joint.1.enabled",
    "can.joint.2.enabled",
    "can.joint.3.enabled",
];

/// Whether any motor may give torque, as read from the wires.
fn has_torque(trial: &Trial) -> bool {
    let robot = trial.robot();
    robot.wheel_currents_ma() != [0.0; 2] || ENABLED.iter().any(|name| robot.signal(name) != 0.0)
}
