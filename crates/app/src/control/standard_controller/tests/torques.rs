//! Which way the torques act.

use proptest::prelude::*;

use super::*;

#[test]
fn a_robot_that_leans_forward_drives_forward() {
    for (pitch_rad, sign) in [(0.05, 1.0), (-0.05, -1.0)] {
        let mut robot = Robot::standing();
        let mut controller = robot.balancing();
        robot.pitched(pitch_rad);
        let [left, right] = robot.step(&mut controller).cmd.wheels;
        // The right motor sits mirrored.
        assert!(left.current_ma * sign > 500.0, "{left:?}");
        assert!(right.current_ma * sign < -500.0, "{right:?}");
    }
}

/// Thighs of the lower side go down, and those of the other side stay up.
#[test]
fn a_robot_on_its_face_pushes_with_its_knees() {
    for pitch_rad in [1.6, -1.6] {
        let mut robot = Robot::standing();
        robot.permit = StandPermit::StandingUp;
        robot.pitched(pitch_rad);
        robot.thighs(0.7, 0.0);
        let output = robot.step(&mut StandardController::default());
        let [front, rear, ..] = output.cmd.joints.map(|joint| joint.tau_nm);
        let (lower_up, other_up) = if pitch_rad > 0.0 {
            (front, -rear)
        } else {
            (-rear, front)
        };
        assert!(lower_up < -4.0 && lower_up <= other_up, "{front} {rear}");
    }
}

/// The right motor sits mirrored.
#[test]
fn a_left_turn_drives_the_right_wheel_forward() {
    for sign in [1.0, -1.0] {
        let mut robot = Robot::standing();
        let mut controller = robot.balancing();
        robot.command.wz = sign;
        for _ in 0..50 {
            robot.step(&mut controller);
        }
        let [left, right] = robot.step(&mut controller).cmd.wheels;
        let (left_ma, right_ma) = (left.current_ma * sign, -right.current_ma * sign);
        assert!(left_ma < -500.0 && right_ma > 500.0, "{left_ma} {right_ma}");
    }
}

/// How much more torque each hip has after `change` than without it, in N·m: left front, left rear, right front, right rear.
/// A front hip with less, or a rear hip with more, pushes its leg longer.
fn hips_after(change: impl Fn(&mut Robot)) -> [f32; 4] {
    let mut robot = Robot::standing();
    let controller = robot.balancing();
    let mut tau_nm = || {
        let joints = robot.step(&mut controller.clone()).cmd.joints;
        change(&mut robot);
        joints.map(|joint| joint.tau_nm)
    };
    let (before, after) = (tau_nm(), tau_nm());
    core::array::from_fn(|joint| after[joint] - before[joint])
}

/// The extra push of the left and the right leg, in N·m of their hips.
fn pushes([left_front, left_rear, right_front, right_rear]: [f32; 4]) -> [f32; 2] {
    [left_rear - left_front, right_rear - right_front]
}

#[test]
fn a_robot_whose_right_side_is_down_pushes_with_its_right_leg() {
    for sign in [1.0, -1.0] {
        let [left, right] = pushes(hips_after(|robot| {
            let (sin, cos) = (0.05_f32 * sign).sin_cos();
            robot.estimate.q_wxyz = [cos, sin, 0.0, 0.0];
        }));
        assert!(right * sign > 0.2 && left * sign < -0.2, "{left} {right}");
        let [left, right] = pushes(hips_after(|robot| {
            robot.sensors.imu.gyro_dps[0] = 30.0 * sign;
        }));
        assert!(right * sign > 0.1 && left * sign < -0.1, "{left} {right}");
    }
}

/// Thighs that hang lower make a longer leg.
#[test]
fn a_robot_that_sags_pushes_with_both_legs() {
    for sign in [1.0, -1.0] {
        let [left, right] = pushes(hips_after(|robot| {
            robot.thighs(-0.3 + 0.05 * sign, 0.0);
        }));
        assert!(left * sign > 0.2 && right * sign > 0.2, "{left} {right}");
    }
}

/// Both hips of a leg that is ahead of the other get torque backward, those of the other forward.
#[test]
fn legs_that_are_apart_are_brought_together() {
    for sign in [1.0, -1.0] {
        let [left_front, left_rear, right_front, right_rear] = hips_after(|robot| {
            let joints = &mut robot.sensors.motor.joints;
            for (joint, way) in joints.iter_mut().zip([1.0, 1.0, -1.0, -1.0]) {
                joint.pos_rad += 0.05 * sign * way;
            }
        });
        let (left, right) = (left_front + left_rear, right_front + right_rear);
        assert!(left * sign < -0.1 && right * sign > 0.1, "{left} {right}");
    }
}

/// The square of such an attitude is no number, and neither is the speed along its heading.
#[test]
fn an_attitude_too_large_to_square_takes_the_torque_away() {
    let mut robot = Robot::standing();
    let mut controller = robot.balancing();
    robot.estimate.q_wxyz = [0.0, 0.0, 0.0, 1.8e20];
    let command = robot.step(&mut controller).cmd;
    assert!(command.wheels.iter().all(|wheel| wheel.current_ma == 0.0));
    assert!(command.joints.iter().all(|joint| joint.tau_nm == 0.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the sensors say, nothing but numbers is commanded.
    #[test]
    fn every_command_is_finite(
        ticks in prop::collection::vec((any::<[f32; 12]>(), [-1.6_f32..1.6, -1.6_f32..1.6, -1.6_f32..1.6, -1.6_f32..1.6], any::<bool>()), 1..40),
    ) {
        let mut robot = Robot::standing();
        let mut controller = robot.balancing();
        for (odd, angles, is_odd) in ticks {
            let [a, b, c, d, e, f, g, h, i, j, k, l] = odd;
            for (joint, angle) in robot.sensors.motor.joints.iter_mut().zip(angles) {
                joint.pos_rad = angle;
            }
            if is_odd {
                robot.sensors.imu.gyro_dps = [a, b, c];
                robot.sensors.imu.accel_mps2 = [d, e, f];
                robot.estimate.q_wxyz = [g, h, i, j];
                robot.sensors.motor.joints[1].vel_rps = k;
                robot.sensors.motor.joints[2].torque_nm = l;
                robot.command.vx = a;
                robot.command.height = b;
            } else {
                let rest = Robot::standing();
                robot.sensors.imu = rest.sensors.imu;
                robot.estimate = rest.estimate;
            }
            let output = robot.step(&mut controller);
            for wheel in output.cmd.wheels {
                prop_assert!(wheel.current_ma.is_finite());
            }
            for joint in output.cmd.joints {
                prop_assert!(joint.tau_nm.is_finite());
            }
        }
    }
}
