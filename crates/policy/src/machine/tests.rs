use super::*;
use crate::runner::testing;

#[test]
fn a_joint_goes_straight_from_its_angle_to_the_default() {
    let policy = testing::policy();
    let mut machine = Machine::new(&policy, Timing::default());
    let mut reading = Reading::at_default_pose(&policy);
    reading.joint_pos_rad[0] = 0.7;
    machine.step(10.0, true, &reading);
    assert_eq!(machine.step(10.49, true, &reading), Phase::Passive);
    assert_eq!(machine.step(10.5, true, &reading), Phase::GetUp);
    let mut targets = Vec::new();
    for (at_s, wanted_rad) in [
        (10.5, 0.7),
        (10.75, 0.45),
        (11.0, 0.2),
        (11.5, -0.3),
        (12.4, -0.3),
    ] {
        machine.step(at_s, true, &reading);
        machine.pose(at_s, &mut targets);
        let Target::Position { rad, kp, kd } = targets[0] else {
            panic!("{targets:?}");
        };
        assert!((rad - wanted_rad).abs() < 1e-6, "{at_s}: {rad}");
        assert_eq!((kp, kd), (40.0, 1.0));
        assert_eq!(targets[5], Target::Speed { rps: 0.0, kd: 0.5 });
    }
    assert_eq!(machine.step(12.5, true, &reading), Phase::Policy);
}

#[test]
fn a_run_that_never_got_up_ends_at_once() {
    let policy = testing::policy();
    let mut machine = Machine::new(&policy, Timing::default());
    let reading = Reading::at_default_pose(&policy);
    assert_eq!(machine.stop(Stop::Asked, 1.0, &reading), Phase::Passive);
    assert!(machine.is_over());
    assert_eq!(
        machine.step(9.0, true, &reading),
        Phase::Passive,
        "it stays down"
    );
}
