use proptest::{num::f32::ANY, prelude::*};

use super::*;

const CONFIG: JointConfig = JointConfig {
    direction: 1.0,
    zero_rad: 0.0,
    min_rad: -1.5,
    max_rad: 1.0,
    max_torque_nm: 3.0,
    max_speed_rps: 15.0,
    max_kp: 100.0,
    max_kd: 5.0,
};
const MOTOR: MotorLimits = MotorLimits {
    max_torque_nm: 7.0,
    horizon_s: 0.004,
};
const AT_REST: JointMotion = JointMotion {
    pos_rad: 0.0,
    vel_rps: 0.0,
};

fn mit(pos_rad: f32, vel_rps: f32, kp: f32, kd: f32, tau_nm: f32) -> JointCommand {
    JointCommand {
        mode: JointMode::Mit,
        pos_rad,
        vel_rps,
        kp,
        kd,
        tau_nm,
    }
}

/// The torque by the motor's formula, in double precision, `ahead_s` from now.
fn torque_nm(command: &JointCommand, motion: JointMotion, ahead_s: f64) -> f64 {
    let [pos, vel, kp, kd, tau] = [
        command.pos_rad,
        command.vel_rps,
        command.kp,
        command.kd,
        command.tau_nm,
    ]
    .map(f64::from);
    let (q, speed) = (f64::from(motion.pos_rad), f64::from(motion.vel_rps));
    kp * (pos - q - speed * ahead_s) + kd * (vel - speed) + tau
}

#[test]
fn a_command_within_the_limits_is_unchanged() {
    let command = mit(0.1, 0.5, 20.0, 0.5, 0.25);
    assert_eq!(limit_command(&command, AT_REST, &CONFIG, MOTOR), command);
}

/// Infinity is clamped to the limits, also beside zeros and other infinities. Only NaN is rejected.
#[test]
fn infinite_fields_and_limits_are_clamped_not_refused() {
    const INF: f32 = f32::INFINITY;
    // All fields are infinite, and then each one is zero among the others.
    for zero in 0..=5 {
        let field = |index| if index == zero { 0.0 } else { INF };
        let command = mit(field(0), field(1), field(2), field(3), field(4));
        let got = limit_command(&command, AT_REST, &CONFIG, MOTOR);
        assert_eq!(got.mode, JointMode::Mit, "{command:?}");
        let config = JointConfig {
            max_torque_nm: field(0),
            max_speed_rps: field(1),
            max_kp: field(2),
            max_kd: field(3),
            ..CONFIG
        };
        let got = limit_command(&mit(0.1, 0.0, 1.0, 0.0, 0.0), AT_REST, &config, MOTOR);
        assert_eq!(got.mode, JointMode::Mit, "{config:?}");
        let slide = JointCommand {
            mode: JointMode::PositionSpeed,
            ..command
        };
        let got = limit_command(&slide, AT_REST, &CONFIG, MOTOR);
        assert_eq!(got.mode, JointMode::PositionSpeed, "{slide:?}");
    }
}

/// No torque is requested and none allowed, so nothing is scaled.
#[test]
fn gains_that_give_no_torque_are_not_scaled() {
    let config = JointConfig {
        max_torque_nm: 0.0,
        ..CONFIG
    };
    let command = mit(0.0, 0.0, 20.0, 0.5, 0.0);
    assert_eq!(limit_command(&command, AT_REST, &config, MOTOR), command);
}

/// 100 · 0.5 + 1 · 10 − 0 = 60 N·m is twenty times the limit.
#[test]
fn excessive_torque_scales_all_gains_alike() {
    let command = mit(0.5, 10.0, 100.0, 1.0, 0.0);
    let got = limit_command(&command, AT_REST, &CONFIG, MOTOR);
    assert_eq!((got.pos_rad, got.vel_rps), (0.5, 10.0));
    assert!((got.kp - 5.0).abs() < 1e-5 && (got.kd - 0.05).abs() < 1e-6);
}

/// The stiff spring is at its target, but the joint passes at 10 rad/s. After 0.04 rad it would push with 4 N·m.
#[test]
fn the_torque_limit_covers_motion_until_the_next_command() {
    let motion = JointMotion {
        pos_rad: 0.5,
        vel_rps: 10.0,
    };
    let got = limit_command(&mit(0.5, 0.0, 100.0, 0.0, 0.0), motion, &CONFIG, MOTOR);
    assert!((got.kp - 75.0).abs() < 1e-4, "{got:?}");
}

#[test]
fn the_lower_limit_of_settings_and_motor_applies() {
    let weak = MotorLimits {
        max_torque_nm: 0.5,
        ..MOTOR
    };
    let got = limit_command(&mit(0.0, 0.0, 0.0, 0.0, 9.0), AT_REST, &CONFIG, weak);
    assert_eq!(got.tau_nm, 0.5);
}

#[test]
fn damping_does_not_push_a_returning_joint_outwards() {
    let coming_back = JointMotion {
        pos_rad: 1.1,
        vel_rps: -4.0,
    };
    let got = limit_command(&mit(1.0, 0.0, 0.0, 2.0, 0.0), coming_back, &CONFIG, MOTOR);
    assert_eq!((got.kp, got.kd, got.tau_nm), (0.0, 0.0, 0.0));
    let still_leaving = JointMotion {
        vel_rps: 1.0,
        ..coming_back
    };
    let got = limit_command(&mit(1.0, 0.0, 0.0, 2.0, 0.0), still_leaving, &CONFIG, MOTOR);
    assert_eq!(got.kd, 2.0);
}

/// The joint's zero is wrong, or it rests on a stop out there. 20 · (1.0 − 4.0) N·m would throw it back at the torque
/// limit.
#[test]
fn a_joint_held_beyond_its_soft_limit_is_not_thrown_back() {
    for (pos_rad, outwards) in [(4.0, 1.0), (-4.0, -1.0)] {
        let there = JointMotion {
            pos_rad,
            vel_rps: 0.0,
        };
        let target = |command: &JointCommand| limit_command(command, there, &CONFIG, MOTOR);
        let held = mit(pos_rad, 0.0, 20.0, 1.0, 0.0);
        assert_eq!(target(&held), held);
        let further_out = mit(pos_rad + outwards, 0.0, 20.0, 1.0, 0.0);
        assert_eq!(target(&further_out), held);
        let back_inside = target(&mit(0.0, 0.0, 20.0, 1.0, 0.0));
        let torque_nm = torque_nm(&back_inside, there, 0.0);
        assert!(
            (torque_nm * outwards as f64 + 3.0).abs() < 1e-3,
            "asked to, it comes back"
        );
    }
}

/// The limit is 15 rad/s. Damping, which brakes, stays.
#[test]
fn a_joint_as_fast_as_its_limit_gets_no_faster() {
    for (vel_rps, tau_nm, expected_nm) in [
        (14.9, 1.0, 1.0),
        (15.0, 1.0, 0.0),
        (15.0, -1.0, -1.0),
        (-15.0, -1.0, 0.0),
        (-15.0, 1.0, 1.0),
        (-14.9, -1.0, -1.0),
    ] {
        let motion = JointMotion { vel_rps, ..AT_REST };
        let got = limit_command(&mit(0.0, 0.0, 0.0, 0.0, tau_nm), motion, &CONFIG, MOTOR);
        assert_eq!(got.tau_nm, expected_nm, "{vel_rps} rad/s");
        let braked = mit(0.0, 0.0, 0.0, 0.1, 0.0);
        assert_eq!(limit_command(&braked, motion, &CONFIG, MOTOR), braked);
    }
}

#[test]
fn the_other_modes_are_limited_in_angle_and_speed() {
    let command = JointCommand {
        mode: JointMode::PositionSpeed,
        ..mit(9.0, -99.0, 1.0, 1.0, 1.0)
    };
    let expected = JointCommand {
        mode: JointMode::PositionSpeed,
        ..mit(1.0, 15.0, 0.0, 0.0, 0.0)
    };
    assert_eq!(limit_command(&command, AT_REST, &CONFIG, MOTOR), expected);
    let at_end = JointMotion {
        pos_rad: 1.0,
        vel_rps: 0.0,
    };
    let speed = |vel_rps| JointCommand {
        mode: JointMode::Speed,
        vel_rps,
        ..JointCommand::default()
    };
    assert_eq!(
        limit_command(&speed(2.0), at_end, &CONFIG, MOTOR),
        speed(0.0)
    );
    assert_eq!(
        limit_command(&speed(-2.0), at_end, &CONFIG, MOTOR),
        speed(-2.0)
    );
    assert_eq!(
        limit_command(&speed(-99.0), at_end, &CONFIG, MOTOR),
        speed(-15.0)
    );
}

/// 10 rad/s are 0.04 rad in the 4 ms until the next command, and 0.5 rad in 50 ms without reports.
#[test]
fn an_outward_speed_ends_before_the_soft_limit() {
    let speed_at = |pos_rad, horizon_s| {
        let command = JointCommand {
            mode: JointMode::Speed,
            ..mit(0.0, 10.0, 0.0, 0.0, 0.0)
        };
        let motion = JointMotion {
            pos_rad,
            vel_rps: 10.0,
        };
        let motor = MotorLimits { horizon_s, ..MOTOR };
        limit_command(&command, motion, &CONFIG, motor).vel_rps
    };
    assert_eq!((speed_at(0.95, 0.004), speed_at(0.97, 0.004)), (10.0, 0.0));
    assert_eq!((speed_at(0.45, 0.05), speed_at(0.55, 0.05)), (10.0, 0.0));
}

#[test]
fn nan_limits_allow_nothing() {
    let nan = f32::NAN;
    for config in [
        JointConfig {
            max_torque_nm: nan,
            ..CONFIG
        },
        JointConfig {
            max_speed_rps: nan,
            ..CONFIG
        },
        JointConfig {
            max_kp: nan,
            ..CONFIG
        },
        JointConfig {
            max_kd: nan,
            ..CONFIG
        },
        JointConfig {
            min_rad: nan,
            ..CONFIG
        },
        JointConfig {
            min_rad: 2.0,
            ..CONFIG
        },
    ] {
        let got = limit_command(&mit(0.1, 0.0, 20.0, 1.0, 1.0), AT_REST, &config, MOTOR);
        assert_eq!(got, JointCommand::default(), "{config:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_torque_stays_within_its_limit_for_any_command(
        fields in [ANY; 5],
        scale in 0.1_f32..1e4,
        pos_rad in -3.0_f32..3.0,
        vel_rps in -30.0_f32..30.0,
    ) {
        let bounded = fields.map(|field| if field.is_finite() { field % scale } else { field });
        let [pos, vel, kp, kd, tau] = bounded;
        let motion = JointMotion { pos_rad, vel_rps };
        let got = limit_command(&mit(pos, vel, kp, kd, tau), motion, &CONFIG, MOTOR);
        prop_assert!([got.pos_rad, got.vel_rps, got.kp, got.kd, got.tau_nm].iter().all(|x| x.is_finite()));
        let (furthest_back, furthest_out) = (pos_rad.min(-1.5), pos_rad.max(1.0));
        prop_assert!((furthest_back..=furthest_out).contains(&got.pos_rad) && got.vel_rps.abs() <= 15.0);
        prop_assert!((0.0..=100.0).contains(&got.kp) && (0.0..=5.0).contains(&got.kd));
        for ahead_s in [0.0, 0.002, 0.004] {
            let torque = torque_nm(&got, motion, ahead_s);
            prop_assert!(torque.abs() <= 3.0 + 1e-3, "{got:?} {torque}");
        }
        let now_nm = torque_nm(&got, motion, 0.0);
        if pos_rad >= 1.0 {
            prop_assert!(now_nm <= 1e-3, "{got:?} {now_nm}");
        }
        if pos_rad <= -1.5 {
            prop_assert!(now_nm >= -1e-3, "{got:?} {now_nm}");
        }
    }
}
