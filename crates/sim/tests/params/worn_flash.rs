//! Cells that stick and sectors that do not erase: the store pauses, the fault is shown, and the robot still drives.

use robot_plant::{
    flash_chip::{EraseFault, StuckBit},
    time::{MS, Ps, SECOND},
};
use robot_sim::machine::flash::FlashStepKind;
use robot_test_support::is_whole;

use crate::{
    at_rest_only::before_a_rotation,
    flash_image::{SLOT_BYTES, newest},
    robot::{Robot, state},
    settings::{Make, image},
};

const FIRST_SECTOR: u32 = 0x0800_4000;
const TRACK: (u8, u8) = (1, 1);
/// `diag.params.last_error`.
const NOT_PROGRAMMED: f64 = 2.0;
const NOT_ERASED: f64 = 3.0;

/// When each erase began.
fn erases(robot: &Robot) -> Vec<Ps> {
    let steps = robot.machine.flash_steps().iter();
    steps
        .filter(|step| step.kind == FlashStepKind::Erase)
        .map(|step| step.at)
        .collect()
}

/// Blue and white in turn, as docs/indications.md has it.
fn shows_not_saved(robot: &mut Robot) -> bool {
    let (mut blue, mut white) = (false, false);
    for _ in 0..150 {
        robot.run_for(10 * MS);
        let [r, g, b] = ["r", "g", "b"].map(|led| robot.world(&format!("truth.led.{led}")) > 0.0);
        blue |= b && !r && !g;
        white |= r && g && b;
    }
    blue && white
}

fn drives_when_asked(robot: &mut Robot) {
    robot.enable(true);
    robot
        .wait(SECOND, Robot::armed)
        .expect("it arms all the same");
    robot.stick(0.3);
    robot.run_for(700 * MS);
    assert!(robot.drives());
    robot.stick(0.0);
    robot.run_for(500 * MS);
    robot.enable(false);
    robot.run_for(100 * MS);
}

/// The sector is full, the next one is not clean, and no sector can be erased.
#[test]
fn erases_that_fail_are_tried_again_after_ever_longer_pauses() {
    let mut robot = Robot::with_flash(
        Make::Dm4310,
        &before_a_rotation(Make::Dm4310).garbage(1, || 0x77),
    );
    for sector in 1..=3 {
        robot
            .machine
            .set_flash_erase_fault(sector, Some(EraseFault::DoesNothing));
    }
    robot.until(2_500 * MS);
    assert_eq!(robot.diag("params.last_error"), Some(NOT_ERASED));
    robot.set(TRACK, 0.5);
    robot.run_for(2 * SECOND);
    assert_eq!(robot.diag("params.state"), Some(state::BACKING_OFF));
    assert!(shows_not_saved(&mut robot), "the LED tells");
    drives_when_asked(&mut robot);
    let least_s = &[1.0, 10.0, 60.0, 300.0][..if is_whole() { 4 } else { 3 }];
    let all_s = least_s.iter().sum::<f64>();
    robot.until(5 * SECOND + (all_s * SECOND as f64) as Ps);
    let begun = erases(&robot);
    let pauses: Vec<f64> = begun
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) as f64 / SECOND as f64)
        .collect();
    println!("seconds between attempts: {pauses:.2?}");
    assert_eq!(pauses.len(), least_s.len());
    for (pause, least) in pauses.iter().zip(least_s) {
        // It begins after the erase of 0.25 s; half a second of rest comes before the next one.
        assert!(
            (*least..least + 1.0).contains(pause),
            "{pause} s instead of {least}"
        );
    }
    assert_eq!(robot.diag("params.save_ok"), Some(0.0));
    assert_eq!(robot.store_state()[2], 1, "one group is not saved");
    assert_eq!(robot.machine.resets(), 0);
    assert_eq!(robot.machine.stats().missed, 0);
}

/// A sector that cannot be erased is skipped; the others suffice.
#[test]
fn a_sector_that_cannot_be_erased_is_skipped() {
    let mut robot = Robot::with_flash(
        Make::Dm4310,
        &before_a_rotation(Make::Dm4310).garbage(1, || 0x77),
    );
    robot
        .machine
        .set_flash_erase_fault(2, Some(EraseFault::LeavesSomeWords));
    robot.until(SECOND);
    robot.set(TRACK, 0.5);
    let took = robot
        .wait(15 * SECOND, |robot| robot.is_saved(1))
        .expect("it is saved");
    println!(
        "saved {} ms after the change, though one sector cannot be erased",
        took / MS
    );
    let stored = newest(&robot.machine.parameter_flash());
    assert_eq!(stored[&(1, 0)].values[1], 0.5_f32.to_bits());
    robot.machine.cut_power(5 * MS);
    robot.run_for(SECOND);
    assert_eq!(robot.settings()[&TRACK], 0.5_f32.to_bits());
}

/// Each of the next two slots has a cell that cannot be cleared.
#[test]
fn a_slot_that_cannot_be_written_is_skipped() {
    let mut robot = Robot::with_flash(Make::Dm4310, &image(Make::Dm4310, 50));
    for slot in [51, 52] {
        robot.machine.stick_flash_bit(StuckBit {
            // Key 1 has bit 5 clear.
            address: FIRST_SECTOR + slot * SLOT_BYTES as u32 + 4,
            bit: 5,
            value: true,
        });
    }
    robot.until(SECOND);
    robot.set(TRACK, 0.5);
    robot
        .wait(2 * SECOND, |robot| {
            robot.diag("params.save_failed") == Some(1.0)
        })
        .expect("the first attempt fails");
    assert_eq!(robot.diag("params.last_error"), Some(NOT_PROGRAMMED));
    let mut failed = vec![robot.now()];
    robot
        .wait(3 * SECOND, |robot| {
            robot.diag("params.save_failed") == Some(2.0)
        })
        .expect("so does the second");
    failed.push(robot.now());
    robot
        .wait(12 * SECOND, |robot| robot.is_saved(1))
        .expect("the third is done");
    let pauses = [failed[1] - failed[0], robot.now() - failed[1]].map(|pause| pause / MS);
    println!("milliseconds between attempts: {pauses:?}");
    assert!((1_000..1_100).contains(&pauses[0]) && (10_000..10_100).contains(&pauses[1]));
    assert_eq!(robot.diag("params.save_ok"), Some(1.0));
    let stored = newest(&robot.machine.parameter_flash());
    assert_eq!(stored[&(1, 0)].values[1], 0.5_f32.to_bits());
    // The next one goes at once.
    robot.set(TRACK, 0.51);
    let took = robot
        .wait(2 * SECOND, |robot| robot.is_saved(2))
        .expect("it is saved");
    assert!(took < 600 * MS, "{took}");
}

/// The flash cannot be written at first, and later it can.
#[test]
fn worn_out_flash_is_reported_and_stops_nothing() {
    let mut robot = Robot::with_flash(Make::Dm4310, &image(Make::Dm4310, 50));
    robot.until(2_500 * MS);
    robot.fault("flash-stuck-bits", true);
    robot.set(TRACK, 0.5);
    robot.run_for(SECOND);
    assert_eq!(robot.diag("params.state"), Some(state::BACKING_OFF));
    assert!(shows_not_saved(&mut robot), "the LED tells");
    drives_when_asked(&mut robot);
    robot.run_for(10 * SECOND);
    assert_eq!(robot.diag("params.save_ok"), Some(0.0));
    let attempts = robot.diag("params.save_failed");
    assert!(
        attempts >= Some(2.0) && attempts <= Some(4.0),
        "{attempts:?}"
    );
    robot.fault("flash-stuck-bits", false);
    robot
        .wait(65 * SECOND, |robot| robot.is_saved(1))
        .expect("now it can be saved");
    assert_eq!(robot.settings()[&TRACK], 0.5_f32.to_bits());
    assert_eq!(robot.machine.resets(), 0);
}
