//! On the ground: Newton's law, friction, rest, edges.

use super::*;

const LYING: [Start; 6] = [
    Start::Sitting,
    Start::Front,
    Start::Back,
    Start::Left,
    Start::Right,
    Start::UpsideDown,
];
/// Mass that a torque on the wheels of a cart accelerates.
fn rolling_kg(cart: &FreeBody) -> f64 {
    let disc = cart.model.disc;
    cart.mass_kg() + 2.0 * (disc.spin_kgm2 + disc.rotor_kgm2) / radius_m(cart).powi(2)
}

fn resistance_n(cart: &FreeBody) -> f64 {
    0.015 * cart.mass_kg() * G
}

#[test]
fn a_lying_robot_rests() {
    let other = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/fivebar-rs00.toml");
    let other = Robot::read(&other).unwrap_or_else(|error| panic!("{error}"));
    for (robot, start) in LYING
        .iter()
        .flat_map(|it| [(robot(), *it), (other.clone(), *it)])
    {
        let setup = FreeSetup {
            start,
            ..FreeSetup::default()
        };
        let mut body = FreeBody::new(&robot, &setup);
        let (before, energy_j) = (body.state(), body.energy_j());
        for _ in 0..20 {
            run(&mut body, 0.1, |_| LIMP);
            assert!(body.energy_j() < energy_j + 1e-3, "{start:?}");
        }
        let after = body.state();
        for axis in 0..3 {
            let moved_m = after.position_m[axis] - before.position_m[axis];
            assert!(moved_m.abs() < 1e-3, "{start:?}: {moved_m} m");
        }
        assert!(body.motion.fastest() < 1e-3, "{start:?}");
        let carried_n = body.wheel_contact_n().iter().sum::<f64>() + body.body_contact_n();
        assert!(
            (carried_n / (body.mass_kg() * G) - 1.0).abs() < 1e-2,
            "{start:?}: {carried_n} N"
        );
    }
}

#[test]
fn starts_are_what_they_are_called() {
    let up = |start| {
        let body = free(start);
        let [roll, pitch] = [0, 1].map(|axis| match body.motion.attitude.euler_angles() {
            (roll, _, _) if axis == 0 => roll,
            (_, pitch, _) => pitch,
        });
        (roll, pitch)
    };
    assert!((0.3..1.2).contains(&up(Start::Front).1));
    assert!((-1.2..-0.3).contains(&up(Start::Back).1));
    assert!((-2.3..-1.3).contains(&up(Start::Left).0));
    assert!((1.3..2.3).contains(&up(Start::Right).0));
    assert!(up(Start::UpsideDown).0.abs() > 3.0);
    assert!(up(Start::Sitting).0.abs() < 0.01);
}

#[test]
fn torque_accelerates_by_newtons_law() {
    let mut cart = cart(Terrain::Flat, 0.8);
    run(&mut cart, 0.5, |_| FreeInputs {
        wheel_nm: [0.3; 2],
        ..LOCKED
    });
    let force_n = 2.0 * 0.3 / radius_m(&cart) - resistance_n(&cart);
    let expected_mps = 0.5 * force_n / rolling_kg(&cart);
    let speed_mps = cart.state().velocity_mps[0];
    assert!(
        (speed_mps / expected_mps - 1.0).abs() < 0.01,
        "{speed_mps} {expected_mps}"
    );
    let rim_mps = cart.wheel_abs_rps()[0] * radius_m(&cart);
    assert!(
        (rim_mps / speed_mps - 1.0).abs() < 0.02,
        "{rim_mps} {speed_mps}"
    );
}

#[test]
fn ideal_wheels_accelerate_by_newtons_law() {
    let cart = cart(Terrain::Flat, 0.8);
    let inputs = FreeInputs {
        wheel_nm: [0.3; 2],
        ..LOCKED
    };
    let disc = cart.model.disc;
    let rolls_m = disc.radius_m;
    // Hips that are free to move would give way: they hold the robot up.
    let holding = cart.holding_torque_nm([[0.0, 0.0]; 2]);
    let joint_nm = stiff_hips(&cart, &inputs, holding);
    let found = cart.rolling_accelerations(&FreeInputs { joint_nm, ..inputs });
    let rolling_kg = cart.mass_kg() + 2.0 * (disc.spin_kgm2 + disc.rotor_kgm2) / rolls_m.powi(2);
    let expected = 2.0 * 0.3 / rolls_m / rolling_kg;
    assert!(
        (found.linear_mps2[0] / expected - 1.0).abs() < 1e-3,
        "{found:?} {expected}"
    );
    assert!(found.linear_mps2[2].abs() < 1e-3 && found.joint_rps2[0].abs() < 1e-3);
    assert!(
        (found.wheel_rps2[0] * rolls_m / expected - 1.0).abs() < 1e-3,
        "{found:?}"
    );
}

/// Hip torques at which no hip accelerates: accelerations are linear in the torques.
fn stiff_hips(cart: &FreeBody, inputs: &FreeInputs, start_nm: [f64; 4]) -> [f64; 4] {
    let hips = |joint_nm: [f64; 4]| {
        let inputs = FreeInputs {
            joint_nm,
            ..*inputs
        };
        nalgebra::Vector4::from(cart.rolling_accelerations(&inputs).joint_rps2)
    };
    let base = hips(start_nm);
    let columns: [_; 4] = std::array::from_fn(|joint| {
        let mut more = start_nm;
        more[joint] += 1.0;
        hips(more) - base
    });
    let slopes = nalgebra::Matrix4::from_columns(&columns);
    let change = slopes.lu().solve(&-base).unwrap_or_default();
    std::array::from_fn(|joint| start_nm[joint] + change[joint])
}

#[test]
fn leg_force_carries_the_body() {
    let cart = cart(Terrain::Flat, 0.8);
    let leg = &cart.legs()[0];
    let carried_kg = cart.mass_kg() / 2.0 - leg.parts.iter().map(|it| it.mass_kg).sum::<f64>();
    let [left_n, right_n] = cart.leg_force_n();
    // Links hang between hip and axle, so that the leg force carries part of their weight, too.
    let links_kg = 2.0 * (cart.model.thigh.mass_kg + cart.model.shank.mass_kg);
    let range_n = carried_kg * G..(carried_kg + links_kg) * G;
    assert!(range_n.contains(&left_n), "{left_n} {range_n:?}");
    assert!((left_n - right_n).abs() < 1e-3);
}

#[test]
fn friction_limits_what_torque_does() {
    let mut cart = cart(Terrain::Flat, 0.8);
    run(&mut cart, 0.2, |_| FreeInputs {
        wheel_nm: [6.0; 2],
        ..LOCKED
    });
    let speed_mps = cart.state().velocity_mps[0];
    assert!((speed_mps - 0.2 * 0.8 * G).abs() < 0.05, "{speed_mps}");
    assert!(cart.wheel_abs_rps()[0] * cart.model.disc.radius_m > 3.0 * speed_mps);
}

#[test]
fn coasting_ends_in_rest() {
    let mut cart = cart(Terrain::Flat, 0.8);
    let mut state = cart.state();
    state.velocity_mps = [0.5, 0.0, 0.0];
    state.wheel_rps = [0.5 / radius_m(&cart); 2];
    cart.set_state(&state);
    let seconds = 0.5 * rolling_kg(&cart) / resistance_n(&cart);
    run(&mut cart, 0.9 * seconds, |_| LOCKED);
    assert!(cart.state().velocity_mps[0] > 0.02);
    run(&mut cart, 0.2 * seconds, |_| LOCKED);
    let at_m = cart.state().position_m[0];
    run(&mut cart, 1.0, |_| LOCKED);
    assert!((cart.state().position_m[0] - at_m).abs() < 1e-4);
    assert!((at_m / (0.25 * seconds) - 1.0).abs() < 0.02, "{at_m}");
}

#[test]
fn a_braked_robot_does_not_creep_on_a_slope() {
    let slope = Terrain::Slope {
        start_m: -10.0,
        angle_rad: 15_f64.to_radians(),
        length_m: 20.0,
    };
    for (friction, holds) in [(0.4, true), (0.2, false)] {
        let mut cart = cart(Terrain::Flat, friction);
        cart.ground = Ground::new(&slope);
        let mut state = cart.state();
        state.position_m[2] += 10.0 * 15_f64.to_radians().tan() + 0.003;
        cart.set_state(&state);
        let braked = FreeInputs {
            wheel_dry_nm: 20.0,
            ..LOCKED
        };
        run(&mut cart, 1.5, |_| braked);
        let before_m = cart.state().position_m[0];
        run(&mut cart, 2.0, |_| braked);
        let moved_m = cart.state().position_m[0] - before_m;
        if holds {
            assert!(moved_m.abs() < 1e-5, "{moved_m} m");
        } else {
            // g (sin 15° − 0.2 cos 15°) along the slope, for 2 s after 1.5 s.
            let down_mps2 = G * (15_f64.to_radians().sin() - 0.2 * 15_f64.to_radians().cos());
            let along_m = -moved_m / 15_f64.to_radians().cos();
            assert!(
                (along_m / (down_mps2 * (1.5 * 2.0 + 2.0)) - 1.0).abs() < 0.05,
                "{along_m} m"
            );
        }
    }
}
