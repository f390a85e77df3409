//! Currents worked out by hand from the M3508's datasheet: 0.3 N·m/A at the output of its gear of 3591:187.

use super::*;

const FRESH_US: u32 = 50_000;

fn wheel(speed_rps: f32, kd: f32) -> WheelTarget {
    WheelTarget {
        speed_rps,
        kp: 0.0,
        kd,
    }
}

/// Currents in the motors' own direction, with the rotors at these speeds.
fn currents_ma(targets: [WheelTarget; 2], rpm: [i16; 2], odom: &WheelOdomConfig) -> [f32; 2] {
    let mut motor = MotorFeedback::default();
    for (wheel, rpm) in motor.wheels.iter_mut().zip(rpm) {
        wheel.rpm = rpm;
        wheel.age_us = FRESH_US;
    }
    let pc = PcCommand {
        wheels: targets,
        ..PcCommand::default()
    };
    let command = pc_law(&pc, &motor, odom, &WheelControllerConfig::default());
    command.wheels.map(|wheel| wheel.current_ma)
}

fn assert_close(actual: [f32; 2], expected: [f32; 2]) {
    for (actual, expected) in actual.into_iter().zip(expected) {
        assert!((actual - expected).abs() < 2.0, "{actual} {expected}");
    }
}

/// 0.1 N·m·s/rad · 6 rad/s = 0.6 N·m = 2 A, forward. The right motor sits mirrored.
#[test]
fn the_torque_at_standstill_is_the_damping_times_the_target() {
    let odom = WheelOdomConfig::default();
    let forward = currents_ma([wheel(6.0, 0.1); 2], [0; 2], &odom);
    assert_close(forward, [2_000.0, -2_000.0]);
    let turning = currents_ma([wheel(-6.0, 0.1), wheel(6.0, 0.1)], [0; 2], &odom);
    assert_close(turning, [-2_000.0, -2_000.0]);
}

/// 1,833.8 rpm of the rotor are 95.49 rpm, or 10 rad/s, of the wheel. 0.06 · (4 − 10) = −0.36 N·m = −1.2 A.
#[test]
fn the_torque_follows_the_speed_error() {
    let odom = WheelOdomConfig::default();
    let braking = currents_ma([wheel(4.0, 0.06); 2], [1_834, -1_834], &odom);
    assert_close(braking, [-1_200.0, 1_200.0]);
    let reached = currents_ma([wheel(10.0, 0.06); 2], [1_834, -1_834], &odom);
    assert_close(reached, [0.0; 2]);
}

/// Without its gear of 19.2 the motor gives 0.015622 N·m/A, so 0.15622 N·m take 10 A through a gear of 1, and 5 A
/// through a gear of 2. The rotor is 1000 rpm = 104.72 rad/s fast.
#[test]
fn the_torque_constant_follows_the_gear_ratio() {
    let mut odom = WheelOdomConfig {
        gear_ratio: 2.0,
        ..WheelOdomConfig::default()
    };
    let damping = 0.156_22;
    assert_close(
        currents_ma([wheel(1.0, damping); 2], [0; 2], &odom),
        [5_000.0, -5_000.0],
    );
    assert_close(
        currents_ma([wheel(53.36, damping); 2], [1_000, -1_000], &odom),
        [5_000.0, -5_000.0],
    );
    odom.rpm_sign_left = -1.0;
    assert_close(
        currents_ma([wheel(1.0, damping); 2], [0; 2], &odom),
        [-5_000.0, -5_000.0],
    );
}

#[test]
fn the_current_is_limited_and_needs_fresh_feedback() {
    let odom = WheelOdomConfig::default();
    let ctrl = WheelControllerConfig::default();
    for (age_us, expected) in [
        (0, 8_000.0),
        (50_000, 8_000.0),
        (50_001, 0.0),
        (u32::MAX, 0.0),
    ] {
        let mut motor = MotorFeedback::default();
        for wheel in &mut motor.wheels {
            wheel.age_us = age_us;
        }
        for target in [wheel(200.0, 1_000.0), wheel(f32::INFINITY, 1.0)] {
            let pc = PcCommand {
                wheels: [target; 2],
                ..PcCommand::default()
            };
            let [left, right] = pc_law(&pc, &motor, &odom, &ctrl).wheels;
            assert_eq!((left.current_ma, right.current_ma), (expected, -expected));
        }
    }
}

/// A damping that is negative would drive the wheel faster and faster.
#[test]
fn a_nonsense_damping_gives_no_torque() {
    let odom = WheelOdomConfig::default();
    for damping in [-0.1, f32::NEG_INFINITY, f32::NAN] {
        let currents = currents_ma([wheel(6.0, damping); 2], [0; 2], &odom);
        assert_eq!(currents.map(f32::abs), [0.0; 2], "{damping}");
    }
}

#[test]
fn the_stiffness_of_a_wheel_has_no_effect() {
    let odom = WheelOdomConfig::default();
    let stiff = WheelTarget {
        kp: 1_000.0,
        ..wheel(6.0, 0.1)
    };
    assert_close(currents_ma([stiff; 2], [0; 2], &odom), [2_000.0, -2_000.0]);
}

#[test]
fn a_joint_gets_its_target_by_the_mit_law() {
    let mut pc = PcCommand::default();
    for (joint, pos_rad) in pc.joints.iter_mut().zip([0.1, 0.2, 0.3, 0.4]) {
        *joint = JointTarget {
            pos_rad,
            kp: 20.0,
            kd: 1.0,
        };
    }
    let odom = WheelOdomConfig::default();
    let ctrl = WheelControllerConfig::default();
    let command = pc_law(&pc, &MotorFeedback::default(), &odom, &ctrl);
    assert_eq!(
        command.joints.map(|joint| joint.pos_rad),
        [0.1, 0.2, 0.3, 0.4]
    );
    for joint in command.joints {
        assert_eq!(
            (joint.mode, joint.kp, joint.kd),
            (JointMode::Mit, 20.0, 1.0)
        );
        assert_eq!((joint.vel_rps, joint.tau_nm), (0.0, 0.0));
    }
}
