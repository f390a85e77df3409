use super::*;

const DRIVE: f32 = 0.4;

struct Bench {
    run: TrialRun,
    trial: Trial,
    motor: MotorFeedback,
    dead_man: DeadMan,
    drive: f32,
    now_us: u64,
}

impl Bench {
    fn new(number: u8, action: TrialAction) -> Self {
        let mut motor = MotorFeedback::default();
        for wheel in &mut motor.wheels {
            wheel.age_us = 1_000;
        }
        for joint in &mut motor.joints {
            joint.age_us = 1_000;
        }
        Self {
            run: TrialRun::default(),
            trial: Trial {
                motor: TestMotor::from_number(number).unwrap(),
                action,
            },
            motor,
            dead_man: DeadMan::Released,
            drive: DRIVE,
            now_us: 5_000_000,
        }
    }

    /// The stick was released for long enough and is held now.
    fn held(number: u8, action: TrialAction) -> Self {
        let mut bench = Self::new(number, action);
        bench.run_ms(201);
        assert_eq!(bench.run.state(), TrialState::Ready);
        bench.dead_man = DeadMan::Held;
        bench
    }

    fn tick(&mut self) -> ChassisCommand {
        self.now_us += 1_000;
        let odom = WheelOdomConfig {
            gear_ratio: 20.0,
            ..WheelOdomConfig::default()
        };
        let inputs = TrialInputs {
            dead_man: self.dead_man,
            drive: self.drive,
            motor: &self.motor,
            wheel_odom: &odom,
        };
        self.run.step(&self.trial, &inputs, self.now_us)
    }

    /// Runs until a tick commands nothing, at most `ticks`, and returns their number.
    fn run_ms(&mut self, ticks: u32) -> u32 {
        let mut active = 0;
        for _ in 0..ticks {
            active += u32::from(self.tick() != ChassisCommand::default());
        }
        active
    }
}

#[test]
fn the_stick_gives_torque_to_the_selected_joint_only() {
    let command = Bench::held(3, TrialAction::StickTorque).tick();
    let mut expected = ChassisCommand::default();
    expected.joints[1].mode = JointMode::Mit;
    expected.joints[1].tau_nm = 0.4 * 0.5;
    assert_eq!(command, expected);
}

#[test]
fn the_stick_gives_current_to_the_selected_wheel_only() {
    let command = Bench::held(1, TrialAction::StickTorque).tick();
    let mut expected = ChassisCommand::default();
    expected.wheels[1].current_ma = 0.4 * 1_000.0;
    assert_eq!(command, expected);
}

#[test]
fn half_a_newton_metre_and_one_ampere_are_never_exceeded() {
    for action in [TrialAction::StickTorque, TrialAction::FixedTorque(-9.0)] {
        let mut joint = Bench::held(2, action);
        joint.drive = 7.0;
        assert_eq!(joint.tick().joints[0].tau_nm.abs(), 0.5);
        let mut wheel = Bench::held(0, action);
        wheel.drive = -7.0;
        assert_eq!(wheel.tick().wheels[0].current_ma.abs(), 1_000.0);
    }
}

#[test]
fn a_release_or_an_old_frame_gives_zero_in_the_same_tick() {
    for end in [DeadMan::Released, DeadMan::Unknown] {
        let mut bench = Bench::held(2, TrialAction::FixedTorque(1.0));
        assert_ne!(bench.tick(), ChassisCommand::default());
        bench.dead_man = end;
        assert_eq!(bench.tick(), ChassisCommand::default());
        bench.dead_man = DeadMan::Held;
        assert_eq!(bench.run_ms(1_000), 0);
    }
}

#[test]
fn a_stick_held_from_the_start_gives_no_torque() {
    let mut bench = Bench::new(2, TrialAction::FixedTorque(1.0));
    bench.dead_man = DeadMan::Held;
    assert_eq!(bench.run_ms(1_000), 0);
    assert_eq!(bench.run.state(), TrialState::ReleaseFirst);
    // Lost frames do not count as a release.
    bench.dead_man = DeadMan::Unknown;
    bench.run_ms(1_000);
    bench.dead_man = DeadMan::Held;
    assert_eq!(bench.run_ms(1_000), 0);
    bench.dead_man = DeadMan::Released;
    bench.run_ms(201);
    bench.dead_man = DeadMan::Held;
    assert_eq!(bench.run_ms(10), 10);
}

#[test]
fn a_release_must_last_a_fifth_of_a_second() {
    for (ms, active) in [(199, 0), (202, 10)] {
        let mut bench = Bench::new(2, TrialAction::FixedTorque(1.0));
        bench.run_ms(ms);
        bench.dead_man = DeadMan::Held;
        assert_eq!(bench.run_ms(10), active, "{ms} ms");
    }
}

#[test]
fn torque_ends_after_three_seconds() {
    let mut bench = Bench::held(2, TrialAction::StickTorque);
    assert_eq!(bench.run_ms(10_000), 3_001);
    assert_eq!(bench.run.state(), TrialState::TooLong);
    bench.dead_man = DeadMan::Released;
    bench.run_ms(201);
    bench.dead_man = DeadMan::Held;
    assert_eq!(bench.run_ms(10), 10);
}

#[test]
fn a_joint_faster_than_three_radians_a_second_is_released() {
    for (vel_rps, free) in [
        (3.0, true),
        (-3.0, true),
        (3.01, false),
        (-3.01, false),
        (f32::NAN, false),
    ] {
        let mut bench = Bench::held(2, TrialAction::StickTorque);
        bench.tick();
        bench.motor.joints[0].vel_rps = vel_rps;
        assert_eq!(bench.tick() != ChassisCommand::default(), free, "{vel_rps}");
        bench.motor.joints[0].vel_rps = 0.0;
        assert_eq!(bench.run_ms(10), if free { 10 } else { 0 });
    }
}

/// 10 rad/s at the shaft of a 20:1 gear is 1909.9 rpm at the rotor.
#[test]
fn a_wheel_faster_than_ten_radians_a_second_is_released() {
    for (rpm, state) in [
        (1_909, TrialState::Active),
        (-1_909, TrialState::Active),
        (1_910, TrialState::TooFast),
        (-1_910, TrialState::TooFast),
    ] {
        let mut bench = Bench::held(0, TrialAction::StickTorque);
        bench.motor.wheels[0].rpm = rpm;
        bench.tick();
        assert_eq!(bench.run.state(), state, "{rpm}");
    }
}

#[test]
fn a_silent_motor_gets_no_torque() {
    let mut bench = Bench::held(4, TrialAction::StickTorque);
    bench.motor.joints[2].age_us = 50_000;
    assert_ne!(bench.tick(), ChassisCommand::default());
    bench.motor.joints[2].age_us = 50_001;
    assert_eq!(bench.tick(), ChassisCommand::default());
    assert_eq!(bench.run.state(), TrialState::Silent);
    let mut moving = Bench::held(1, TrialAction::StickTorque);
    moving.tick();
    moving.motor.wheels[1].age_us = 50_001;
    assert_eq!(moving.tick(), ChassisCommand::default());
}

/// The torque that the motor computes: kp·(p − q) − kd·v.
fn motor_torque_nm(command: &JointCommand, pos_rad: f32, vel_rps: f32) -> f32 {
    command.kp * (command.pos_rad - pos_rad)
        + command.kd * (command.vel_rps - vel_rps)
        + command.tau_nm
}

#[test]
fn a_held_joint_pulls_back_softly() {
    let mut bench = Bench::held(2, TrialAction::Hold);
    bench.motor.joints[0].pos_rad = 0.7;
    let held = bench.tick().joints[0];
    assert_eq!(motor_torque_nm(&held, 0.7, 0.0), 0.0);
    assert!(held.kp <= 5.0 && held.kd <= 0.5);
    // Pushed 0.05 rad forward, 5 N·m/rad pull back with 0.25 N·m.
    bench.motor.joints[0].pos_rad = 0.75;
    let torque_nm = motor_torque_nm(&bench.tick().joints[0], 0.75, 0.0);
    assert!((torque_nm + 0.25).abs() < 1e-3, "{torque_nm}");
    // At any distance it pulls with its limit, in either direction.
    for (pos_rad, expected_nm) in [(12.0, -0.45), (-12.0, 0.45)] {
        bench.motor.joints[0].pos_rad = pos_rad;
        let torque_nm = motor_torque_nm(&bench.tick().joints[0], pos_rad, 0.0);
        assert!((torque_nm - expected_nm).abs() < 1e-3, "{torque_nm}");
    }
}

#[test]
fn a_held_joint_stays_below_half_a_newton_metre() {
    for pos_rad in [-12.0, -0.3, 0.0, 0.3, 12.0] {
        for vel_rps in [-3.0, -1.0, 0.0, 1.0, 3.0] {
            let mut bench = Bench::held(2, TrialAction::Hold);
            bench.tick();
            let joint = &mut bench.motor.joints[0];
            (joint.pos_rad, joint.vel_rps) = (pos_rad, vel_rps);
            let command = bench.tick().joints[0];
            // The joint moves on until the next command, 2 ms later.
            for ms in 0..=2 {
                let moved_rad = pos_rad + vel_rps * 0.001 * ms as f32;
                let torque_nm = motor_torque_nm(&command, moved_rad, vel_rps);
                assert!(torque_nm.abs() <= 0.5, "{pos_rad} {vel_rps} {torque_nm}");
            }
        }
    }
}

/// Where a soft limit keeps the target from following the joint outwards, no stiffness compensates the damping.
#[test]
fn damping_alone_stays_below_half_a_newton_metre() {
    let mut bench = Bench::held(2, TrialAction::Hold);
    bench.motor.joints[0].vel_rps = 3.0;
    let held = bench.tick().joints[0];
    assert!(held.kd * 3.0 <= 0.5);
    assert_ne!(held.kd, 0.0);
}

/// 600 rpm at the rotor of a 20:1 gear is 3.1416 rad/s, times 200 mA.
#[test]
fn a_held_wheel_is_braked() {
    let mut bench = Bench::held(0, TrialAction::Hold);
    bench.motor.wheels[0].rpm = 600;
    let [wheel, _] = bench.tick().wheels;
    assert!(
        (wheel.current_ma + 628.3).abs() < 0.1,
        "{}",
        wheel.current_ma
    );
}

#[test]
fn a_clock_that_jumps_back_does_not_end_the_trial() {
    let mut bench = Bench::held(2, TrialAction::StickTorque);
    bench.tick();
    bench.now_us = 0;
    assert_eq!(bench.run_ms(10), 10);
}
