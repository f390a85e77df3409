use super::*;

const DT_S: f32 = 0.001;

fn rolling(speed_mps: f32, yaw_rps: f32) -> Own {
    Own {
        speed_mps,
        yaw_rps,
        hips: Motion {
            speed_mps,
            accel_mps2: 0.0,
        },
    }
}

fn follow(reference: &mut Reference, wish: Wish, seconds: f32) -> Vec<Reference> {
    let ticks = (seconds / DT_S) as usize;
    let mut steps = Vec::new();
    for _ in 0..ticks {
        let own = rolling(reference.speed_mps, reference.yaw_rps);
        reference.step(wish, &own, true, DT_S);
        steps.push(*reference);
    }
    steps
}

#[test]
fn the_speed_is_reached_without_overshoot_or_haste() {
    let wish = Wish {
        speed_mps: 2.5,
        yaw_rps: 0.0,
    };
    let steps = follow(&mut Reference::default(), wish, 3.0);
    assert!(steps.iter().all(|step| step.speed_mps < 2.6));
    assert!(
        steps
            .iter()
            .all(|step| step.accel_mps2.abs() <= MAX_ACCEL_MPS2)
    );
    assert!((steps[1_999].speed_mps - 2.5).abs() < 0.05);
}

#[test]
fn a_fast_robot_turns_slowly() {
    let mut reference = Reference::at(2.5, 0.0);
    let wish = Wish {
        speed_mps: 2.5,
        yaw_rps: 8.0,
    };
    let steps = follow(&mut reference, wish, 2.0);
    let last = steps.last().expect("some steps");
    assert!((last.yaw_rps * last.speed_mps - MAX_SIDEWAYS_MPS2).abs() < 0.1);
    let wish = Wish {
        speed_mps: 0.0,
        yaw_rps: 8.0,
    };
    let steps = follow(&mut Reference::default(), wish, 1.0);
    assert!((steps.last().expect("some steps").yaw_rps - 8.0).abs() < 0.01);
}

#[test]
fn a_pushed_robot_lets_its_place_go_and_a_drifting_one_does_not() {
    let mut pushed = Reference::default();
    let mut drifting = Reference::default();
    for _ in 0..1_000 {
        pushed.step(Wish::default(), &rolling(0.3, 0.0), true, DT_S);
        drifting.step(Wish::default(), &rolling(0.04, 0.0), true, DT_S);
    }
    assert!(pushed.distance_m < 0.031, "{pushed:?}");
    assert!((drifting.distance_m - 0.04).abs() < 1e-3, "{drifting:?}");
    for _ in 0..10_000 {
        drifting.step(Wish::default(), &rolling(0.2, 0.0), true, DT_S);
    }
    assert_eq!(drifting.distance_m, MAX_DISTANCE_M);
}

#[test]
fn a_robot_that_brakes_after_a_push_stops_as_planned() {
    for forward in [1.0, -1.0] {
        let mut reference = Reference::default();
        let mut hips = Motion {
            speed_mps: forward * 1.5,
            accel_mps2: forward * -4.0,
        };
        let mut planned_s = 0.0;
        for _ in 0..1_000 {
            let own = Own {
                speed_mps: hips.speed_mps,
                yaw_rps: 0.0,
                hips,
            };
            reference.step(Wish::default(), &own, true, DT_S);
            if reference.stop.is_some() {
                planned_s += DT_S;
                hips.accel_mps2 = reference.accel_mps2;
            }
            hips.speed_mps += hips.accel_mps2 * DT_S;
        }
        assert!((0.3..0.6).contains(&planned_s), "{planned_s}");
        assert!(
            reference.stop.is_none() && hips.speed_mps.abs() < 0.01,
            "{hips:?}"
        );
        assert!(reference.accel_mps2.abs() < 0.1 && reference.distance_m.abs() < 0.01);
    }
}

#[test]
fn a_robot_that_has_other_things_to_do_plans_no_stop() {
    let braking = |speed_mps: f32| Own {
        speed_mps,
        yaw_rps: 0.0,
        hips: Motion {
            speed_mps,
            accel_mps2: -4.0,
        },
    };
    for may_stop in [true, false] {
        let mut reference = Reference::default();
        reference.step(Wish::default(), &braking(1.5), true, DT_S);
        assert!(reference.catches());
        reference.step(Wish::default(), &braking(0.6), may_stop, DT_S);
        assert_eq!(reference.stop.is_some(), may_stop);
        assert_eq!(reference.catches(), may_stop);
    }
}

#[test]
fn a_robot_that_was_not_pushed_plans_no_stop() {
    let wish = Wish {
        speed_mps: 0.0,
        yaw_rps: 0.0,
    };
    let mut reference = Reference::at(2.5, 0.0);
    for _ in 0..2_000 {
        let hips = Motion {
            speed_mps: reference.speed_mps + 0.2,
            accel_mps2: reference.accel_mps2,
        };
        let own = Own {
            speed_mps: hips.speed_mps,
            yaw_rps: 0.0,
            hips,
        };
        reference.step(wish, &own, true, DT_S);
        assert!(reference.stop.is_none());
    }
}

/// Driving pulls the wheels away from the wish as well.
#[test]
fn a_robot_that_is_asked_to_drive_is_not_caught() {
    let pushed = Own {
        speed_mps: 2.5,
        yaw_rps: 0.0,
        hips: Motion {
            speed_mps: 2.5,
            accel_mps2: -4.0,
        },
    };
    for (speed_mps, expected) in [(0.0, true), (0.1, true), (1.0, false), (-1.0, false)] {
        let wish = Wish {
            speed_mps,
            yaw_rps: 0.0,
        };
        let mut reference = Reference::default();
        reference.step(wish, &pushed, true, DT_S);
        assert_eq!(reference.catches(), expected, "{speed_mps}");
    }
}

/// A robot in the middle of a stop that is planned.
fn stopping() -> (Reference, Own) {
    let own = |speed_mps: f32| Own {
        speed_mps: speed_mps - 0.4,
        yaw_rps: 0.0,
        hips: Motion {
            speed_mps,
            accel_mps2: -4.0,
        },
    };
    let mut reference = Reference::default();
    reference.step(Wish::default(), &own(1.5), true, DT_S);
    for tick in 0..100_u8 {
        let hips_mps = 0.6 - 0.004 * f32::from(tick);
        reference.step(Wish::default(), &own(hips_mps), true, DT_S);
    }
    assert!(reference.stop.is_some() && reference.catches());
    (reference, own(0.2))
}

#[test]
fn a_wish_to_drive_waits_for_the_end_of_a_stop() {
    let (mut reference, mut own) = stopping();
    let wish = Wish {
        speed_mps: 2.5,
        yaw_rps: 0.0,
    };
    let mut waits_s = 0.0;
    while reference.speed_mps < 2.0 {
        let before = reference;
        reference.step(wish, &own, true, DT_S);
        let jerk_mps3 = (reference.accel_mps2 - before.accel_mps2) / DT_S;
        assert!(jerk_mps3.abs() < 100.0, "{before:?} {reference:?}");
        let more_mps = reference.speed_mps - before.speed_mps;
        assert!(more_mps.abs() < 0.01, "{before:?} {reference:?}");
        own.hips.speed_mps = reference.speed_mps;
        own.speed_mps = reference.speed_mps;
        waits_s += if reference.stop.is_some() { DT_S } else { 0.0 };
    }
    assert!((0.2..0.6).contains(&waits_s), "{waits_s}");
}

#[test]
fn a_robot_that_must_break_a_stop_off_follows_its_axles_again() {
    let (mut reference, own) = stopping();
    reference.step(Wish::default(), &own, false, DT_S);
    assert!(reference.stop.is_none() && !reference.catches());
    assert!((reference.speed_mps - own.speed_mps).abs() < 0.01);
    assert!(reference.accel_mps2.abs() <= MAX_ACCEL_MPS2);
}
