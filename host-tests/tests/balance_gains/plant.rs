//! The linear model accelerates as the simulated robot does on ideal wheels. They share no code.

use nalgebra::{Matrix2, SVector, Vector2};
use robot_balance_design::{LinearModel, STATES};
use robot_description::Robot;
use robot_plant::free::{FreeBody, FreeInputs, FreeSetup};

use crate::scipy::file;

/// Angle in rad by which derivatives are taken, and torque in N·m.
const STEP: f64 = 1e-4;
/// Largest difference as a part of the largest entry.
const TOLERANCE: f64 = 1e-4;

/// s, ψ, θ left, θ right, φ.
type Places = SVector<f64, 5>;
/// Torque of the left and the right wheel, on the left and the right leg.
type Torques = [f64; 4];

#[test]
fn the_simulated_robot_accelerates_as_the_linear_model_says() {
    for (name, length_m) in [
        ("fivebar", [0.18, 0.18]),
        ("fivebar", [0.15, 0.15]),
        ("fivebar-rs00", [0.25, 0.25]),
    ] {
        let robot = Robot::read(&file(name)).expect("a robot of this repository");
        let model = LinearModel::new(&robot, length_m).expect("a length within reach");
        let slope = |change: &dyn Fn(f64) -> (Places, Torques)| {
            let [more, less] = [STEP, -STEP].map(|step| {
                let (places, torques) = change(step);
                accelerations(&robot, length_m, places, torques)
            });
            (more - less) / (2.0 * STEP)
        };
        let rates = |column: SVector<f64, STATES>| Places::from_fn(|i, _| column[2 * i + 1]);
        let check = |what: &str, found: Places, expected: Places| {
            let difference = (found - expected).amax();
            assert!(
                difference < TOLERANCE * expected.amax(),
                "{name} {what}{found}{expected}"
            );
        };
        // Left and right lean as one: apart they would roll the body, which the model keeps level.
        let found = slope(&|step| (Places::from([0.0, 0.0, step, step, 0.0]), [0.0; 4]));
        let expected = rates(model.a.column(4) + model.a.column(6));
        check("lean", found, expected);
        let found = slope(&|step| (Places::from([0.0, 0.0, 0.0, 0.0, step]), [0.0; 4]));
        check("pitch", found, rates(model.a.column(8).into()));
        for input in 0..4 {
            let found = slope(&|step| {
                let mut torques = [0.0; 4];
                torques[input] = step;
                (Places::zeros(), torques)
            });
            let expected = rates(model.b.column(input).into());
            check(&format!("input {input}"), found, expected);
        }
    }
}

/// Accelerations at rest with legs that keep their lengths.
fn accelerations(robot: &Robot, length_m: [f64; 2], places: Places, torques: Torques) -> Places {
    let legs = [0, 1].map(|side| {
        let angle_rad = places[4] - places[2 + side];
        LegAt::new(robot, length_m[side], angle_rad)
    });
    let mut body = FreeBody::new(robot, &FreeSetup::default());
    let mut state = body.state();
    let (sin, cos) = (places[4] / 2.0).sin_cos();
    state.attitude = [cos, 0.0, sin, 0.0];
    state.velocity_mps = [0.0; 3];
    state.rate_rps = [0.0; 3];
    state.joint_rps = [0.0; 4];
    state.wheel_rps = [0.0; 2];
    for (side, leg) in legs.iter().enumerate() {
        state.joint_rad[2 * side] = leg.joints_rad[0];
        state.joint_rad[2 * side + 1] = leg.joints_rad[1];
    }
    body.set_state(&state);
    let answer = |push_n: Vector2<f64>| {
        let mut inputs = FreeInputs {
            wheel_nm: [torques[0], torques[1]],
            ..FreeInputs::default()
        };
        for (side, leg) in legs.iter().enumerate() {
            let turn_nm = -torques[2 + side];
            // The reaction of the wheel's motor acts on its shank; the model has it act on the leg.
            let reaction = torques[side] * (leg.carrier_per_joint + leg.angle_per_joint);
            let joints_nm =
                leg.length_per_joint * push_n[side] + leg.angle_per_joint * turn_nm + reaction;
            inputs.joint_nm[2 * side] = joints_nm[0];
            inputs.joint_nm[2 * side + 1] = joints_nm[1];
        }
        body.rolling_accelerations(&inputs)
    };
    let joints = |side: usize, found: &[f64; 4]| Vector2::new(found[2 * side], found[2 * side + 1]);
    let stretching = |push_n: Vector2<f64>| {
        let found = answer(push_n).joint_rps2;
        Vector2::from([0, 1].map(|side| legs[side].length_per_joint.dot(&joints(side, &found))))
    };
    // Stretching is linear in the forces along the legs.
    let base = stretching(Vector2::zeros());
    let slopes = Matrix2::from_columns(&[
        stretching(Vector2::x()) - base,
        stretching(Vector2::y()) - base,
    ]);
    let push_n = slopes.lu().solve(&-base).expect("legs that stretch");
    let found = answer(push_n);
    let [_, pitch, yaw] = found.angular_rps2;
    let lean = [0, 1].map(|side| {
        pitch
            - legs[side]
                .angle_per_joint
                .dot(&joints(side, &found.joint_rps2))
    });
    let hips_ahead: f64 = [0, 1]
        .map(|side| length_m[side] * places[2 + side].cos() * lean[side] / 2.0)
        .iter()
        .sum();
    Places::from([
        found.linear_mps2[0] - hips_ahead,
        yaw,
        lean[0],
        lean[1],
        pitch,
    ])
}

/// A leg's hips and what they do, by hand from the triangle of each side.
struct LegAt {
    joints_rad: [f64; 2],
    length_per_joint: Vector2<f64>,
    angle_per_joint: Vector2<f64>,
    carrier_per_joint: Vector2<f64>,
}

impl LegAt {
    fn new(robot: &Robot, length_m: f64, angle_rad: f64) -> Self {
        let legs = &robot.legs;
        let joints = |length_m: f64, angle_rad: f64| {
            [1.0, -1.0].map(|outward| {
                // Mirrored, the rear side is a front side.
                let ahead_m = outward * length_m * angle_rad.sin() - legs.hip_gap_m / 2.0;
                let below_m = length_m * angle_rad.cos();
                let reach_m = ahead_m.hypot(below_m);
                let (thigh_m, shank_m) = (legs.thigh.length_m, legs.shank.length_m);
                let cos = (thigh_m.powi(2) + reach_m.powi(2) - shank_m.powi(2))
                    / (2.0 * thigh_m * reach_m);
                outward * (cos.acos() - below_m.atan2(ahead_m))
            })
        };
        let step = 1e-5;
        let difference = |more: [f64; 2], less: [f64; 2]| {
            (Vector2::from(more) - Vector2::from(less)) / (2.0 * step)
        };
        let by_length = difference(
            joints(length_m + step, angle_rad),
            joints(length_m - step, angle_rad),
        );
        let by_angle = difference(
            joints(length_m, angle_rad + step),
            joints(length_m, angle_rad - step),
        );
        let inverse = Matrix2::from_columns(&[by_length, by_angle])
            .try_inverse()
            .expect("a leg that is not stretched");
        let joints_rad = joints(length_m, angle_rad);
        Self {
            joints_rad,
            length_per_joint: inverse.row(0).transpose(),
            angle_per_joint: inverse.row(1).transpose(),
            carrier_per_joint: carrier_per_joint(robot, joints_rad),
        }
    }
}

/// How the shank with the motor turns about +y: as a wheel that stands still on it.
fn carrier_per_joint(robot: &Robot, joints_rad: [f64; 2]) -> Vector2<f64> {
    let mut body = FreeBody::new(robot, &FreeSetup::default());
    let mut state = body.state();
    (state.joint_rad[0], state.joint_rad[1]) = (joints_rad[0], joints_rad[1]);
    state.rate_rps = [0.0; 3];
    state.wheel_rps = [0.0; 2];
    Vector2::from([0, 1].map(|hip| {
        state.joint_rps = [0.0; 4];
        state.joint_rps[hip] = 1.0;
        body.set_state(&state);
        body.wheel_abs_rps()[0]
    }))
}
