//! In the air: nothing but gravity and inertia.

use super::*;

const SPRING_NM_PER_RAD: f64 = 6.0;
const HIGH: Start = Start::Dropped { height_m: 1_000.0 };

/// A robot that tumbles with swinging legs and turning wheels.
fn tumbling() -> FreeBody {
    let mut body = free(HIGH);
    let mut state = body.state();
    state.rate_rps = [2.0, 3.0, -4.0];
    state.velocity_mps = [1.0, -2.0, 5.0];
    state.joint_rps = [4.0, -3.0, -5.0, 2.0];
    state.wheel_rps = [40.0, -25.0];
    body.set_state(&state);
    body
}

#[test]
fn the_centre_of_mass_falls_as_a_point_does() {
    let mut body = tumbling();
    let start_m = body.com_m();
    let mass_kg = body.mass_kg();
    let start = body.momentum().0.map(|it| it / mass_kg);
    run(&mut body, 1.0, |_| FreeInputs::default());
    let end_m = body.com_m();
    for axis in 0..3 {
        let fallen_m = if axis == 2 { G / 2.0 } else { 0.0 };
        let error_m = end_m[axis] - (start_m[axis] + start[axis] - fallen_m);
        assert!(error_m.abs() < 1e-4, "axis {axis}: {error_m}");
    }
}

#[test]
fn momentum_is_kept_in_flight() {
    let mut robot = robot();
    // A reflected rotor takes up torque without momentum, so it has none here.
    robot.wheels.rotor_inertia_kgm2 = 1e-9;
    robot.joints.armature_kgm2 = 1e-9;
    let setup = FreeSetup {
        start: HIGH,
        ..FreeSetup::default()
    };
    let mut body = FreeBody::new(&robot, &setup);
    body.set_state(&tumbling().state());
    let (_, before) = body.momentum();
    run(&mut body, 2.0, |_| FreeInputs::default());
    let (_, after) = body.momentum();
    for axis in 0..3 {
        let change = after[axis] - before[axis];
        assert!(change.abs() < 1e-4, "{change} of {before:?}");
    }
}

/// Springs on the hips, which keep swinging legs away from their stops: torque at the middle of a step.
fn springs(body: &FreeBody) -> FreeInputs {
    let state = body.state();
    FreeInputs {
        joint_nm: std::array::from_fn(|joint| {
            let middle_rad = state.joint_rad[joint] + state.joint_rps[joint] * DT_S / 2.0;
            -SPRING_NM_PER_RAD * middle_rad
        }),
        ..FreeInputs::default()
    }
}

#[test]
fn energy_is_kept_while_legs_swing_on_springs() {
    let mut body = tumbling();
    // About the centre of mass, whose own energy is a thousand times larger.
    let inner_j = |body: &FreeBody| {
        let momentum = Vec3::from(body.momentum().0);
        let spring_j: f64 = body.joint_pos_rad().iter().map(|it| it * it).sum();
        body.energy_j()
            - body.mass_kg() * G * body.com_m()[2]
            - 0.5 * momentum.norm_squared() / body.mass_kg()
            + 0.5 * SPRING_NM_PER_RAD * spring_j
    };
    let before_j = inner_j(&body);
    let mut widest_rad: f64 = 0.0;
    for _ in 0..500 {
        run(&mut body, 0.01, springs);
        let drift = (inner_j(&body) / before_j - 1.0).abs();
        assert!(drift < 1e-4, "{drift}");
        widest_rad = body
            .joint_pos_rad()
            .iter()
            .fold(widest_rad, |a, b| a.max(b.abs()));
    }
    assert!((0.5..1.5).contains(&widest_rad), "{widest_rad} rad");
}
