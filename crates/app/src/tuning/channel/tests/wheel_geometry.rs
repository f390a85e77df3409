//! The wheel geometry as old clients write and read it.

use super::*;

#[test]
fn an_old_client_writes_the_wheel_geometry_and_gets_an_echo() {
    let mut bench = Bench::default();
    assert_eq!(bench.write(&GEOMETRY), GEOMETRY);
    let expected = WheelOdomConfig {
        wheel_radius_m: 0.08,
        wheel_track_m: 0.45,
        gear_ratio: 36.0,
        rpm_sign_left: -1.0,
        rpm_sign_right: 1.0,
    };
    assert_eq!(bench.config.wheel_odom, expected);
    assert_eq!(
        bench.read(&[0x11]),
        [0x11, 80, 0, 0xC2, 0x01, 0x10, 0x0E, 0x01]
    );
}

/// 75 mm, 420 mm, 3591/187 = 19.203 as 1920, right wheel reversed. The length of a read is free.
#[test]
fn an_old_client_reads_the_defaults() {
    let mut bench = Bench::default();
    let expected = [0x11, 75, 0, 0xA4, 0x01, 0x80, 0x07, 0x02];
    assert_eq!(bench.read(&[0x11]), expected);
    assert_eq!(bench.read(&[0x11, 9, 9, 9, 9, 9, 9, 9]), expected);
    assert_eq!(bench.reply(TuningGate::Shut, 0x7A1, &[0x11]), expected);
}

/// 60.6 mm and 19.206 round to 61 and 1921.
#[test]
fn geometry_is_rounded_for_old_clients() {
    let mut bench = Bench::default();
    bench.config.wheel_odom.wheel_radius_m = 0.0606;
    bench.config.wheel_odom.gear_ratio = 19.206;
    let expected = [0x11, 61, 0, 0xA4, 0x01, 0x81, 0x07, 0x02];
    assert_eq!(bench.read(&[0x11]), expected);
}
