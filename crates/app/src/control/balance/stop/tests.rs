use super::*;

const DT_S: f32 = 0.001;

const BRAKING: Motion = Motion {
    speed_mps: 0.7,
    accel_mps2: -4.0,
};

#[test]
fn speed_acceleration_and_jerk_end_together() {
    let mut braking = Pushed {
        brakes: true,
        lasts_s: 0.0,
    };
    let mut stop = braking.step(0.5, 0.0, &BRAKING, DT_S).expect("it brakes");
    let mut plan = BRAKING;
    let mut most_mps3 = 0.0_f32;
    loop {
        let hips = plan;
        let goes_on = stop.step(&mut plan, 0.0, &hips, DT_S);
        most_mps3 = most_mps3.max(stop.jerk_mps3.abs());
        if stop.left_s < 0.0 {
            assert!(plan.speed_mps.abs() < 0.02, "{plan:?}");
        }
        if !goes_on {
            break;
        }
    }
    assert!(plan.accel_mps2.abs() < 0.05 && stop.jerk_mps3.abs() < 1.0);
    assert!(most_mps3 < 25.0, "{most_mps3}");
}

#[test]
fn it_begins_when_time_is_just_enough() {
    let begins = |speed_mps, accel_mps2| {
        let hips = Motion {
            speed_mps,
            accel_mps2,
        };
        let mut pushed = Pushed::default();
        pushed.step(speed_mps, 0.0, &hips, DT_S).is_some()
    };
    for forward in [1.0, -1.0] {
        assert!(begins(forward * 0.7, forward * -4.0));
        assert!(!begins(forward * 1.0, forward * -4.0), "it brakes on");
        assert!(
            !begins(forward * 1.0, forward * -8.0),
            "it may have no grip"
        );
        assert!(!begins(forward * 0.7, forward * 4.0), "it does not brake");
        assert!(!begins(forward * 0.35, forward * -4.0), "it was not pushed");
    }
}

#[test]
fn a_robot_that_no_longer_brakes_was_not_pushed() {
    let mut pushed = Pushed::default();
    let fast = Motion {
        speed_mps: 2.0,
        accel_mps2: -4.0,
    };
    assert_eq!(pushed.step(2.0, 0.0, &fast, DT_S), None);
    assert!(pushed.brakes);
    let coasting = Motion {
        speed_mps: 0.2,
        accel_mps2: -0.2,
    };
    assert_eq!(pushed.step(0.2, 0.0, &coasting, DT_S), None);
    assert_eq!(pushed.step(0.2, 0.0, &BRAKING, DT_S), None);
}

#[test]
fn the_plan_stays_near_the_robot() {
    let mut stop = Stop {
        left_s: TAKES_S,
        jerk_mps3: 0.0,
    };
    let mut plan = BRAKING;
    stop.step(
        &mut plan,
        0.0,
        &Motion {
            speed_mps: 2.0,
            accel_mps2: 0.0,
        },
        DT_S,
    );
    assert_eq!(plan.speed_mps, 2.0 - NEAR_MPS);
}

/// A centre of mass that nobody knows of makes a robot lean and roll on as if it had been pushed and braked.
#[test]
fn what_lasts_is_no_push() {
    let rolling_on = Motion {
        speed_mps: 3.0,
        accel_mps2: -1.0,
    };
    for off_mps in [0.3, 0.5] {
        let mut pushed = Pushed::default();
        assert_eq!(pushed.step(0.5, 0.0, &rolling_on, DT_S), None);
        assert!(pushed.brakes);
        let mut lasts_s = 0.0;
        for _ in 0..3_000 {
            assert_eq!(pushed.step(off_mps, 0.0, &rolling_on, DT_S), None);
            if pushed.brakes {
                lasts_s += DT_S;
            }
        }
        assert!((lasts_s - LASTS_S).abs() < 0.01, "{lasts_s}");
        assert!(!pushed.brakes);
    }
}

/// A second push, or a wall.
#[test]
fn a_stop_that_is_disturbed_asks_for_no_more_lean_than_there_is() {
    for forward in [1.0, -1.0] {
        let mut stop = Stop {
            left_s: 0.3,
            jerk_mps3: 0.0,
        };
        let mut plan = BRAKING;
        let pushed = Motion {
            speed_mps: forward * 2.5,
            accel_mps2: 0.0,
        };
        while stop.step(&mut plan, 0.0, &pushed, DT_S) {
            assert!(plan.accel_mps2.abs() <= MOST_MPS2, "{plan:?}");
        }
    }
}
