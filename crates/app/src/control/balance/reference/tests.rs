use super::*;

const DT_S: f32 = 0.001;

fn follow(reference: &mut Reference, wish: Wish, seconds: f32) -> Vec<Reference> {
    let ticks = (seconds / DT_S) as usize;
    let mut steps = Vec::new();
    for _ in 0..ticks {
        let (speed_mps, yaw_rps) = (reference.speed_mps, reference.yaw_rps);
        reference.step(wish, speed_mps, yaw_rps, DT_S);
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
        pushed.step(Wish::default(), 0.3, 0.0, DT_S);
        drifting.step(Wish::default(), 0.04, 0.0, DT_S);
    }
    assert!(pushed.distance_m < 0.031, "{pushed:?}");
    assert!((drifting.distance_m - 0.04).abs() < 1e-3, "{drifting:?}");
    for _ in 0..10_000 {
        drifting.step(Wish::default(), 0.2, 0.0, DT_S);
    }
    assert_eq!(drifting.distance_m, MAX_DISTANCE_M);
}
