//! Standing up from wherever it lies.

use robot_app::safety::SafetyFlags;
use robot_plant::world::{Start, Terrain};

use super::{Bound, Finished, Task};
use crate::{
    Robots,
    trial::{STAND_AT_S, Trial},
};

/// The robot must stand after this.
const LIMIT_S: f64 = 2.5;
/// For this long it is watched.
const WATCHED_S: f64 = 5.0;
/// It must have stood for this long at the end.
const STANDS_S: f64 = 1.0;
/// A robot that cannot stand up has no torque after this, ms.
const REFUSED_MS: f64 = 20.0;
const HIPS: [&str; 4] = [
    "truth.joint.0.torque_nm",
    "truth.joint.1.torque_nm",
    "truth.joint.2.torque_nm",
    "truth.joint.3.torque_nm",
];
/// A hip's motor gives no torque below this, N·m.
const HIP_NM: f64 = 0.05;
/// Tilt of a robot that stands, rad.
const UPRIGHT_RAD: f64 = 0.2;
/// Speed of one that stands, m/s.
const STILL_MPS: f64 = 0.5;

macro_rules! stand_up {
    ($name:literal, $what:literal, $start:expr) => {
        Task {
            name: $name,
            what: $what,
            figure: "time until it stands",
            unit: "s",
            limit: LIMIT_S,
            bound: Bound::AtMost,
            wanted: 0.99,
            run: |robots, seed| stand_up(robots, seed, $start),
            bisection: None,
        }
    };
}

pub(super) const SITTING: Task =
    stand_up!("stand-up-sitting", "stands up from sitting", Start::Sitting);
pub(super) const FOLDED: Task = stand_up!(
    "stand-up-folded",
    "stands up with folded legs",
    Start::Folded
);
pub(super) const FRONT: Task =
    stand_up!("stand-up-front", "stands up from its front", Start::Front);
pub(super) const BACK: Task = stand_up!("stand-up-back", "stands up from its back", Start::Back);
macro_rules! refused {
    ($name:literal, $what:literal, $start:expr) => {
        Task {
            name: $name,
            what: $what,
            figure: "torque after arming",
            unit: "ms",
            limit: REFUSED_MS,
            bound: Bound::AtMost,
            wanted: 0.99,
            run: |robots, seed| refused(robots, seed, $start),
            bisection: None,
        }
    };
}

// No manoeuvre is known from there (docs/balance.md#from-a-side-or-the-top).
pub(super) const LEFT: Task = refused!(
    "refuse-left",
    "lies on its left side and is refused at once",
    Start::Left
);
pub(super) const RIGHT: Task = refused!(
    "refuse-right",
    "lies on its right side and is refused at once",
    Start::Right
);
pub(super) const UPSIDE_DOWN: Task = refused!(
    "refuse-upside-down",
    "lies on its top and is refused at once",
    Start::UpsideDown
);

fn stand_up(robots: &Robots, seed: u64, start: Start) -> Finished {
    let trial = Trial::new(robots, seed, Terrain::Flat, start);
    let least_m = robots.robot.control.limits.height_m[0] - 0.01;
    Finished::by(trial, |trial| {
        trial.ask_to_get_up();
        let mut since_s = None;
        trial.watch(WATCHED_S, |sample| {
            let stands = sample.tilt_rad() < UPRIGHT_RAD
                && sample.body_n == 0.0
                && sample.leg_m.iter().all(|m| *m > least_m)
                && sample.forward_mps.abs() < STILL_MPS;
            since_s = if stands {
                since_s.or(Some(sample.t_s))
            } else {
                None
            };
        });
        trial.require_upright()?;
        match since_s {
            Some(since_s) if trial.now().t_s - since_s >= STANDS_S => Ok(since_s - STAND_AT_S),
            _ => Err(trial.failed("does not stand still".to_owned())),
        }
    })
}

/// Time in ms until a robot that asked for standing up has no torque.
fn refused(robots: &Robots, seed: u64, start: Start) -> Finished {
    let trial = Trial::new(robots, seed, Terrain::Flat, start);
    Finished::by(trial, |trial| {
        trial.ask_to_get_up();
        let mut torque_until_s = STAND_AT_S;
        for tick in 1..=1_000 {
            trial.run_until(STAND_AT_S + f64::from(tick) * 1e-3);
            let current_ma = trial.robot().wheel_currents_ma();
            let hips_nm = HIPS.map(|name| trial.robot().signal(name));
            if current_ma != [0.0; 2] || hips_nm.iter().any(|nm| nm.abs() > HIP_NM) {
                torque_until_s = trial.now().t_s;
            }
        }
        let flags = trial.robot().diagnostics().safety.flags;
        if trial.robot().armed() || !flags.intersects(SafetyFlags::STAND_UP_FAILED) {
            return Err(trial.failed("is not refused".to_owned()));
        }
        Ok(1_000.0 * (torque_until_s - STAND_AT_S))
    })
}
