use proptest::prelude::*;

use super::*;

const TIME_US: u32 = 20_000;

fn state() -> impl Strategy<Value = BalanceState> {
    prop_oneof![
        4 => Just(BalanceState::Sit),
        4 => Just(BalanceState::StandUp),
        4 => Just(BalanceState::Balance),
        1 => Just(BalanceState::Jump),
        1 => Just(BalanceState::SitDown),
        1 => Just(BalanceState::Fallen),
        1 => Just(BalanceState::CannotRise),
    ]
}

/// Draws what holds for some ticks of 1 ms, and their number.
fn phase() -> impl Strategy<Value = (StandingInputs, u32)> {
    let switch = prop_oneof![
        1 => Just(StandSwitch::Unknown),
        3 => Just(StandSwitch::Down),
        4 => Just(StandSwitch::Up),
    ];
    let rarely = || prop_oneof![9 => Just(false), 1 => Just(true)];
    let robot = (any::<bool>(), any::<bool>(), rarely(), rarely(), rarely());
    (switch, state(), robot, 1u32..30).prop_map(|(switch, balance, robot, ticks)| {
        let (armed, fallen, topples, stopped, part_stopped) = robot;
        let inputs = StandingInputs {
            switch,
            armed,
            balance,
            fallen,
            topples,
            stopped,
            part_stopped,
            time_us: TIME_US,
        };
        (inputs, ticks)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// What an idle robot saves in a tick changes nothing.
    #[test]
    fn an_idle_robot_is_no_special_case(phases in prop::collection::vec(phase(), 1..40)) {
        let mut standing = Standing::default();
        for (number, (mut inputs, _)) in phases.into_iter().enumerate() {
            let now_us = 1_000 * number as u64;
            inputs.balance = BalanceState::Sit;
            let mut idle = standing.clone();
            let was_idle = standing.is_idle() && inputs.switch != StandSwitch::Up;
            let flags = standing.step(&inputs, now_us);
            if was_idle {
                idle.idle(inputs.switch, inputs.stopped);
                prop_assert_eq!(&idle, &standing);
                prop_assert_eq!(flags.contains(SafetyFlags::TILT), inputs.fallen);
                prop_assert_eq!(flags.difference(SafetyFlags::TILT), SafetyFlags::NONE);
            }
        }
    }

    /// Necessary conditions, told without the state machine: a fall is without consequence only after the switch was
    /// seen down and then up, with no stop since, and while armed for no longer than the time of standing up.
    #[test]
    fn a_lying_robot_is_not_stopped_only_on_request(phases in prop::collection::vec(phase(), 1..40)) {
        let mut standing = Standing::default();
        let (mut seen_down, mut armed_ticks, mut now_us) = (false, 0, 1_000_000);
        for (inputs, ticks) in phases {
            for _ in 0..ticks {
                now_us += 1_000;
                let flags = standing.step(&inputs, now_us);
                seen_down |= inputs.switch == StandSwitch::Down;
                if inputs.stopped || flags.intersects(SafetyFlags::BALANCE_LOST) {
                    seen_down = inputs.switch == StandSwitch::Down && !inputs.stopped && seen_down;
                }
                let up = inputs.switch == StandSwitch::Up;
                armed_ticks = if up && inputs.armed { armed_ticks + 1 } else { 0 };
                if inputs.fallen && !inputs.stopped && !flags.intersects(SafetyFlags::FALLEN) {
                    prop_assert!(up && seen_down, "{inputs:?}");
                    prop_assert!(armed_ticks <= TIME_US / 1_000 + 1, "{armed_ticks}");
                }
                if inputs.stopped {
                    prop_assert!(!standing.permit().permits() && !standing.permit().may_lie());
                }
                if standing.permit() == StandPermit::Standing {
                    prop_assert!(inputs.armed && !inputs.part_stopped && !inputs.topples);
                }
            }
        }
    }
}
