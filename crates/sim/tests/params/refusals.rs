//! Conditions that forbid arming, and conditions that forbid writing to flash.

use robot_plant::time::{MS, SECOND};

use crate::{
    flash_image::{Image, Stored, newest},
    robot::Robot,
    settings::{Make, image},
};

/// By this time calibration and set-up of the motors are over.
const READY: u64 = 2_400 * MS;
const JOINT: u8 = 16;
const ZERO_RAD: u8 = 1;
const TRACK: (u8, u8) = (1, 1);
/// Below the voltage detector's highest level, 2.9 V (RM0090 5.4.1).
const LOW_MV: u32 = 2_850;
const NOMINAL_MV: u32 = 3_300;
/// `diag.params.last_error`: the flash driver refused.
const FLASH_ERROR: f64 = 1.0;

#[test]
fn a_robot_with_refused_settings_is_not_armed_until_they_are_saved_again() {
    // A zero that is no number.
    let broken = Stored::of(1, &[1.0, f32::NAN, -1.25, 1.25, 3.0, 8.0, 90.0, 2.0]);
    let make = Make::Dm4310;
    let flash = image(make, 20).record(0, 21, (JOINT, make as u8), &broken);
    let mut robot = Robot::with_flash(make, &flash);
    robot.until(READY);
    robot.enable(true);
    robot.run_for(500 * MS);
    // The request is also used up.
    let blockers = ["enable-not-cycled", "settings-refused"];
    assert_eq!(robot.names_in("arming.blockers"), blockers);
    robot.enable(false);
    robot.run_for(50 * MS);
    robot.set((JOINT, ZERO_RAD), 0.25);
    robot
        .wait(2 * SECOND, |robot| robot.is_saved(1))
        .expect("it is saved");
    robot.run_for(100 * MS);
    robot.enable(true);
    robot.wait(500 * MS, Robot::armed).expect("it arms");
}

#[test]
fn flash_is_left_alone_while_the_supply_is_low() {
    let mut robot = Robot::with_flash(Make::Dm4310, &image(Make::Dm4310, 20));
    robot.until(READY);
    let steps_before = robot.machine.flash_steps().len();
    robot.machine.set_vdd_mv(LOW_MV);
    robot.set(TRACK, 0.44);
    robot.run_for(SECOND);
    assert_eq!(robot.machine.flash_steps().len(), steps_before);
    assert_eq!(robot.diag("params.last_error"), Some(FLASH_ERROR));
    robot.machine.set_vdd_mv(NOMINAL_MV);
    robot
        .wait(2 * SECOND, |robot| robot.is_saved(1))
        .expect("it is saved at the next attempt");
    let stored = newest(&robot.machine.parameter_flash());
    assert_eq!(stored[&(1, 0)].values[1], 0.44_f32.to_bits());
}

#[test]
fn no_sector_is_erased_while_the_supply_is_low() {
    let mut robot = Robot::with_flash(Make::Dm4310, &Image::blank());
    robot.machine.set_vdd_mv(LOW_MV);
    robot.run_for(SECOND);
    assert!(robot.machine.flash_steps().is_empty());
    assert_eq!(robot.diag("params.last_error"), Some(FLASH_ERROR));
    robot.machine.set_vdd_mv(NOMINAL_MV);
    robot
        .wait(3 * SECOND, Robot::is_tidy)
        .expect("it is erased at the next attempt");
}
