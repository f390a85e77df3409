use super::*;

struct Bench {
    bring_up: BringUp,
    remote: RemoteState,
    operator: OperatorState,
    remote_age_us: u32,
    arming: ArmingState,
    motor: MotorFeedback,
    now_us: u64,
}

impl Bench {
    /// Enable off, e-stop thrown, steering stick to the left, mode switch at manual.
    fn new() -> Self {
        let mut motor = MotorFeedback::default();
        motor.wheels.iter_mut().for_each(|wheel| wheel.age_us = 0);
        motor.joints.iter_mut().for_each(|joint| joint.age_us = 0);
        Self {
            bring_up: BringUp::default(),
            remote: RemoteState {
                wz: 1.0,
                ..RemoteState::default()
            },
            operator: OperatorState {
                disabled: true,
                e_stop: true,
                ..OperatorState::default()
            },
            remote_age_us: 5_000,
            arming: ArmingState::Disarmed,
            motor,
            now_us: 1_000_000,
        }
    }

    fn tick(&mut self) -> Option<ChassisCommand> {
        self.now_us += 1_000;
        let odom = WheelOdomConfig::default();
        let inputs = BringUpInputs {
            remote: &self.remote,
            operator: &self.operator,
            remote_age_us: self.remote_age_us,
            arming: self.arming,
            motor: &self.motor,
            wheel_odom: &odom,
        };
        self.bring_up.step(&inputs, self.now_us)
    }

    fn run_ms(&mut self, ticks: u32) -> Option<ChassisCommand> {
        let mut last = None;
        for _ in 0..ticks {
            last = self.tick();
        }
        last
    }

    fn mode(&mut self, mode: DriveMode) -> BringUpStatus {
        self.operator.mode = mode;
        self.run_ms(300);
        *self.bring_up.status()
    }

    fn gesture(&mut self) -> BringUpStep {
        use DriveMode::{Custom, Manual, Pc};
        for mode in [Manual, Pc, Custom, Pc, Manual, Pc, Custom] {
            self.mode(mode);
        }
        self.bring_up.status().step
    }

    /// The gesture was made, the stick is back and the e-stop off.
    fn started() -> Self {
        let mut bench = Self::new();
        assert_eq!(bench.gesture(), BringUpStep::ReadOnly);
        bench.remote.wz = 0.0;
        bench.operator.e_stop = false;
        bench
    }

    fn arm(&mut self) {
        (self.operator.enabled, self.operator.disabled) = (true, false);
        self.arming = ArmingState::Armed;
    }

    fn flick(&mut self, stick: f32) -> u8 {
        self.remote.select = stick;
        self.run_ms(50);
        self.remote.select = 0.0;
        self.run_ms(50);
        self.bring_up.status().motor
    }
}

#[test]
fn bring_up_is_off_until_requested() {
    let mut bench = Bench::new();
    assert_eq!(bench.run_ms(10_000), None);
    assert_eq!(*bench.bring_up.status(), BringUpStatus::default());
    assert!(!bench.bring_up.blocks_arming());
}

/// The first step blocks arming. The others test motors, which flash must not interrupt.
#[test]
fn each_step_either_blocks_arming_or_tests_motors() {
    let trial = Trial {
        motor: TestMotor::Wheel(0),
        action: TrialAction::StickTorque,
    };
    for (request, blocks_arming, tests_motors) in [
        (BringUpRequest::Off, false, false),
        (BringUpRequest::ReadOnly, true, false),
        (BringUpRequest::ZeroTorque, false, true),
        (BringUpRequest::OneMotor(trial), false, true),
    ] {
        let mut bring_up = BringUp::default();
        bring_up.request(request);
        assert_eq!(bring_up.blocks_arming(), blocks_arming, "{request:?}");
        assert_eq!(bring_up.tests_motors(), tests_motors, "{request:?}");
    }
}

#[test]
fn the_gesture_starts_the_read_only_step() {
    let mut bench = Bench::new();
    assert_eq!(bench.gesture(), BringUpStep::ReadOnly);
    assert!(bench.bring_up.blocks_arming() && bench.bring_up.status().by_radio);
    assert_eq!(bench.tick(), Some(ChassisCommand::default()));
}

#[test]
fn the_gesture_needs_every_control_in_place() {
    let spoilt: [fn(&mut Bench); 6] = [
        |bench| bench.operator.e_stop = false,
        |bench| bench.operator.disabled = false,
        |bench| bench.remote.wz = -1.0,
        |bench| bench.remote.wz = 0.9,
        |bench| bench.remote_age_us = 50_001,
        |bench| bench.arming = ArmingState::Armed,
    ];
    for spoil in spoilt {
        let mut bench = Bench::new();
        spoil(&mut bench);
        assert_eq!(bench.gesture(), BringUpStep::Off);
    }
}

/// The gesture ends with the mode switch at custom, which later selects the third step.
#[test]
fn after_the_gesture_the_switch_must_return_to_manual() {
    let mut bench = Bench::started();
    assert_eq!(bench.mode(DriveMode::Pc).step, BringUpStep::ReadOnly);
    assert_eq!(bench.mode(DriveMode::Manual).step, BringUpStep::ReadOnly);
    assert_eq!(bench.mode(DriveMode::Pc).step, BringUpStep::ZeroTorque);
    assert!(!bench.bring_up.blocks_arming());
    assert_eq!(bench.mode(DriveMode::Custom).step, BringUpStep::OneMotor);
    assert_eq!(bench.mode(DriveMode::Manual).step, BringUpStep::ReadOnly);
}

#[test]
fn step_and_motor_do_not_change_while_armed() {
    let mut bench = Bench::started();
    bench.mode(DriveMode::Manual);
    bench.mode(DriveMode::Custom);
    bench.arm();
    assert_eq!(bench.mode(DriveMode::Pc).step, BringUpStep::OneMotor);
    assert_eq!(bench.flick(1.0), 0);
}

#[test]
fn flicks_of_the_left_stick_select_the_motor() {
    let mut bench = Bench::started();
    bench.mode(DriveMode::Manual);
    assert_eq!(bench.flick(1.0), 1);
    assert_eq!(bench.flick(1.0), 2);
    assert_eq!(bench.flick(-1.0), 1);
    assert_eq!(bench.flick(0.6), 1);
    assert_eq!([bench.flick(-1.0), bench.flick(-1.0)], [0, 5]);
}

/// Joint 3 is motor 5. A stick half forward gives half of 0.5 N·m.
#[test]
fn one_motor_has_torque_while_the_dead_man_stick_is_held() {
    let mut bench = Bench::started();
    bench.mode(DriveMode::Manual);
    bench.flick(-1.0);
    bench.mode(DriveMode::Custom);
    bench.arm();
    bench.remote.vx = 0.5;
    assert_eq!(bench.run_ms(300), Some(ChassisCommand::default()));
    bench.operator.dead_man = true;
    let command = bench.tick().unwrap();
    assert_eq!(command.joints[3].tau_nm, 0.25);
    assert_eq!(bench.bring_up.status().trial, TrialState::Active);
    bench.remote_age_us = 50_001;
    assert_eq!(bench.tick(), Some(ChassisCommand::default()));
}

#[test]
fn a_dead_man_stick_held_while_arming_gives_no_torque() {
    let mut bench = Bench::started();
    bench.mode(DriveMode::Manual);
    bench.mode(DriveMode::Custom);
    bench.remote.vx = 0.5;
    bench.operator.dead_man = true;
    bench.arm();
    assert_eq!(bench.run_ms(1_000), Some(ChassisCommand::default()));
}

#[test]
fn a_lost_radio_is_not_a_release() {
    let mut bench = Bench::started();
    bench.mode(DriveMode::Manual);
    bench.mode(DriveMode::Custom);
    bench.remote.vx = 0.5;
    bench.operator.dead_man = true;
    bench.arm();
    bench.operator.dead_man = false;
    bench.remote_age_us = 50_001;
    bench.run_ms(1_000);
    bench.operator.dead_man = true;
    bench.remote_age_us = 5_000;
    assert_eq!(bench.run_ms(1_000), Some(ChassisCommand::default()));
}

#[test]
fn disarming_locks_the_trial() {
    let mut bench = Bench::started();
    bench.mode(DriveMode::Manual);
    bench.mode(DriveMode::Custom);
    bench.remote.vx = 0.5;
    bench.arm();
    bench.run_ms(300);
    bench.operator.dead_man = true;
    assert_ne!(bench.tick(), Some(ChassisCommand::default()));
    bench.arming = ArmingState::Disarmed;
    assert_eq!(bench.tick(), Some(ChassisCommand::default()));
    bench.arming = ArmingState::Armed;
    assert_eq!(bench.run_ms(1_000), Some(ChassisCommand::default()));
}

#[test]
fn the_tuning_channel_selects_step_motor_and_torque() {
    let mut bench = Bench::new();
    let trial = Trial {
        motor: TestMotor::Joint(2),
        action: TrialAction::FixedTorque(-0.5),
    };
    bench.bring_up.request(BringUpRequest::OneMotor(trial));
    // The mode switch at manual has no effect here.
    bench.run_ms(300);
    assert_eq!(bench.bring_up.status().motor, 4);
    bench.arm();
    bench.run_ms(300);
    bench.operator.dead_man = true;
    assert_eq!(bench.tick().unwrap().joints[2].tau_nm, -0.25);
    bench.bring_up.request(BringUpRequest::Off);
    assert_eq!(bench.tick(), None);
}
