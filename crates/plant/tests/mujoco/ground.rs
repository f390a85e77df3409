//! On its wheels, which carry, roll, slip and turn it.

use robot_description::Robot;
use robot_plant::free::{FreeBody, FreeSetup, FreeState, Start};
use serde_json::{Value, json};

use crate::{
    floor::{self, EVERY_S, FRICTION, GIVES_M, GRAVITY_MPS2, LEAST_FRICTION_M, ROLLING, STIFF},
    oracle::{numbers, robot},
};

/// A height that stays as near to its last one has settled.
const SETTLED_M: f64 = 1e-3;

/// One moment: place x and z, pitch, yaw, hips, wheels against their shanks.
struct Moment {
    x_m: f64,
    z_m: f64,
    pitch_rad: f64,
    yaw_rad: f64,
    joint_rad: [f64; 4],
    wheel_rps: [f64; 2],
}

/// Tyres of MuJoCo's robot.
enum Tyres {
    /// Hard; they resist rolling and not twisting.
    Rolling,
    /// The same, as soft as the plant's.
    Soft,
    /// Hard; they resist twisting, and the wheels' bearings turning as much as tyres would rolling.
    Twisting,
}

struct Run<'a> {
    robot: &'a Robot,
    start: Start,
    /// Rate at which the robot turns left on the spot at first.
    turning_rps: f64,
    wheel_nm: [f64; 2],
    seconds: f64,
}

impl Run<'_> {
    fn state(&self) -> FreeState {
        let setup = FreeSetup {
            start: self.start,
            ..FreeSetup::default()
        };
        let mut state = FreeBody::new(self.robot, &setup).state();
        let wheel_rps =
            self.turning_rps * self.robot.wheels.track_m / 2.0 / self.robot.wheels.radius_m;
        state.rate_rps[2] = self.turning_rps;
        state.wheel_rps = [-wheel_rps, wheel_rps];
        state
    }

    fn on_floor(&self) -> floor::Run<'_> {
        floor::Run {
            robot: self.robot,
            state: self.state(),
            hips: STIFF,
            wheel_nm: self.wheel_nm,
            seconds: self.seconds,
        }
    }

    fn in_plant(&self) -> Vec<Moment> {
        self.on_floor().in_plant(
            |_| (),
            |body| {
                let state = body.state();
                let [w, _, y, z] = state.attitude;
                Moment {
                    x_m: state.position_m[0],
                    z_m: state.position_m[2],
                    pitch_rad: 2.0 * y.atan2(w),
                    yaw_rad: 2.0 * z.atan2(w),
                    joint_rad: state.joint_rad,
                    wheel_rps: state.wheel_rps,
                }
            },
        )
    }

    fn in_mujoco(&self, test: &str, tyres: Tyres) -> Option<Vec<Moment>> {
        let run = self.on_floor();
        let mut question = run.question();
        match tyres {
            Tyres::Rolling => (),
            Tyres::Soft => run.soften_tyres(&mut question),
            Tyres::Twisting => {
                let load_n = self.robot.total_mass_kg() / 2.0 * GRAVITY_MPS2;
                question["twisting_m"] = json!(FRICTION * twist_lever_m(self.robot));
                question["rolling_m"] = json!(LEAST_FRICTION_M);
                question["rolling_nm"] = json!(ROLLING * self.robot.wheels.radius_m * load_n);
            }
        }
        let rows = run.ask(test, "ground", question)?;
        Some(rows.iter().map(moment).collect())
    }
}

fn moment(row: &Value) -> Moment {
    let [x_m, z_m, pitch_rad, yaw_rad, a, b, c, d, left, right] =
        <[f64; 10]>::try_from(numbers(row)).expect("ten numbers");
    Moment {
        x_m,
        z_m,
        pitch_rad,
        yaw_rad,
        joint_rad: [a, b, c, d],
        wheel_rps: [left, right],
    }
}

/// Hertz's pressure on the patch of the tyre that gives, as a circle of the area of the ellipse that touches.
fn twist_lever_m(robot: &Robot) -> f64 {
    let wheels = &robot.wheels;
    let area_m2 = std::f64::consts::PI * GIVES_M * (wheels.radius_m * wheels.width_m / 2.0).sqrt();
    3.0 / 16.0 * std::f64::consts::PI * (area_m2 / std::f64::consts::PI).sqrt()
}

/// A robot that does not fall over within a test, since its body hardly turns.
fn cart() -> Robot {
    let mut robot = robot("fivebar");
    robot.body.inertia_kgm2 = [50.0; 3];
    robot
}

/// The largest difference of one signal over a run.
fn apart(pairs: &[(Moment, Moment)], signal: impl Fn(&Moment) -> f64) -> f64 {
    pairs
        .iter()
        .fold(0.0, |it, (a, b)| it.max((signal(a) - signal(b)).abs()))
}

/// Time after which a height stays near its last one.
fn settled_s(moments: &[Moment]) -> f64 {
    let last_m = moments.last().map_or(0.0, |it| it.z_m);
    let far = |it: &Moment| (it.z_m - last_m).abs() > SETTLED_M;
    moments
        .iter()
        .rposition(far)
        .map_or(0.0, |n| n as f64 * EVERY_S)
}

/// Height and hips over the whole fall from 0.1 m, the rebound and the rest.
#[test]
fn a_dropped_robot_settles_as_in_mujoco() {
    let robot = cart();
    let run = Run {
        robot: &robot,
        start: Start::Dropped { height_m: 0.1 },
        turning_rps: 0.0,
        wheel_nm: [0.0; 2],
        seconds: 0.6,
    };
    let Some(expected) = run.in_mujoco("drop", Tyres::Soft) else {
        return;
    };
    let found = run.in_plant();
    let settled_s = [&found, &expected].map(|it| settled_s(it));
    let pairs: Vec<_> = found.into_iter().zip(expected).collect();
    let height_m = apart(&pairs, |it| it.z_m);
    let hips_rad = [0, 1, 2, 3].map(|n| apart(&pairs, |it| it.joint_rad[n]));
    let hip_rad = hips_rad.into_iter().fold(0.0, f64::max);
    let rest_m = apart(&pairs[pairs.len() - 50..], |it| it.z_m);
    println!(
        "drop: height {height_m:.1e} m, at rest {rest_m:.1e} m, hips {hip_rad:.1e} rad apart at most; settled after \
         {settled_s:.3?} s"
    );
    assert!(height_m < 1.5e-3 && rest_m < 1e-4 && hip_rad < 6e-3);
    assert!((settled_s[0] - settled_s[1]).abs() < 0.01);
}

/// A robot at rest under a torque on both wheels, in the plant and in MuJoCo.
struct Rolling<'a> {
    robot: &'a Robot,
    test: &'a str,
    nm: f64,
    seconds: f64,
    /// Largest differences of place in m, pitch in rad and wheel speed in rad/s.
    most: [f64; 3],
}

impl Rolling<'_> {
    fn assert_as_in_mujoco(&self) {
        let run = Run {
            robot: self.robot,
            start: Start::Standing,
            turning_rps: 0.0,
            wheel_nm: [self.nm; 2],
            seconds: self.seconds,
        };
        let Some(expected) = run.in_mujoco(self.test, Tyres::Rolling) else {
            return;
        };
        let pairs: Vec<_> = run.in_plant().into_iter().zip(expected).collect();
        let found = [
            apart(&pairs, |it| it.x_m),
            apart(&pairs, |it| it.pitch_rad),
            apart(&pairs, |it| it.wheel_rps[0]),
        ];
        let (here, there) = pairs.last().expect("moments");
        println!(
            "{}, {} N·m: {:.4} m here, {:.4} m in MuJoCo, {:.1} rad/s; apart at most {found:.6?} m, rad, rad/s",
            self.test, self.nm, here.x_m, there.x_m, here.wheel_rps[0]
        );
        let near = found
            .iter()
            .zip(self.most)
            .all(|(found, most)| *found < most);
        assert!(near, "{found:?}, limits {:?}", self.most);
    }
}

#[test]
fn a_torque_rolls_a_cart_as_in_mujoco() {
    let rolling = Rolling {
        robot: &cart(),
        test: "cart",
        nm: 0.5,
        seconds: 0.3,
        most: [4e-4, 1e-4, 0.15],
    };
    rolling.assert_as_in_mujoco();
}

/// The torque is twice what friction passes on.
#[test]
fn a_cart_slips_as_in_mujoco() {
    let rolling = Rolling {
        robot: &cart(),
        test: "slipping",
        nm: 3.0,
        seconds: 0.3,
        most: [9e-3, 4e-4, 2.0],
    };
    rolling.assert_as_in_mujoco();
}

#[test]
fn a_torque_tips_the_body_as_in_mujoco() {
    let rolling = Rolling {
        robot: &robot("fivebar"),
        test: "tipping",
        nm: 0.4,
        seconds: 0.3,
        most: [3e-4, 2e-3, 0.06],
    };
    rolling.assert_as_in_mujoco();
}

/// Until the body hits the floor.
#[test]
fn a_large_torque_throws_the_body_over_as_in_mujoco() {
    let rolling = Rolling {
        robot: &robot("fivebar"),
        test: "thrown",
        nm: 3.0,
        seconds: 0.2,
        most: [1.5e-3, 1.5e-2, 0.5],
    };
    rolling.assert_as_in_mujoco();
}

#[test]
fn opposite_torques_turn_the_robot_as_in_mujoco() {
    let robot = robot("fivebar");
    let run = Run {
        robot: &robot,
        start: Start::Standing,
        turning_rps: 0.0,
        wheel_nm: [-0.4, 0.4],
        seconds: 0.4,
    };
    let Some(expected) = run.in_mujoco("turning", Tyres::Twisting) else {
        return;
    };
    let pairs: Vec<_> = run.in_plant().into_iter().zip(expected).collect();
    let yaw_rad = apart(&pairs, |it| it.yaw_rad);
    let (here, there) = pairs.last().expect("moments");
    println!(
        "turning: {:.4} rad here, {:.4} rad in MuJoCo; apart at most {yaw_rad:.4} rad",
        here.yaw_rad, there.yaw_rad
    );
    assert!(here.yaw_rad > 0.3 && yaw_rad < 0.01);
}

/// A robot that turns around its middle coasts. Without tyres that resist twisting, it would get 0.41 rad farther.
#[test]
fn tyres_resist_turning_on_the_spot_as_in_mujoco() {
    let mut robot = robot("fivebar");
    let yaw_kgm2 = robot.body.inertia_kgm2[2];
    robot.body.inertia_kgm2 = [50.0, 50.0, yaw_kgm2];
    let run = Run {
        robot: &robot,
        start: Start::Standing,
        turning_rps: 1.5,
        wheel_nm: [0.0; 2],
        seconds: 1.5,
    };
    let Some(expected) = run.in_mujoco("twisting", Tyres::Twisting) else {
        return;
    };
    let pairs: Vec<_> = run.in_plant().into_iter().zip(expected).collect();
    let yaw_rad = apart(&pairs, |it| it.yaw_rad);
    let (here, there) = pairs.last().expect("moments");
    println!(
        "twisting: {:.4} rad here, {:.4} rad in MuJoCo; apart at most {yaw_rad:.4} rad",
        here.yaw_rad, there.yaw_rad
    );
    assert!(yaw_rad < 0.01);
}
