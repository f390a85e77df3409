use super::*;

struct Bench {
    permit: FlashPermit,
    now_us: u64,
    request: FlashRequest,
    watchdog: WatchdogPeriod,
    arming: ArmingState,
    enabled: bool,
    motor: MotorFeedback,
}

impl Bench {
    /// A second after boot, no motor heard yet.
    fn new(request: FlashRequest) -> Self {
        Self {
            permit: FlashPermit::default(),
            now_us: 1_000_000,
            request,
            watchdog: WatchdogPeriod::Short,
            arming: ArmingState::Disarmed,
            enabled: false,
            motor: MotorFeedback::default(),
        }
    }

    fn tick(&mut self) -> FlashGrant {
        self.now_us += 1_000;
        let inputs = FlashPermitInputs {
            request: self.request,
            watchdog: self.watchdog,
            arming: self.arming,
            enabled: self.enabled,
            motor: &self.motor,
            wheel_timeout_us: 50_000,
        };
        self.permit.step(&inputs, self.now_us)
    }

    fn granted(&mut self) -> FlashRequest {
        self.tick().granted
    }
}

#[test]
fn a_robot_at_rest_may_write_at_once_and_arming_waits() {
    let mut bench = Bench::new(FlashRequest::Program);
    let expected = FlashGrant {
        granted: FlashRequest::Program,
        needs_long_watchdog: false,
        blocks_arming: true,
    };
    assert_eq!(bench.tick(), expected);
    bench.request = FlashRequest::None;
    assert_eq!(bench.tick(), FlashGrant::default());
}

#[test]
fn an_erase_waits_for_the_long_watchdog_and_arming_until_it_is_short_again() {
    let mut bench = Bench::new(FlashRequest::Erase);
    for period in [WatchdogPeriod::Short, WatchdogPeriod::Changing] {
        bench.watchdog = period;
        let expected = FlashGrant {
            granted: FlashRequest::None,
            needs_long_watchdog: true,
            blocks_arming: true,
        };
        assert_eq!(bench.tick(), expected);
    }
    bench.watchdog = WatchdogPeriod::Long;
    assert_eq!(bench.granted(), FlashRequest::Erase);
    bench.request = FlashRequest::None;
    for period in [WatchdogPeriod::Long, WatchdogPeriod::Changing] {
        bench.watchdog = period;
        let grant = bench.tick();
        assert!(grant.blocks_arming && !grant.needs_long_watchdog);
        assert_eq!(grant.granted, FlashRequest::None);
    }
    bench.watchdog = WatchdogPeriod::Short;
    assert_eq!(bench.tick(), FlashGrant::default());
}

#[test]
fn armed_until_half_a_second_ago_is_too_early() {
    let mut bench = Bench::new(FlashRequest::Program);
    bench.arming = ArmingState::Armed;
    assert_eq!(bench.tick(), FlashGrant::default());
    bench.arming = ArmingState::Disarmed;
    for _ in 0..499 {
        assert_eq!(bench.granted(), FlashRequest::None);
    }
    assert_eq!(bench.granted(), FlashRequest::Program);
}

#[test]
fn just_after_boot_is_too_early() {
    let mut bench = Bench::new(FlashRequest::Program);
    bench.now_us = 498_000;
    assert_eq!(bench.granted(), FlashRequest::None);
    assert_eq!(bench.granted(), FlashRequest::Program);
}

#[test]
fn a_pilot_who_is_about_to_arm_comes_first() {
    for request in [FlashRequest::Program, FlashRequest::Erase] {
        let mut bench = Bench::new(request);
        bench.watchdog = WatchdogPeriod::Long;
        bench.enabled = true;
        let grant = bench.tick();
        assert_eq!(grant.granted, FlashRequest::None);
        assert!(!grant.needs_long_watchdog);
        // The watchdog is long still; a robot is never armed with that.
        assert!(grant.blocks_arming);
        bench.watchdog = WatchdogPeriod::Short;
        assert!(!bench.tick().blocks_arming);
    }
}

/// The work may have begun: what was granted stays granted, and arming stays blocked.
#[test]
fn a_grant_outlasts_its_reasons_until_the_request_is_taken_back() {
    let mut bench = Bench::new(FlashRequest::Program);
    bench.tick();
    bench.enabled = true;
    bench.motor.wheels[0].age_us = 0;
    bench.motor.wheels[0].rpm = 500;
    let grant = bench.tick();
    assert_eq!(grant.granted, FlashRequest::Program);
    assert!(grant.blocks_arming);
    // Another request is another question.
    bench.request = FlashRequest::Erase;
    assert_eq!(bench.tick(), FlashGrant::default());
}

#[test]
fn a_wheel_that_turns_or_is_driven_forbids_it_as_long_as_it_reports() {
    for (rpm, current_ma, age_us, allowed) in [
        (60, 0.0, 1_000, true),
        (-60, -500.0, 50_000, true),
        (61, 0.0, 1_000, false),
        (-61, 0.0, 1_000, false),
        (i16::MIN, 0.0, 1_000, false),
        (0, 501.0, 1_000, false),
        (0, -501.0, 1_000, false),
        (0, f32::NAN, 1_000, false),
        (3_000, 5_000.0, 50_001, true),
    ] {
        for side in 0..2 {
            let mut bench = Bench::new(FlashRequest::Program);
            let wheel = &mut bench.motor.wheels[side];
            (wheel.rpm, wheel.current_ma, wheel.age_us) = (rpm, current_ma, age_us);
            let granted = bench.granted() == FlashRequest::Program;
            assert_eq!(granted, allowed, "{rpm} rpm, {current_ma} mA, {age_us} µs");
        }
    }
}

#[test]
fn a_joint_must_be_off_or_long_silent() {
    for (state, age_us, allowed) in [
        (JointState::Silent, u32::MAX, true),
        (JointState::Silent, 1_000_000, true),
        (JointState::Silent, 999_999, false),
        (JointState::SettingUp, 2_000, true),
        (JointState::Disabled, 2_000, true),
        (JointState::Fault, 2_000, true),
        (JointState::Enabling, 2_000, false),
        (JointState::Enabled, 2_000, false),
    ] {
        for place in 0..4 {
            let mut bench = Bench::new(FlashRequest::Program);
            let joint = &mut bench.motor.joints[place];
            (joint.state, joint.age_us) = (state, age_us);
            let granted = bench.granted() == FlashRequest::Program;
            assert_eq!(granted, allowed, "{state:?}, {age_us} µs");
        }
    }
}
