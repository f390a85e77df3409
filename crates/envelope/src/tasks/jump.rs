//! Jumping.

use robot_plant::world::{RemoteInput, Terrain};

use super::{Bound, Finished, Task};
use crate::{Robots, trial::Trial};

pub(super) const JUMP: Task = Task {
    name: "jump",
    what: "jumps on the spot and lands",
    figure: "height of the lower wheel",
    unit: "m",
    limit: 0.15,
    bound: Bound::AtLeast,
    wanted: 0.99,
    run: jump,
    bisection: None,
};

/// The wheels are round and the ground is level, so a wheel is as high as the hips less the legs' vertical extent.
fn jump(robots: &Robots, seed: u64) -> Finished {
    let radius_m = robots.robot.wheels.radius_m;
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        trial.pilot(RemoteInput {
            jump: Some(true),
            ..RemoteInput::default()
        });
        let mut clear_m = 0.0_f64;
        trial.watch(2.5, |sample| {
            let longest_m = sample.leg_m[0].max(sample.leg_m[1]);
            clear_m = clear_m.max(sample.place_m[2] - longest_m - radius_m);
        });
        trial.require_upright()?;
        Ok(clear_m)
    })
}
