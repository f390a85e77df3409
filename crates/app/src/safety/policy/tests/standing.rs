//! Standing up, standing and sitting down.

use super::*;
use crate::domain::StandPermit;

/// Twice the arc tangent of 0.6 is 1.08 rad; the limit is 0.9 rad.
const LYING: [f32; 4] = [0.8575, 0.5145, 0.0, 0.0];
/// The sine of half of 0.75 rad is 0.3663; the limit for balancing is 0.7 rad.
const LEANING: [f32; 4] = [0.9305, 0.0, 0.3663, 0.0];
const UPRIGHT: [f32; 4] = [1.0, 0.0, 0.0, 0.0];

impl Bench {
    fn lying() -> Self {
        let mut bench = Self::new();
        bench.estimate.q_wxyz = LYING;
        bench.run(100);
        bench
    }

    /// Moves the stand switch, at first through its middle position.
    fn stand_switch(&mut self, switch: StandSwitch) -> SafetyStatus {
        self.operator.stand = StandSwitch::Unknown;
        self.run(1);
        self.operator.stand = switch;
        self.run(1)
    }

    fn request(&mut self) -> SafetyStatus {
        self.stand_switch(StandSwitch::Down);
        self.stand_switch(StandSwitch::Up)
    }

    /// An armed robot that stands up from lying.
    fn standing_up() -> Self {
        let mut bench = Self::lying();
        bench.request();
        bench.armed = true;
        bench.balance = BalanceState::StandUp;
        bench.run(1);
        bench
    }

    fn standing() -> Self {
        let mut bench = Self::standing_up();
        bench.estimate.q_wxyz = UPRIGHT;
        bench.balance = BalanceState::Balance;
        bench.run(1);
        bench
    }
}

#[test]
fn a_lying_robot_may_be_armed_only_on_request() {
    let mut bench = Bench::lying();
    let status = bench.stand_switch(StandSwitch::Up);
    assert_eq!(status.flags, SafetyFlags::TILT, "up at boot");
    assert_eq!(status.stand, StandPermit::SwitchMustGoDown);
    let status = bench.stand_switch(StandSwitch::Down);
    assert_eq!(
        (status.flags, status.stand),
        (SafetyFlags::TILT, StandPermit::Ready)
    );
    let status = bench.stand_switch(StandSwitch::Up);
    assert_eq!(status.stand, StandPermit::Requested);
    assert_eq!(
        (status.flags, status.latched),
        (SafetyFlags::NONE, SafetyFlags::NONE)
    );
    assert_eq!(status.verdict, SafetyVerdict::Run);
    for switch in [StandSwitch::Unknown, StandSwitch::Down] {
        let mut bench = Bench::lying();
        bench.request();
        bench.operator.stand = switch;
        assert_eq!(bench.tick().flags, SafetyFlags::TILT, "taken back");
    }
}

#[test]
fn a_robot_that_still_lies_after_its_time_has_failed() {
    let mut bench = Bench::standing_up();
    assert_eq!(bench.tick().stand, StandPermit::StandingUp);
    let status = bench.run(2_998);
    assert_eq!(
        (status.flags, status.stand_up_ms),
        (SafetyFlags::NONE, 2_999)
    );
    let failed = SafetyFlags::TILT.union(SafetyFlags::STAND_UP_FAILED);
    let status = bench.run(1);
    assert_eq!((status.flags, status.latched), (failed, failed));
    assert_eq!(status.verdict, SafetyVerdict::GlobalStop);
    bench.armed = false;
    bench.balance = BalanceState::Sit;
    assert_eq!(bench.request().flags, failed, "a person looks first");
    bench.operator.stand = StandSwitch::Down;
    bench.gesture(true);
    bench.run(1_001);
    bench.gesture(false);
    assert_eq!(bench.request().flags, SafetyFlags::NONE);
}

#[test]
fn a_robot_that_cannot_stand_up_from_how_it_lies_has_failed_at_once() {
    let mut bench = Bench::standing_up();
    bench.balance = BalanceState::CannotRise;
    let failed = SafetyFlags::TILT.union(SafetyFlags::STAND_UP_FAILED);
    let status = bench.tick();
    assert_eq!((status.flags, status.latched), (failed, failed));
    assert_eq!(status.verdict, SafetyVerdict::GlobalStop);
    assert_eq!(status.stand, StandPermit::SwitchMustGoDown);
}

/// The legs may be jammed, but the robot is upright and only sits down.
#[test]
fn a_robot_that_is_upright_after_its_time_sits_down() {
    let mut bench = Bench::standing_up();
    bench.estimate.q_wxyz = UPRIGHT;
    let status = bench.run(3_000);
    assert_eq!(status.flags, SafetyFlags::NONE);
    assert_eq!(status.stand, StandPermit::SwitchMustGoDown);
}

#[test]
fn a_standing_robot_may_fall_no_more() {
    let mut bench = Bench::standing();
    assert_eq!(bench.run(10_000).stand, StandPermit::Standing);
    for balance in [
        BalanceState::Jump,
        BalanceState::Balance,
        BalanceState::SitDown,
    ] {
        let mut bench = Bench::standing();
        bench.balance = balance;
        bench.run(10);
        bench.estimate.q_wxyz = LEANING;
        assert_eq!(bench.ms_until(SafetyFlags::BALANCE_LOST), Some(20));
        let status = bench.tick();
        assert_eq!(status.latched, SafetyFlags::BALANCE_LOST);
        assert!(status.global_stop && !status.stand.permits());
    }
    let mut bench = Bench::standing();
    bench.estimate.q_wxyz = LEANING;
    bench.run(19);
    bench.estimate.q_wxyz = UPRIGHT;
    assert_eq!(bench.run(1).flags, SafetyFlags::NONE, "caught");
    bench.balance = BalanceState::Fallen;
    assert_eq!(bench.run(1).flags, SafetyFlags::BALANCE_LOST);
}

/// A robot that sits has the limit of before.
#[test]
fn the_limit_for_balancing_is_for_balancing_only() {
    let mut bench = Bench::new();
    bench.armed = true;
    bench.estimate.q_wxyz = LEANING;
    assert_eq!(bench.run(1_000).flags, SafetyFlags::NONE);
}

#[test]
fn every_stop_ends_standing_at_once() {
    type Cause = fn(&mut Bench);
    let causes: [Cause; 9] = [
        |bench| bench.operator.e_stop = true,
        |bench| bench.remote.age_us = 100_001,
        |bench| bench.remote.failsafe = true,
        |bench| bench.remote.quality = 0.2,
        |bench| bench.estimate.valid = false,
        |bench| bench.imu_age_us = 25_001,
        |bench| bench.health.imu.errors = 100,
        |bench| bench.health.late_tasks.imu = true,
        |bench| bench.armed = false,
    ];
    for (number, cause) in causes.into_iter().enumerate() {
        for make in [
            Bench::lying as fn() -> Bench,
            Bench::standing_up,
            Bench::standing,
        ] {
            let mut bench = make();
            bench.request();
            bench.armed = bench.balance != BalanceState::Sit;
            bench.run(1);
            let undo = (bench.operator, bench.remote, bench.estimate, bench.health);
            let imu_age_us = bench.imu_age_us;
            cause(&mut bench);
            let status = bench.run(1);
            let disarmed_only = number == 8;
            assert!(status.global_stop || disarmed_only, "{number}");
            assert!(!status.stand.permits(), "{number}");
            if disarmed_only && bench.balance == BalanceState::Sit {
                continue;
            }
            (bench.operator, bench.remote, bench.estimate, bench.health) = undo;
            (bench.imu_age_us, bench.armed) = (imu_age_us, true);
            let after = bench.run(1_000);
            assert_eq!(after.stand, StandPermit::SwitchMustGoDown, "{number}");
        }
    }
}

#[test]
fn while_the_robot_stands_a_stop_of_a_part_stops_everything() {
    type Cause = fn(&mut Bench);
    let causes: [Cause; 10] = [
        |bench| bench.motor.wheels[0].age_us = 50_001,
        |bench| bench.motor.wheels[1].age_us = 50_001,
        |bench| bench.motor.wheels[1].frozen = true,
        |bench| bench.motor.joints[3].frozen = true,
        |bench| bench.motor.joints[0].state = JointState::Fault,
        |bench| bench.motor.joints[1].age_us = 50_001,
        |bench| bench.health.can[0].state = BusErrorState::BusOff,
        |bench| bench.health.can[1].state = BusErrorState::BusOff,
        |bench| bench.health.can[0].tx_failures_in_row = 21,
        |bench| bench.health.can[1].tx_failures_in_row = 21,
    ];
    let sitting_down = || {
        let mut bench = Bench::standing();
        bench.operator.stand = StandSwitch::Down;
        bench.balance = BalanceState::SitDown;
        bench.run(1);
        bench
    };
    for (number, cause) in causes.into_iter().enumerate() {
        for make in [Bench::standing_up, Bench::standing, sitting_down] {
            let mut bench = make();
            cause(&mut bench);
            let status = bench.run(1);
            assert!(status.global_stop, "{number}");
            assert!(
                status.latched.contains(SafetyFlags::BALANCE_LOST),
                "{number}"
            );
        }
        let mut sitting = Bench::new();
        sitting.armed = true;
        cause(&mut sitting);
        assert!(!sitting.run(1).global_stop, "{number}");
    }
}

#[test]
fn the_robot_sits_down_without_a_stop_and_stands_up_again() {
    let mut bench = Bench::standing();
    bench.operator.stand = StandSwitch::Down;
    bench.run(1);
    for balance in [BalanceState::SitDown, BalanceState::Sit] {
        bench.balance = balance;
        let status = bench.run(10);
        assert_eq!(
            (status.flags, status.stand),
            (SafetyFlags::NONE, StandPermit::Ready)
        );
    }
    bench.request();
    assert_eq!(bench.run(1).stand, StandPermit::StandingUp);
    // The controller itself may end it, too.
    let mut bench = Bench::standing();
    bench.balance = BalanceState::SitDown;
    bench.run(1);
    bench.balance = BalanceState::Sit;
    let status = bench.run(1);
    assert_eq!(status.flags, SafetyFlags::NONE);
    assert_eq!(status.stand, StandPermit::SwitchMustGoDown);
}

#[test]
fn a_standing_robot_that_nobody_controls_is_stopped() {
    let mut bench = Bench::standing();
    bench.balance = BalanceState::Sit;
    assert_eq!(bench.run(1).flags, SafetyFlags::BALANCE_LOST);
}

#[test]
fn frames_from_before_a_change_of_settings_do_not_move_the_stand_switch() {
    let mut bench = Bench::lying();
    bench.request();
    bench.policy.settings_changed(bench.now_us);
    bench.operator.ts_us = bench.now_us + 4_999;
    bench.request();
    assert_eq!(bench.run(10).flags, SafetyFlags::TILT);
    bench.operator.ts_us = bench.now_us + 5_000;
    assert_eq!(bench.request().flags, SafetyFlags::NONE);
}
