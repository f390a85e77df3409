use super::*;
use crate::domain::robots;

fn by_hand(schedule: &GainSchedule, input: usize, state: usize, [left, right]: [f32; 2]) -> f32 {
    let [one, l, r, ll, lr, rr] = schedule.k[input][state];
    let (x, y) = (left - schedule.centre_m, right - schedule.centre_m);
    one + l * x + r * y + ll * x * x + lr * x * y + rr * y * y
}

#[test]
fn a_row_is_renewed_in_each_tick() {
    let schedule = &robots::FIVEBAR.balance.gains;
    let (first, then) = ([0.16, 0.22], [0.18, 0.2]);
    let mut gains = Gains::new(schedule, first);
    for renewed in 0..=INPUTS {
        for input in 0..INPUTS {
            let lengths = if input < renewed { then } else { first };
            for state in 0..STATES {
                let wanted = by_hand(schedule, input, state, lengths);
                let found = gains.rows[input][state];
                assert!((found - wanted).abs() < 1e-4, "{input} {state}");
            }
        }
        gains.renew(schedule, then);
    }
}

#[test]
fn lengths_beyond_the_fit_count_as_its_ends() {
    let schedule = &robots::FIVEBAR.balance.gains;
    let beyond = Gains::new(schedule, [0.0, 1.0]);
    assert_eq!(
        beyond,
        Gains::new(schedule, [schedule.min_m, schedule.max_m])
    );
}

/// A robot that leans or drives forward drives its wheels forward under it, or back.
#[test]
fn the_torques_have_the_signs_that_balance() {
    let gains = Gains::new(&robots::FIVEBAR.balance.gains, [0.18; 2]);
    let only = |state: usize| {
        let mut error = [0.0; STATES];
        error[state] = 0.1;
        gains.torques_nm(&error)
    };
    let both_lean = {
        let mut error = [0.0; STATES];
        (error[4], error[6]) = (0.1, 0.1);
        gains.torques_nm(&error)
    };
    assert!(both_lean[0] > 0.5 && both_lean[1] > 0.5, "{both_lean:?}");
    // A nose that dips is lifted by the body's own torque on the legs, forward.
    let dips = only(8);
    assert!(dips[2] > 0.3 && dips[3] > 0.3, "{dips:?}");
    // Turned too far left: the left wheel drives forward, the right one back.
    let left = only(2);
    assert!(left[0] > 0.0 && left[1] < 0.0, "{left:?}");
    // A wheeled pendulum that is ahead of its place drives on first, so that it leans back.
    let ahead = only(0);
    assert!(ahead[0] > 0.0 && ahead[1] > 0.0, "{ahead:?}");
}
