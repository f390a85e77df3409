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
/// Friction of motors without supply.
const LIMP: FreeInputs = FreeInputs {
    wheel_nm: [0.0; 2],
    joint_nm: [0.0; 4],
    wheel_dry_nm: 0.1,
    wheel_viscous_nm_per_rps: 0.0,
    joint_dry_nm: 0.15,
    joint_viscous_nm_per_rps: 0.0,
    push: None,
    grip: 1.0,
};
/// Hips that nothing turns.
const LOCKED: FreeInputs = FreeInputs {
    wheel_dry_nm: 0.0,
    joint_dry_nm: 200.0,
    ..LIMP
};

/// A robot that does not fall over within a test, since its body hardly turns.
fn cart(terrain: Terrain, ground_friction: f64) -> FreeBody {
    let mut robot = robot();
    robot.body.inertia_kgm2 = [1e7; 3];
    let setup = FreeSetup {
        start: Start::Standing,
        terrain,
        variation: Variation {
            ground_friction,
            ..Variation::default()
        },
        ..FreeSetup::default()
    };
    let mut cart = FreeBody::new(&robot, &setup);
    run(&mut cart, 0.3, |_| LOCKED);
    cart
}

/// Mass that a torque on the wheels of a cart accelerates.
fn rolling_kg(cart: &FreeBody) -> f64 {
    let disc = cart.model.disc;
    cart.mass_kg() + 2.0 * (disc.spin_kgm2 + disc.rotor_kgm2) / radius_m(cart).powi(2)
}

/// Height of the axle on level ground: the tyre gives 0.8 mm.
fn radius_m(cart: &FreeBody) -> f64 {
    cart.model.disc.radius_m - 0.8e-3
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
    // Hips that are free to move would give way: they hold the robot up.
    let holding = cart.holding_torque_nm([[0.0, 0.0]; 2]);
    let joint_nm = stiff_hips(&cart, &inputs, holding);
    let found = cart.rolling_accelerations(&FreeInputs { joint_nm, ..inputs });
    let rolling_kg = cart.mass_kg() + 2.0 * (disc.spin_kgm2 + disc.rotor_kgm2) / 0.06_f64.powi(2);
    let expected = 2.0 * 0.3 / 0.06 / rolling_kg;
    assert!(
        (found.linear_mps2[0] / expected - 1.0).abs() < 1e-3,
        "{found:?} {expected}"
    );
    assert!(found.linear_mps2[2].abs() < 1e-3 && found.joint_rps2[0].abs() < 1e-3);
    assert!(
        (found.wheel_rps2[0] * 0.06 / expected - 1.0).abs() < 1e-3,
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
    assert!(cart.wheel_abs_rps()[0] * 0.06 > 3.0 * speed_mps);
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
        run(&mut cart, 0.5, |_| braked);
        let before_m = cart.state().position_m[0];
        run(&mut cart, 2.0, |_| braked);
        let moved_m = cart.state().position_m[0] - before_m;
        if holds {
            assert!(moved_m.abs() < 1e-5, "{moved_m} m");
        } else {
            // g (sin 15° − 0.2 cos 15°) along the slope, for 2 s after half a second.
            let down_mps2 = G * (15_f64.to_radians().sin() - 0.2 * 15_f64.to_radians().cos());
            let along_m = -moved_m / 15_f64.to_radians().cos();
            assert!(
                (along_m / (down_mps2 * (0.5 * 2.0 + 2.0)) - 1.0).abs() < 0.05,
                "{along_m} m"
            );
        }
    }
}

#[test]
fn a_wheel_rolls_off_a_step_and_lands() {
    let mut cart = cart(
        Terrain::Step {
            at_m: 0.3,
            height_m: -0.15,
        },
        0.8,
    );
    let mut state = cart.state();
    state.velocity_mps = [1.0, 0.0, 0.0];
    state.wheel_rps = [1.0 / radius_m(&cart); 2];
    cart.set_state(&state);
    // Hips that give in to the landing, and so take up its energy.
    let giving = FreeInputs {
        joint_dry_nm: 5.0,
        ..LOCKED
    };
    let axle_m = |cart: &FreeBody| cart.state().position_m[2] + cart.legs()[0].linkage.axle.y;
    let mut lowest_m = f64::INFINITY;
    let mut fall_s = 0.0;
    for _ in 0..6_000 {
        cart.step(&giving, DT_S);
        lowest_m = lowest_m.min(axle_m(&cart));
        if cart.wheel_contact_n() == [0.0; 2] && lowest_m > -0.09 {
            fall_s += DT_S;
        }
    }
    // √(2 · 0.15 m / g), less what it takes to roll around the edge.
    assert!((fall_s - 0.175).abs() < 0.02, "{fall_s}");
    assert!(lowest_m > -0.15 + 0.04, "{lowest_m}");
    let end_m = axle_m(&cart);
    assert!((end_m + 0.15 - radius_m(&cart)).abs() < 1e-3, "{end_m}");
    assert!(cart.state().velocity_mps[0] > 0.7);
}

#[test]
fn a_wheel_climbs_a_low_step_with_torque() {
    let mut cart = cart(
        Terrain::Step {
            at_m: 0.2,
            height_m: 0.02,
        },
        0.8,
    );
    let start_m = cart.state().position_m[2];
    for _ in 0..200 {
        run(&mut cart, 0.01, |cart| {
            let behind_rps = 1.0 / 0.06 - cart.wheel_abs_rps()[0];
            FreeInputs {
                wheel_nm: [(0.5 * behind_rps).clamp(-3.0, 3.0); 2],
                ..LOCKED
            }
        });
    }
    let state = cart.state();
    assert!(state.position_m[0] > 0.5, "{state:?}");
    assert!(
        (state.position_m[2] - start_m - 0.02).abs() < 2e-3,
        "{state:?}"
    );
}

#[test]
fn a_drop_of_280_mm_does_not_pierce_the_ground() {
    let mut body = free(Start::Dropped { height_m: 0.28 });
    let mut deepest_m: f64 = 0.0;
    for _ in 0..4_000 {
        body.step(
            &FreeInputs {
                joint_dry_nm: 7.0,
                ..LIMP
            },
            DT_S,
        );
        let legs = body.legs();
        let axle = body.motion.to_world(legs[0].wheel().place) + body.motion.position;
        deepest_m = deepest_m.max(body.model.disc.radius_m - axle.z);
    }
    assert!((0.002..0.02).contains(&deepest_m), "{deepest_m}");
}

#[test]
fn one_wheel_on_a_ramp_rolls_the_body() {
    let ramp = Terrain::OneSidedRamp {
        start_m: -1.0,
        angle_rad: 0.17,
        height_m: 0.05,
        top_m: 4.0,
    };
    let mut body = free(Start::Standing);
    body.ground = Ground::new(&ramp);
    body.motion.position.z += 0.06;
    run(&mut body, 0.25, |_| LOCKED);
    let (roll, _, _) = body.motion.attitude.euler_angles();
    // 0.05 m over the track of 0.42 m, right side down, after a fall and before it tips over.
    assert!((0.05..0.25).contains(&roll), "{roll}");
}

#[test]
fn no_torque_and_no_fall_makes_it_infinite() {
    let mut seed = 1_u64;
    let mut random = move || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    };
    let terrains = [
        Terrain::Flat,
        Terrain::Gap {
            at_m: 0.1,
            width_m: 0.1,
            depth_m: 0.2,
        },
        Terrain::Plates {
            start_m: -2.0,
            count: 40,
            length_m: 0.1,
            height_m: 0.05,
            tilt_rad: 0.2,
            seed: 3,
        },
        Terrain::OneSidedRamp {
            start_m: 0.1,
            angle_rad: 0.2,
            height_m: 0.1,
            top_m: 0.5,
        },
    ];
    for terrain in terrains {
        for most_nm in [5.0, 50.0, 1e9] {
            let setup = FreeSetup {
                start: Start::Standing,
                terrain,
                ..FreeSetup::default()
            };
            let mut body = FreeBody::new(&robot(), &setup);
            for _ in 0..100 {
                let mut inputs = FreeInputs {
                    wheel_nm: std::array::from_fn(|_| most_nm * random()),
                    joint_nm: std::array::from_fn(|_| most_nm * random()),
                    ..LIMP
                };
                if random() > 0.9 {
                    inputs.joint_nm[1] = f64::NAN;
                }
                run(&mut body, 0.02, |_| inputs);
                let state = body.state();
                let all = state
                    .position_m
                    .iter()
                    .chain(&state.attitude)
                    .chain(&state.joint_rad);
                assert!(
                    all.chain(&state.joint_rps).all(|it| it.is_finite()),
                    "{state:?}"
                );
                assert!(
                    state.position_m[2] > -1.0,
                    "{terrain:?} {most_nm} {state:?}"
                );
            }
        }
    }
}
