//! Standing on the spot.

use robot_plant::world::Terrain;

use super::{Bound, Finished, Task};
use crate::{
    Robots,
    course::{Ripple, way_m},
    trial::Trial,
};

const STANDS_S: f64 = 60.0;
/// Largest ripple of the body's pitch, rad.
const RIPPLE_RAD: f64 = 0.3 * std::f64::consts::PI / 180.0;

pub(super) const STAND: Task = Task {
    name: "stand",
    what: "stands for 60 s with sticks centred, pitch within 0.3° rms",
    figure: "drift",
    unit: "m",
    limit: 0.05,
    bound: Bound::AtMost,
    wanted: 1.0,
    run: stand,
    bisection: None,
};

fn stand(robots: &Robots, seed: u64) -> Finished {
    Finished::standing(Trial::standing(robots, seed, Terrain::Flat), |trial| {
        // Another moment, as it has just stood up.
        trial.watch(2.0, |_| ());
        let start = *trial.now();
        let (mut ripple, mut drift_m) = (Ripple::default(), 0.0_f64);
        trial.watch(STANDS_S, |sample| {
            ripple.add(sample.rpy_rad[1]);
            drift_m = drift_m.max(way_m(&start, sample));
        });
        trial.require_upright()?;
        if ripple.rms() > RIPPLE_RAD {
            let deg = ripple.rms().to_degrees();
            return Err(trial.failed(format!("pitch has a ripple of {deg:.2}° rms")));
        }
        Ok(drift_m)
    })
}
