//! Falls: body, hips and knees hit the floor.

use std::cell::Cell;

use robot_description::Robot;
use robot_plant::free::{FreeBody, FreeSetup, FreeState, Start};
use serde_json::{Value, json};

use crate::{
    floor::{EVERY_S, Run, STEP_S, STIFF},
    oracle::{numbers, robot},
};

/// Assumptions of the plant about the body's shell and the stops of the hips.
const SHELL_DAMPING: f64 = 0.3;
const STOP_RAD: f64 = 0.02;
const STOP_NM_PER_RAD: f64 = 400.0;
const STOP_NM_PER_RPS: f64 = 1.3;

/// One moment of a fall.
struct Moment {
    place_m: [f64; 3],
    /// Body → world, scalar first.
    attitude: [f64; 4],
    energy_j: f64,
    /// What the floor has given to body and links so far.
    impulse_ns: f64,
}

/// A fall, with hips held by springs and dampers.
struct Fall {
    name: &'static str,
    state: FreeState,
    /// Nm/rad, Nm s/rad.
    hips: [f64; 2],
    seconds: f64,
}

impl Fall {
    fn run<'a>(&self, robot: &'a Robot) -> Run<'a> {
        Run {
            robot,
            state: self.state,
            hips: self.hips,
            wheel_nm: [0.0; 2],
            seconds: self.seconds,
        }
    }

    fn in_plant(&self, robot: &Robot) -> Vec<Moment> {
        let impulse_ns = Cell::new(0.0);
        let hit =
            |body: &FreeBody| impulse_ns.set(impulse_ns.get() + body.body_contact_n() * STEP_S);
        self.run(robot).in_plant(hit, |body| {
            let state = body.state();
            Moment {
                place_m: state.position_m,
                attitude: state.attitude,
                energy_j: body.energy_j(),
                impulse_ns: impulse_ns.get(),
            }
        })
    }

    fn in_mujoco(&self, robot: &Robot) -> Option<Vec<Moment>> {
        let run = self.run(robot);
        let mut question = run.question();
        run.soften_tyres(&mut question);
        let shell_n_per_mps = run.damping_n_per_mps(SHELL_DAMPING, robot.total_mass_kg() / 4.0);
        for (key, value) in [
            ("stop_rad", STOP_RAD),
            ("stop_nm_per_rad", STOP_NM_PER_RAD),
            ("stop_nm_per_rps", STOP_NM_PER_RPS),
            ("shell_n_per_m", run.n_per_m()),
            ("shell_n_per_mps", shell_n_per_mps),
        ] {
            question[key] = json!(value);
        }
        let rows = run.ask(self.name, "fall", question)?;
        Some(rows.iter().map(moment).collect())
    }
}

fn moment(row: &Value) -> Moment {
    let all = numbers(row);
    let of = |from: usize| -> [f64; 4] { std::array::from_fn(|n| all[from + n]) };
    Moment {
        place_m: [all[0], all[1], all[2]],
        attitude: of(3),
        energy_j: all[7],
        impulse_ns: all[8],
    }
}

/// Angle between two attitudes.
fn turned_rad(a: [f64; 4], b: [f64; 4]) -> f64 {
    let cos: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    2.0 * cos.abs().min(1.0).acos()
}

/// What a fall comes to.
#[derive(Debug)]
struct Outcome {
    first_hit_s: f64,
    rests_after_s: f64,
    lost_j: f64,
    /// The largest impulse within 20 ms.
    hit_ns: f64,
}

fn outcome(moments: &[Moment]) -> Outcome {
    let [first, .., last] = moments else {
        panic!("there are moments")
    };
    let near = |it: &Moment| {
        let moved = (0..3).any(|axis| (it.place_m[axis] - last.place_m[axis]).abs() > 3e-3);
        !moved && turned_rad(it.attitude, last.attitude) < 0.02
    };
    let hit = |window: &[Moment]| window[20].impulse_ns - window[0].impulse_ns;
    let first_hit = moments.iter().position(|it| it.impulse_ns > 0.0);
    let rests = moments.iter().rposition(|it| !near(it)).unwrap_or(0);
    Outcome {
        first_hit_s: first_hit.map_or(f64::NAN, |it| it as f64 * EVERY_S),
        rests_after_s: rests as f64 * EVERY_S,
        lost_j: first.energy_j - last.energy_j,
        hit_ns: moments.windows(21).map(hit).fold(0.0, f64::max),
    }
}

/// How far outcomes in the plant and in MuJoCo may be apart, beside those that are the same in all falls.
struct Limits {
    first_hit_s: f64,
    rests_after_s: f64,
    /// Share of the hardest hit.
    hit: f64,
    /// Place where it rests.
    way_m: f64,
}

/// Limits of most falls.
const MOST: Limits = Limits {
    first_hit_s: 5e-3,
    rests_after_s: 0.2,
    hit: 0.07,
    way_m: 0.02,
};
/// Share of the energy lost.
const LOST: f64 = 1e-3;
/// Height and tilt at rest.
const HEIGHT_M: f64 = 2e-4;
const TILT_RAD: f64 = 1e-3;

fn tilt_rad([_, x, y, _]: [f64; 4]) -> f64 {
    (1.0 - 2.0 * (x * x + y * y)).clamp(-1.0, 1.0).acos()
}

impl Fall {
    fn assert_as_in_mujoco(&self, robot: &Robot, most: &Limits) {
        let Some(there) = self.in_mujoco(robot) else {
            return;
        };
        let here = self.in_plant(robot);
        let (a, b) = (outcome(&here), outcome(&there));
        println!("{}: here {a:.3?}, in MuJoCo {b:.3?}", self.name);
        let (Some(here), Some(there)) = (here.last(), there.last()) else {
            panic!("there are moments");
        };
        let way_m = (0..2).map(|axis| here.place_m[axis] - there.place_m[axis]);
        for (what, apart, most) in [
            ("first hit", a.first_hit_s - b.first_hit_s, most.first_hit_s),
            (
                "rest",
                a.rests_after_s - b.rests_after_s,
                most.rests_after_s,
            ),
            ("energy lost", a.lost_j / b.lost_j - 1.0, LOST),
            ("hardest hit", a.hit_ns / b.hit_ns - 1.0, most.hit),
            ("height", here.place_m[2] - there.place_m[2], HEIGHT_M),
            (
                "tilt",
                tilt_rad(here.attitude) - tilt_rad(there.attitude),
                TILT_RAD,
            ),
            ("way", way_m.fold(0.0, f64::hypot), most.way_m),
        ] {
            println!("  {what}: {apart:.4} apart, at most {most}");
            assert!(apart.abs() < most, "{}: {what} is {apart} apart", self.name);
        }
    }
}

/// The small robot with wheels and a frame for which each of these falls has one end. Where it balances on an edge, a millimetre decides.
fn falling() -> Robot {
    let mut robot = robot("fivebar");
    robot.wheels.radius_m = 0.06;
    robot.wheels.mass_kg = 0.25;
    robot.wheels.inertia_kgm2 = 6.0e-4;
    robot.body.box_m[0] = 0.30;
    robot
}

fn standing(robot: &Robot) -> FreeState {
    let setup = FreeSetup {
        start: Start::Standing,
        ..FreeSetup::default()
    };
    FreeBody::new(robot, &setup).state()
}

/// In the air, with its origin at a height, turned about its forward axis and then about its own left one.
fn dropped(robot: &Robot, height_m: f64, [roll_rad, pitch_rad]: [f64; 2]) -> FreeState {
    let ((sr, cr), (sp, cp)) = ((roll_rad / 2.0).sin_cos(), (pitch_rad / 2.0).sin_cos());
    FreeState {
        position_m: [0.0, 0.0, height_m],
        attitude: [cr * cp, sr * cp, cr * sp, sr * sp],
        ..standing(robot)
    }
}

/// Both fall forward over their wheels, and rest on those and the front edge.
#[test]
fn a_robot_falls_on_its_front_as_in_mujoco() {
    let robot = falling();
    let state = FreeState {
        rate_rps: [0.0, 1.0, 0.0],
        velocity_mps: [0.25, 0.0, 0.0],
        ..standing(&robot)
    };
    let fall = Fall {
        name: "forward",
        state,
        hips: STIFF,
        seconds: 1.5,
    };
    fall.assert_as_in_mujoco(&robot, &MOST);
}

/// The legs give way, and knees and edge of the body hit the floor. What knees and edge get of the first hit depends on a millimetre.
#[test]
fn a_robot_with_limp_legs_collapses_as_in_mujoco() {
    let robot = falling();
    let state = FreeState {
        rate_rps: [0.0, 0.8, 0.0],
        velocity_mps: [0.2, 0.0, 0.0],
        ..standing(&robot)
    };
    let fall = Fall {
        name: "collapse",
        state,
        hips: [0.0, 0.3],
        seconds: 1.5,
    };
    let most = Limits { hit: 0.3, ..MOST };
    fall.assert_as_in_mujoco(&robot, &most);
}

/// A wheel hits first, with its side: MuJoCo's is an ellipsoid, the plant's a ring with a round cross-section.
#[test]
fn a_robot_falls_on_its_side_as_in_mujoco() {
    let robot = falling();
    let fall = Fall {
        name: "side",
        state: dropped(&robot, 0.35, [0.9, 0.0]),
        hips: STIFF,
        seconds: 2.0,
    };
    let most = Limits {
        first_hit_s: 0.02,
        rests_after_s: 0.3,
        way_m: 0.05,
        ..MOST
    };
    fall.assert_as_in_mujoco(&robot, &most);
}

#[test]
fn a_robot_falls_on_its_top_as_in_mujoco() {
    let robot = falling();
    let fall = Fall {
        name: "top",
        state: dropped(&robot, 0.25, [2.9, 0.1]),
        hips: STIFF,
        seconds: 1.5,
    };
    fall.assert_as_in_mujoco(&robot, &MOST);
}

/// One corner hits first, and the robot turns about it.
#[test]
fn a_robot_falls_on_a_corner_as_in_mujoco() {
    let robot = falling();
    let fall = Fall {
        name: "corner",
        state: dropped(&robot, 0.35, [0.2, 1.2]),
        hips: STIFF,
        seconds: 1.5,
    };
    let most = Limits {
        way_m: 0.03,
        ..MOST
    };
    fall.assert_as_in_mujoco(&robot, &most);
}
