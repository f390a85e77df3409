use super::*;
use crate::domain::{
    BalanceState, HighLevelCommand, JointControllerConfig, JointState, OperatorState,
    SensorsSnapshot, StandPermit, StateEstimate, WheelControllerConfig, WheelOdomConfig, robots,
};

mod torques;

/// Angles of the front thighs, in rad, on which the legs are nearly at their shortest and at their longest.
const SHORT_RAD: f32 = 0.2;
const LONG_RAD: f32 = -1.25;

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

    /// All joints at this angle of the front ones, mirrored at the rear, with this speed.
    fn thighs(&mut self, angle_rad: f32, speed_rps: f32) {
        let joints = &mut self.sensors.motor.joints;
        for (joint, sign) in joints.iter_mut().zip([1.0, -1.0, 1.0, -1.0]) {
            joint.pos_rad = sign * angle_rad;
            joint.vel_rps = sign * speed_rps;
        }
    }

    /// Hips that carry: 0.077 N·m for each newton of the leg.
    fn carries(&mut self, nm: f32) {
        let joints = &mut self.sensors.motor.joints;
        for (joint, sign) in joints.iter_mut().zip([-1.0, 1.0, -1.0, 1.0]) {
            joint.torque_nm = sign * nm;
        }
    }

    /// State of the robot when the jump button is pressed.
    fn jumps_when_pressed(&mut self, controller: &mut StandardController) -> BalanceState {
        self.command.jump = false;
        self.step(controller);
        self.command.jump = true;
        self.step(controller).balance.state
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

#[test]
fn a_robot_without_weight_on_its_legs_is_airborne_within_20_ms() {
    let mut robot = Robot::standing();
    robot.carries(1.9);
    let mut controller = robot.balancing();
    for _ in 0..200 {
        assert!(!robot.step(&mut controller).balance.airborne);
    }
    robot.carries(0.0);
    robot.sensors.imu.accel_mps2 = [0.0; 3];
    let ticks = (0..50).position(|_| robot.step(&mut controller).balance.airborne);
    assert!(ticks.expect("airborne") < 20, "{ticks:?}");
    robot.carries(4.0);
    robot.sensors.imu.accel_mps2 = [0.0, 0.0, 20.0];
    let ticks = (0..50).position(|_| !robot.step(&mut controller).balance.airborne);
    assert!(ticks.expect("landed") < 20, "{ticks:?}");
}
