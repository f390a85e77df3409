use super::*;
use crate::domain::BusId;

const BUSES: MotorBuses = MotorBuses {
    wheels: BusId::Can1,
    joints: [BusId::Can2; 4],
};

struct Bench {
    permit: FlashPermit,
    now_us: u64,
    request: FlashRequest,
    watchdog: WatchdogPeriod,
    arming: ArmingState,
    enabled: bool,
    tests_motors: bool,
    motor: MotorFeedback,
    can: [BusHealth; 2],
}

impl Bench {
    /// One second after boot, without any report of a motor.
    fn new(request: FlashRequest) -> Self {
        Self {
            permit: FlashPermit::default(),
            now_us: 1_000_000,
            request,
            watchdog: WatchdogPeriod::Short,
            arming: ArmingState::Disarmed,
            enabled: false,
            tests_motors: false,
            motor: MotorFeedback::default(),
            can: Default::default(),
        }
    }

    fn tick(&mut self) -> FlashGrant {
        self.now_us += 1_000;
        let inputs = FlashPermitInputs {
            request: self.request,
            watchdog: self.watchdog,
            arming: self.arming,
            enabled: self.enabled,
            tests_motors: self.tests_motors,
            motor: &self.motor,
            buses: &BUSES,
            can: &self.can,
        };
        self.permit.step(&inputs, self.now_us);
        self.permit.grant()
    }

    fn granted(&mut self) -> FlashRequest {
        self.tick().granted
    }

    fn turn(&mut self) {
        let wheel = &mut self.motor.wheels[0];
        (wheel.rpm, wheel.age_us, wheel.ts_us) = (500, 0, self.now_us);
    }

    /// Number of ticks until the request is granted, or `None` if that takes more than three seconds.
    fn ticks_to_grant(&mut self) -> Option<u32> {
        (1..=3_000).find(|_| self.granted() != FlashRequest::None)
    }
}

#[test]
fn a_robot_at_rest_gets_its_write_at_once_and_arming_waits() {
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
fn an_erase_waits_for_the_long_watchdog_and_arming_for_the_short_one() {
    let mut bench = Bench::new(FlashRequest::Erase);
    for _ in 0..500 {
        assert_eq!(bench.tick(), FlashGrant::default());
    }
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
fn nothing_is_granted_until_half_a_second_after_disarming() {
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
fn nothing_is_granted_just_after_boot() {
    let mut bench = Bench::new(FlashRequest::Program);
    bench.now_us = 498_000;
    assert_eq!(bench.granted(), FlashRequest::None);
    assert_eq!(bench.granted(), FlashRequest::Program);
}

#[test]
fn the_enable_switch_has_priority_over_requests() {
    for request in [FlashRequest::Program, FlashRequest::Erase] {
        let mut bench = Bench::new(request);
        bench.watchdog = WatchdogPeriod::Long;
        bench.enabled = true;
        let grant = bench.tick();
        assert_eq!(grant.granted, FlashRequest::None);
        assert!(!grant.needs_long_watchdog);
        // The watchdog still has its long period, with which a robot is never armed.
        assert!(grant.blocks_arming);
        bench.watchdog = WatchdogPeriod::Short;
        assert!(!bench.tick().blocks_arming);
    }
}

/// The work may have begun, so the grant stays and arming remains blocked.
#[test]
fn a_grant_stays_until_the_request_is_withdrawn() {
    let mut bench = Bench::new(FlashRequest::Program);
    bench.tick();
    bench.enabled = true;
    bench.turn();
    let grant = bench.tick();
    assert_eq!(grant.granted, FlashRequest::Program);
    assert!(grant.blocks_arming);
    // Another request needs a new decision.
    bench.request = FlashRequest::Erase;
    assert_eq!(bench.tick(), FlashGrant::default());
}

#[test]
fn words_may_be_programmed_while_a_wheel_coasts_down() {
    let mut bench = Bench::new(FlashRequest::Program);
    bench.turn();
    assert_eq!(bench.granted(), FlashRequest::Program);
}

#[test]
fn motor_tests_block_programming_and_erasing() {
    for (request, ticks) in [(FlashRequest::Program, 1), (FlashRequest::Erase, 501)] {
        let mut bench = Bench::new(request);
        bench.watchdog = WatchdogPeriod::Long;
        bench.tests_motors = true;
        assert_eq!(bench.ticks_to_grant(), None);
        bench.tests_motors = false;
        assert_eq!(bench.ticks_to_grant(), Some(ticks));
    }
}

#[test]
fn an_erase_needs_half_a_second_of_uninterrupted_rest() {
    let mut bench = Bench::new(FlashRequest::Erase);
    bench.watchdog = WatchdogPeriod::Long;
    bench.turn();
    assert_eq!(bench.ticks_to_grant(), None);
    // The wheel swings through zero and comes to rest.
    bench.motor.wheels[0].rpm = 0;
    for _ in 0..499 {
        assert_eq!(bench.granted(), FlashRequest::None);
    }
    bench.motor.wheels[0].rpm = -61;
    assert_eq!(bench.granted(), FlashRequest::None);
    bench.motor.wheels[0].rpm = 0;
    assert_eq!(bench.ticks_to_grant(), Some(500));
}

fn instead_of_erase(on: bool, other: FlashRequest) -> FlashRequest {
    if on { other } else { FlashRequest::Erase }
}

#[test]
fn rest_counts_anew_after_enabling_or_another_request() {
    for disturb in [
        |bench: &mut Bench, on: bool| bench.enabled = on,
        |bench: &mut Bench, on: bool| bench.tests_motors = on,
        |bench: &mut Bench, on: bool| bench.request = instead_of_erase(on, FlashRequest::None),
        |bench: &mut Bench, on: bool| bench.request = instead_of_erase(on, FlashRequest::Program),
    ] {
        let mut bench = Bench::new(FlashRequest::Erase);
        bench.watchdog = WatchdogPeriod::Long;
        for _ in 0..400 {
            bench.tick();
        }
        disturb(&mut bench, true);
        assert_ne!(bench.granted(), FlashRequest::Erase);
        disturb(&mut bench, false);
        assert_eq!(bench.ticks_to_grant(), Some(501));
    }
}
