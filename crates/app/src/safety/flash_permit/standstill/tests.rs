use super::*;

const MOTORS: MotorBuses = MotorBuses {
    wheels: BusId::Can1,
    joints: [BusId::Can2; 4],
};
/// Bus of the wheels, bus of the joints.
const BUSES: [usize; 2] = [0, 1];

/// A robot whose motors report and are at rest.
struct Bench {
    watch: StandstillMonitor,
    now_us: u64,
    motor: MotorFeedback,
    can: [BusHealth; 2],
}

impl Bench {
    fn new() -> Self {
        let mut motor = MotorFeedback::default();
        for wheel in &mut motor.wheels {
            (wheel.age_us, wheel.ts_us) = (1_000, 999_000);
        }
        for joint in &mut motor.joints {
            (joint.age_us, joint.ts_us) = (2_000, 998_000);
            joint.state = JointState::Disabled;
        }
        Self {
            watch: StandstillMonitor::from(1_000_000),
            now_us: 1_000_000,
            motor,
            can: Default::default(),
        }
    }

    fn is_at_standstill(&mut self) -> bool {
        self.now_us += 1_000;
        let Self {
            watch,
            now_us,
            motor,
            can,
        } = self;
        watch.is_at_standstill(motor, &MOTORS, can, *now_us)
    }

    /// Milliseconds until rest has lasted long enough, or `None` if that takes more than three seconds.
    fn ms_to_standstill(&mut self) -> Option<u32> {
        (1..=3_000).find(|_| self.is_at_standstill())
    }
}

#[test]
fn standstill_must_last_half_a_second() {
    assert_eq!(Bench::new().ms_to_standstill(), Some(500));
}

#[test]
fn a_reporting_wheel_must_be_at_rest_without_current() {
    for (rpm, current_ma, age_us, rests) in [
        (60, 0.0, 1_000, true),
        (-60, -500.0, 999_999, true),
        (61, 0.0, 1_000, false),
        (-61, 0.0, 1_000, false),
        (i16::MIN, 0.0, 1_000, false),
        // Older than any time limit among the settings.
        (3_000, 0.0, 999_999, false),
        (0, 501.0, 1_000, false),
        (0, -501.0, 1_000, false),
        (0, f32::NAN, 1_000, false),
    ] {
        for side in 0..2 {
            let mut bench = Bench::new();
            let wheel = &mut bench.motor.wheels[side];
            (wheel.rpm, wheel.current_ma, wheel.age_us) = (rpm, current_ma, age_us);
            let expected = rests.then_some(500);
            assert_eq!(
                bench.ms_to_standstill(),
                expected,
                "{rpm} rpm, {current_ma} mA, {age_us} us"
            );
        }
    }
}

#[test]
fn a_reporting_joint_must_report_disabled() {
    for (state, reports_enabled, rests) in [
        (JointState::Disabled, false, true),
        (JointState::SettingUp, false, true),
        (JointState::Fault, false, true),
        (JointState::Disabled, true, false),
        (JointState::SettingUp, true, false),
        (JointState::Fault, true, false),
        (JointState::Silent, false, false),
        (JointState::Enabling, false, false),
        (JointState::Enabled, false, false),
        (JointState::Enabled, true, false),
    ] {
        for place in 0..4 {
            let mut bench = Bench::new();
            let joint = &mut bench.motor.joints[place];
            (joint.state, joint.reports_enabled) = (state, reports_enabled);
            let expected = rests.then_some(500);
            assert_eq!(
                bench.ms_to_standstill(),
                expected,
                "{state:?} {reports_enabled}"
            );
        }
    }
}

/// Makes a wheel fall silent while it may be running.
fn silence_wheel(bench: &mut Bench) {
    let wheel = &mut bench.motor.wheels[1];
    (wheel.rpm, wheel.current_ma, wheel.age_us) = (3_000, 5_000.0, 1_000_000);
}

fn silence_joint(bench: &mut Bench) {
    let joint = &mut bench.motor.joints[2];
    (joint.state, joint.reports_enabled, joint.age_us) = (JointState::Silent, true, 1_000_000);
}

#[test]
fn a_silent_motor_counts_as_off_after_a_second_of_disable_frames() {
    let no_ack: fn(&mut BusHealth) = |bus| bus.state = BusErrorState::Passive;
    let bus_off: fn(&mut BusHealth) = |bus| bus.state = BusErrorState::BusOff;
    let stuck: fn(&mut BusHealth) = |bus| bus.tx_failures_in_row = 1;
    for (silence, bus) in [
        (silence_wheel as fn(&mut Bench), BUSES[0]),
        (silence_joint, BUSES[1]),
    ] {
        let mut bench = Bench::new();
        silence(&mut bench);
        assert_eq!(bench.ms_to_standstill(), Some(1_499));
        for harm in [no_ack, bus_off, stuck] {
            let mut bench = Bench::new();
            silence(&mut bench);
            harm(&mut bench.can[bus]);
            assert_eq!(bench.ms_to_standstill(), None);
            bench.can[bus] = BusHealth::default();
            assert_eq!(bench.ms_to_standstill(), Some(1_499));
            // The other bus does not matter.
            let mut bench = Bench::new();
            silence(&mut bench);
            harm(&mut bench.can[1 - bus]);
            assert_eq!(bench.ms_to_standstill(), Some(1_499));
        }
    }
}

#[test]
fn motors_that_never_reported_count_as_at_rest() {
    let mut bench = Bench::new();
    bench.motor = MotorFeedback::default();
    for bus in &mut bench.can {
        bus.state = BusErrorState::BusOff;
    }
    assert_eq!(bench.ms_to_standstill(), Some(500));
}
