use proptest::prelude::*;

use super::*;
use crate::domain::{
    BalanceState, HighLevelCommand, JointControllerConfig, JointState, OperatorState,
    SensorsSnapshot, StandPermit, StateEstimate, WheelControllerConfig, WheelOdomConfig, robots,
};

/// A robot that stands on legs of some 0.18 m, upright.
struct Robot {
    sensors: SensorsSnapshot,
    estimate: StateEstimate,
    command: HighLevelCommand,
    permit: StandPermit,
}

impl Robot {
    fn standing() -> Self {
        let mut sensors = SensorsSnapshot {
            ts_us: 1_000_000,
            ..SensorsSnapshot::default()
        };
        sensors.imu.accel_mps2 = [0.0, 0.0, 9.8];
        for wheel in &mut sensors.motor.wheels {
            wheel.age_us = 1_000;
        }
        let angles = [-0.3, 0.3, -0.3, 0.3];
        for (joint, angle) in sensors.motor.joints.iter_mut().zip(angles) {
            joint.state = JointState::Enabled;
            joint.age_us = 0;
            joint.pos_rad = angle;
        }
        Self {
            sensors,
            estimate: StateEstimate {
                valid: true,
                ..StateEstimate::default()
            },
            command: HighLevelCommand {
                stand: true,
                ..HighLevelCommand::default()
            },
            permit: StandPermit::Standing,
        }
    }

    fn pitched(&mut self, pitch_rad: f32) {
        self.estimate.q_wxyz = [(pitch_rad / 2.0).cos(), 0.0, (pitch_rad / 2.0).sin(), 0.0];
    }

    fn step(&mut self, controller: &mut impl ChassisController) -> ChassisControllerOutput {
        self.sensors.ts_us += 1_000;
        controller.step(&ChassisControllerInput {
            sensors: &self.sensors,
            estimate: &self.estimate,
            wheel_odom_cfg: &WheelOdomConfig::default(),
            wheel_ctrl_cfg: &WheelControllerConfig::default(),
            joint_ctrl_cfg: &JointControllerConfig::default(),
            profile: &robots::FIVEBAR,
            operator_state: &OperatorState::default(),
            hl_cmd: self.command,
            stand: self.permit,
            wheels_stopped: false,
            joints_stopped: false,
        })
    }

    /// Steps until the robot balances, as its sensors say that it stands already.
    fn balancing(&mut self) -> StandardController {
        let mut controller = StandardController::default();
        for _ in 0..2_500 {
            if self.step(&mut controller).balance.state == BalanceState::Balance {
                return controller;
            }
        }
        panic!("the robot does not balance");
    }
}

/// While the stand switch is down, or standing is not permitted, everything is as with the wheel-speed controller.
#[test]
fn a_robot_that_is_not_asked_to_stand_sits() {
    for (stand, permit) in [(false, StandPermit::Standing), (true, StandPermit::Ready)] {
        let mut robot = Robot::standing();
        robot.command = HighLevelCommand {
            vx: 0.3,
            wz: -0.2,
            stand,
            ..robot.command
        };
        robot.permit = permit;
        let (mut here, mut there) = (StandardController::default(), DefaultController::default());
        for _ in 0..50 {
            assert_eq!(robot.step(&mut here), robot.step(&mut there));
        }
    }
}

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

/// Neither wheels nor knees reach the ground where they could push the robot upright.
#[test]
fn a_robot_on_a_side_or_its_top_has_no_torque() {
    for (roll_rad, can_rise) in [(0.0, true), (1.8, false), (-1.8, false), (3.1, false)] {
        let mut robot = Robot::standing();
        let (sin, cos) = f32::sin_cos(roll_rad / 2.0);
        robot.estimate.q_wxyz = [cos, sin, 0.0, 0.0];
        let output = robot.step(&mut StandardController::default());
        let stopped = output.cmd == crate::domain::ChassisCommand::STOP;
        assert_eq!(
            (output.balance.state == BalanceState::CannotRise, stopped),
            (!can_rise, !can_rise),
            "{roll_rad}"
        );
    }
}

/// Thighs of the lower side go down, and those of the other side stay up.
#[test]
fn a_robot_on_its_face_pushes_with_its_knees() {
    for pitch_rad in [1.6, -1.6] {
        let mut robot = Robot::standing();
        robot.permit = StandPermit::StandingUp;
        robot.pitched(pitch_rad);
        let angles = [0.7, -0.7, 0.7, -0.7];
        for (joint, angle) in robot.sensors.motor.joints.iter_mut().zip(angles) {
            joint.pos_rad = angle;
        }
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

#[test]
fn a_robot_beyond_recovery_has_no_torque_until_it_is_asked_again() {
    let mut robot = Robot::standing();
    let mut controller = robot.balancing();
    robot.pitched(1.2);
    for _ in 0..100 {
        let output = robot.step(&mut controller);
        assert_eq!(output.balance.state, BalanceState::Fallen);
        assert_eq!(output.cmd, crate::domain::ChassisCommand::STOP);
        robot.pitched(0.0);
    }
    robot.command.stand = false;
    assert_eq!(robot.step(&mut controller).balance.state, BalanceState::Sit);
    robot.command.stand = true;
    assert_eq!(
        robot.step(&mut controller).balance.state,
        BalanceState::StandUp
    );
}

#[test]
fn a_motor_that_is_lost_ends_balancing() {
    for lose in [0, 1] {
        let mut robot = Robot::standing();
        let mut controller = robot.balancing();
        if lose == 0 {
            robot.sensors.motor.wheels[1].age_us = 60_000;
        } else {
            robot.sensors.motor.joints[2].state = JointState::Silent;
        }
        let output = robot.step(&mut controller);
        assert_eq!(output.cmd, crate::domain::ChassisCommand::STOP);
    }
}

#[test]
fn a_reset_controller_begins_anew() {
    let mut robot = Robot::standing();
    let mut controller = robot.balancing();
    controller.reset();
    let first = robot.step(&mut controller);
    assert_eq!(first, robot.step(&mut StandardController::default()));
}

/// Angles of the front thighs, in rad, on which the legs are nearly at their shortest and at their longest.
const SHORT_RAD: f32 = 0.2;
const LONG_RAD: f32 = -1.25;

impl Robot {
    /// All joints at this angle of the front ones, mirrored at the rear, with this speed.
    fn thighs(&mut self, angle_rad: f32, speed_rps: f32) {
        let joints = &mut self.sensors.motor.joints;
        for (joint, sign) in joints.iter_mut().zip([1.0, -1.0, 1.0, -1.0]) {
            joint.pos_rad = sign * angle_rad;
            joint.vel_rps = sign * speed_rps;
        }
    }

    fn carries(&mut self, nm: f32) {
        let joints = &mut self.sensors.motor.joints;
        for (joint, sign) in joints.iter_mut().zip([-1.0, 1.0, -1.0, 1.0]) {
            joint.torque_nm = sign * nm;
        }
    }
}

impl Robot {
    /// State of the robot when the jump button is pressed.
    fn jumps_when_pressed(&mut self, controller: &mut StandardController) -> BalanceState {
        self.command.jump = false;
        self.step(controller);
        self.command.jump = true;
        self.step(controller).balance.state
    }
}

/// Crouching ends on short legs, the push on long ones. The legs then extend at 1 m/s, from which it flies for a tenth of a second at least.
#[test]
fn a_jump_crouches_pushes_flies_and_lands() {
    let mut robot = Robot::standing();
    robot.carries(1.9);
    let mut controller = robot.balancing();
    robot.command.jump = true;
    let state = |output: &ChassisControllerOutput| (output.balance.state, output.balance.airborne);
    for _ in 0..100 {
        let crouching = robot.step(&mut controller);
        assert_eq!(state(&crouching), (BalanceState::Jump, false));
    }
    robot.thighs(SHORT_RAD, 0.0);
    robot.step(&mut controller);
    let pushing = robot.step(&mut controller);
    assert_eq!(state(&pushing), (BalanceState::Jump, false));
    let [front, rear, ..] = pushing.cmd.joints.map(|joint| joint.tau_nm);
    let most_nm = robots::FIVEBAR.balance.limits.hip_nm;
    assert!(
        front < -0.8 * most_nm && rear > 0.8 * most_nm,
        "{front} {rear}"
    );
    robot.thighs(LONG_RAD, -12.0);
    robot.step(&mut controller);
    let flying = robot.step(&mut controller);
    assert_eq!(state(&flying), (BalanceState::Jump, true));
    let [front, rear, ..] = flying.cmd.joints.map(|joint| joint.tau_nm);
    assert!(
        front > 0.2 && rear < -0.2,
        "the legs are drawn in: {front} {rear}"
    );
    // On the ground again, with the weight on the legs.
    robot.thighs(-0.3, 0.0);
    let landed =
        (0..1_000).position(|_| robot.step(&mut controller).balance.state == BalanceState::Balance);
    assert!((50..400).contains(&landed.expect("landed")), "{landed:?}");
    for _ in 0..100 {
        let held = robot.step(&mut controller);
        assert_eq!(
            held.balance.state,
            BalanceState::Balance,
            "a button held makes one jump"
        );
    }
    assert_eq!(
        robot.jumps_when_pressed(&mut controller),
        BalanceState::Balance
    );
    for _ in 0..1_500 {
        robot.step(&mut controller);
    }
    assert_eq!(
        robot.jumps_when_pressed(&mut controller),
        BalanceState::Jump
    );
}

/// It lies on its nose, and nothing that it does helps.
#[test]
fn a_robot_that_does_not_get_up_gives_up_after_2600_ms() {
    let mut robot = Robot::standing();
    let mut controller = StandardController::default();
    robot.pitched(1.5);
    let ms = (0..4_000).position(|_| {
        let output = robot.step(&mut controller);
        output.balance.state == BalanceState::Fallen
            && output.cmd == crate::domain::ChassisCommand::STOP
    });
    assert!((2_590..2_610).contains(&ms.expect("gave up")), "{ms:?}");
}

/// The legs fold at 0.2 m/s. The robot lets go once its body has sunk onto its front edge.
#[test]
fn a_robot_that_is_no_longer_asked_to_stand_sits_down() {
    let mut robot = Robot::standing();
    let mut controller = robot.balancing();
    robot.command.stand = false;
    for _ in 0..200 {
        let output = robot.step(&mut controller);
        assert_eq!(output.balance.state, BalanceState::SitDown);
    }
    robot.thighs(SHORT_RAD, 0.0);
    for _ in 0..500 {
        let output = robot.step(&mut controller);
        assert_eq!(output.balance.state, BalanceState::SitDown);
    }
    robot.pitched(0.65);
    let output = robot.step(&mut controller);
    assert_eq!(output, robot.step(&mut DefaultController::default()));
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
            for (joint, way) in robot
                .sensors
                .motor
                .joints
                .iter_mut()
                .zip([1.0, -1.0, 1.0, -1.0])
            {
                joint.pos_rad += 0.05 * sign * way;
            }
        }));
        assert!(left * sign > 0.2 && right * sign > 0.2, "{left} {right}");
    }
}

/// Both hips of a leg that is ahead of the other get torque backward, those of the other forward.
#[test]
fn legs_that_are_apart_are_brought_together() {
    for sign in [1.0, -1.0] {
        let [left_front, left_rear, right_front, right_rear] = hips_after(|robot| {
            for (joint, way) in robot
                .sensors
                .motor
                .joints
                .iter_mut()
                .zip([1.0, 1.0, -1.0, -1.0])
            {
                joint.pos_rad += 0.05 * sign * way;
            }
        });
        let (left, right) = (left_front + left_rear, right_front + right_rear);
        assert!(left * sign < -0.1 && right * sign > 0.1, "{left} {right}");
    }
}

#[test]
fn a_robot_without_weight_on_its_legs_is_airborne_within_20_ms() {
    let mut robot = Robot::standing();
    // Hips that carry: 0.077 N·m for each newton of the leg.
    let carried = |robot: &mut Robot, nm: f32| {
        let torques = [-nm, nm, -nm, nm];
        for (joint, nm) in robot.sensors.motor.joints.iter_mut().zip(torques) {
            joint.torque_nm = nm;
        }
    };
    carried(&mut robot, 1.9);
    let mut controller = robot.balancing();
    for _ in 0..200 {
        assert!(!robot.step(&mut controller).balance.airborne);
    }
    carried(&mut robot, 0.0);
    robot.sensors.imu.accel_mps2 = [0.0; 3];
    let ticks = (0..50).position(|_| robot.step(&mut controller).balance.airborne);
    assert!(ticks.expect("airborne") < 20, "{ticks:?}");
    carried(&mut robot, 4.0);
    robot.sensors.imu.accel_mps2 = [0.0, 0.0, 20.0];
    let ticks = (0..50).position(|_| !robot.step(&mut controller).balance.airborne);
    assert!(ticks.expect("landed") < 20, "{ticks:?}");
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
