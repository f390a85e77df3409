//! Groups that get their defaults back.

use super::*;

#[test]
fn one_group_or_all_groups_are_set_to_defaults() {
    let mut bench = tuned();
    let one = [0x30, 2, 0, 0, 0, 0, 0, 0];
    assert_eq!(bench.write(&one), one);
    assert_eq!(bench.config.wheel_ctrl.max_vx_mps, 1.5);
    assert_eq!(bench.config.heater.target_c, 30.0);
    assert_eq!(bench.channel.status().revision, 3);
    let all = [0x30, 0, 0, 0, 0, 0, 0, 0];
    assert_eq!(bench.write(&all), all);
    assert_eq!(bench.config, RobotConfig::default());
    assert_eq!(bench.channel.status().revision, 4);
}

/// `ROBOT_LAYOUT` with another left rear joint.
static OTHER_ROBOT: MotorLayout = {
    let mut joints = *ROBOT_LAYOUT.joints();
    joints[1].config.max_kp = 50.0;
    MotorLayout::new(ROBOT_LAYOUT.profile(), *ROBOT_LAYOUT.wheels(), joints)
};

#[test]
fn the_defaults_come_from_the_motor_layout() {
    let mut bench = Bench {
        channel: TuningChannel::new(&OTHER_ROBOT),
        ..Bench::default()
    };
    bench.write(&[0x30, 16, 0, 0, 0, 0, 0, 0]);
    assert_eq!(bench.config, RobotConfig::default());
    bench.write(&[0x30, 17, 0, 0, 0, 0, 0, 0]);
    assert_eq!(bench.config.joints[1].max_kp, 50.0);
    bench.config = RobotConfig::default();
    bench.write(&[0x30, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(bench.config.joints[1].max_kp, 50.0);
}

/// The store saves this group although it looks unchanged, as flash may hold a refused record.
#[test]
fn unchanged_defaults_are_reported_to_the_store() {
    let mut bench = Bench::default();
    let all = (1 << crate::tuning::PARAMETERS.len()) - 1;
    bench.write(&[0x30, 7, 0, 0, 0, 0, 0, 0]);
    let status = *bench.channel.status();
    assert_eq!((status.restored, status.revision), (place(7), 1));
    bench.write(&[0x30, 0, 0, 0, 0, 0, 0, 0]);
    let status = *bench.channel.status();
    assert_eq!((status.restored, status.revision), (all, 2));
    bench.write(&[0x20, 7, 0, 0, 0x00, 0x00, 0xF0, 0x41]);
    bench.write(&[0x30, 31, 0, 0, 0, 0, 0, 0]);
    let status = *bench.channel.status();
    assert_eq!((status.restored, status.revision), (all, 3));
}
