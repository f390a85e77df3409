//! The travel of a joint, recorded from servos that are turned by hand.

use std::time::Duration;

use robot_arm::{
    bus::register::{HOMING_OFFSET, PRESENT_POSITION},
    calibration::{Calibration, Format, Travel},
    controller::ServoController,
};

use crate::wire::Emulated;

const LOOK: Duration = Duration::from_millis(5);

/// Turns a shaft and follows it over the bus.
fn record(emulated: &Emulated, middle: f64, low: f64, high: f64) -> Travel {
    let mut bus = emulated.bus();
    let mut position = |angle: f64| {
        emulated.wire().bus().servo_mut(0).unwrap().turn_to(angle);
        // The servo looks at its sensor now and then.
        bus.wait(LOOK).unwrap();
        bus.read(1, PRESENT_POSITION).unwrap().value
    };
    let mut travel = Travel::new(position(middle), 0);
    let mut angle = middle;
    for goal in [low, high] {
        while (goal - angle).abs() > 1.0 {
            angle += (goal - angle).clamp(-50.0, 50.0);
            travel.follow(position(angle), 0);
        }
    }
    travel
}

/// The travel of 3600 to 4700 steps has the seam in it. LeRobot's format takes it by an offset in the servo; the servo then reports
/// the middle as 2047 and both ends without a jump.
#[test]
fn a_travel_across_the_seam_is_calibrated_with_an_offset() {
    let emulated = Emulated::arm(30);
    let travel = record(&emulated, 4150.0, 3600.0, 4700.0);
    let plain = travel
        .finish(1, Format::Plain, false)
        .unwrap_err()
        .to_string();
    assert!(plain.contains("--format lerobot"), "{plain}");
    let joint = travel.finish(1, Format::LeRobot, false).unwrap();
    assert_eq!(
        (joint.homing_offset, joint.range_min, joint.range_max),
        (54 - 2047, 1497, 2597)
    );
    let joints = vec![("shoulder_pan".to_owned(), joint)];
    let calibration = Calibration::new(Format::LeRobot, joints).unwrap();
    let mut arm = ServoController::new(emulated.bus(), calibration).unwrap();
    arm.apply_calibration().unwrap();
    let mut reported = |angle: f64| {
        emulated.wire().bus().servo_mut(0).unwrap().turn_to(angle);
        arm.bus().wait(LOOK).unwrap();
        arm.bus().read(1, PRESENT_POSITION).unwrap().value
    };
    let ends = [3600.0, 4150.0, 4700.0].map(&mut reported);
    assert_eq!(ends, [1497, 2047, 2597]);
    assert_eq!(arm.bus().read(1, HOMING_OFFSET).unwrap().value, 54 - 2047);
}
