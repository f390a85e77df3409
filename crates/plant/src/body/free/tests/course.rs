//! On courses: steps, ramps, falls, and whatever may come.

use super::*;

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
        if cart.wheel_contact_n() == [0.0; 2] && lowest_m > radius_m(&cart) - 0.15 {
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
            let behind_rps = 1.0 / radius_m(cart) - cart.wheel_abs_rps()[0];
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
fn a_wheel_that_comes_from_the_side_does_not_leap_onto_a_ramp() {
    let ramp = Terrain::OneSidedRamp {
        start_m: -1.0,
        angle_rad: 0.5,
        height_m: 0.05,
        top_m: 4.0,
    };
    let mut cart = cart(Terrain::Flat, 0.8);
    cart.ground = Ground::new(&ramp);
    let mut state = cart.state();
    state.position_m[1] = -0.25;
    state.velocity_mps = [0.0, 1.0, 0.0];
    cart.set_state(&state);
    let start_m = state.position_m[2];
    run(&mut cart, 0.1, |_| FreeInputs {
        grip: 0.0,
        ..LOCKED
    });
    let state = cart.state();
    assert!(state.position_m[1] > -0.16, "{state:?}");
    assert!((state.position_m[2] - start_m).abs() < 2e-3, "{state:?}");
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

#[test]
fn ground_that_would_not_be_as_said_is_unsound() {
    let slope = |angle_rad, length_m| Terrain::Slope {
        start_m: 1.0,
        angle_rad,
        length_m,
    };
    let ramp = |angle_rad, top_m| Terrain::OneSidedRamp {
        start_m: 1.0,
        angle_rad,
        height_m: 0.1,
        top_m,
    };
    let plates = |count, tilt_rad| Terrain::Plates {
        start_m: 1.0,
        count,
        length_m: 0.1,
        height_m: 0.05,
        tilt_rad,
        seed: 3,
    };
    let sound = [
        slope(-1.05, 0.0),
        slope(0.26, 4.0),
        ramp(0.01, 0.0),
        plates(64, 1.0),
    ];
    for terrain in sound {
        assert!(terrain.is_sound(), "{terrain:?}");
    }
    let unsound = [
        slope(1.1, 4.0),
        slope(-1.1, 4.0),
        slope(f64::NAN, 4.0),
        slope(0.0, -0.1),
        slope(0.0, 1001.0),
        ramp(0.009, 0.0),
        ramp(-0.1, 0.0),
        ramp(1.1, 0.0),
        ramp(0.1, -0.1),
        plates(65, 0.1),
        plates(8, 1.1),
        plates(8, -0.1),
    ];
    for terrain in unsound {
        assert!(!terrain.is_sound(), "{terrain:?}");
    }
}
