//! Loading of settings at boot.

use robot_app::{
    domain::{FlashRequest, ParamState, RobotConfig},
    motor::layout::{ROBOT_LAYOUT, RS00_LAYOUT},
    tuning::PARAMETERS,
};

use robot_plant::flash_chip::Phase;

use crate::{
    dump::{self, slot},
    robot::{Chip, Robot},
};

const HEATER: u32 = 1 << 6;
const SAFETY: u32 = 1 << 3;
const GEOMETRY: u32 = 1 << 0;

/// The group's bit in the masks of `ParamStatus`.
fn bit_of(group: &str) -> u32 {
    let place = PARAMETERS.iter().position(|known| known.name == group);
    1 << place.unwrap()
}

/// One erase, once the robot is at rest, produces a sector that is known to be blank.
#[test]
fn a_new_chip_has_the_defaults_and_gets_ready_for_a_save_at_rest() {
    let chip = Chip::blank();
    let mut robot = Robot::boot(&chip);
    assert_eq!(robot.config, RobotConfig::default());
    let status = robot.status();
    assert_eq!((status.loaded, status.refused, status.foreign), (0, 0, 0));
    assert_eq!((status.lost_sectors, status.generation), (0, 0));
    assert_eq!(status.state, ParamState::Saved);
    robot.rests = false;
    robot.run_ms(10_000);
    assert_eq!(robot.asked(), FlashRequest::Erase);
    assert_eq!(chip.erases(), 0);
    robot.rests = true;
    robot.save();
    assert_eq!((chip.erases(), robot.status().erases), (1, 1));
    assert_eq!(Robot::ready(&chip).status().erases, 0);
}

/// This holds for any contents of the flash, as joints may still have torque from before the reset.
#[test]
fn a_boot_erases_nothing() {
    let full_of = |byte| {
        let chip = Chip::blank();
        let mut cells = chip.cells.borrow_mut();
        cells
            .set_contents(0x0800_4000, &vec![byte; 3 * 16 * 1024])
            .unwrap();
        drop(cells);
        chip
    };
    let chips = [Chip::blank(), full_of(0x5A), full_of(0), dump::chip(3, &[])];
    for chip in chips {
        Robot::boot(&chip);
        assert_eq!(chip.erases(), 0);
    }
}

#[test]
fn what_was_saved_is_there_after_a_reboot() {
    let chip = Chip::blank();
    let mut robot = Robot::boot(&chip);
    robot.change(|config| {
        config.heater.target_c = 37.5;
        config.joints[3].zero_rad = -1.25;
    });
    robot.save();
    assert_eq!(robot.status().save_ok, 2);
    let again = Robot::boot(&chip);
    assert_eq!(again.config, robot.config);
    assert_eq!(again.status().loaded, HEATER | bit_of("joint-right-rear"));
    // The other groups have defaults, which no one changed: they are in no record.
    assert_eq!(again.status().generation, 1);
}

/// Values are those of docs/parameters.md's example.
#[test]
fn a_dump_written_by_hand_is_understood() {
    let chip = dump::chip(
        41,
        &[
            slot([7, 1, 0], &[30.0, 0.5, 0.25, 1.0]),
            slot([1, 1, 0], &[0.075, 0.45, 36.0, -1.0, 1.0]),
            slot([7, 1, 0], &[45.0, 0.5, 0.25, 0.75]),
        ],
    );
    let robot = Robot::boot(&chip);
    let mut expected = RobotConfig::default();
    expected.heater.target_c = 45.0;
    expected.heater.kp = 0.5;
    expected.heater.ki = 0.25;
    expected.heater.max_duty = 0.75;
    expected.wheel_odom.wheel_radius_m = 0.075;
    expected.wheel_odom.wheel_track_m = 0.45;
    expected.wheel_odom.gear_ratio = 36.0;
    expected.wheel_odom.rpm_sign_left = -1.0;
    expected.wheel_odom.rpm_sign_right = 1.0;
    assert_eq!(robot.config, expected);
    let status = robot.status();
    assert_eq!(status.loaded, HEATER | GEOMETRY);
    assert_eq!((status.generation, status.free_slots), (41, 124));
    assert_eq!((status.damaged, status.refused), (0, 0));
}

#[test]
fn a_damaged_record_falls_back_to_the_one_before_it() {
    let mut torn = slot([7, 1, 0], &[45.0, 0.5, 0.25, 0.75]);
    torn[9] ^= 0x10;
    let older = slot([7, 1, 0], &[30.0, 0.5, 0.25, 1.0]);
    let robot = Robot::boot(&dump::chip(1, &[older, torn]));
    assert_eq!(robot.config.heater.target_c, 30.0);
    assert_eq!(robot.status().damaged, 1);
}

/// A word torn by a power cut may read differently at each boot. What the first boot makes of it stays.
#[test]
fn a_torn_save_reads_the_same_in_all_later_boots() {
    let before = Chip::blank();
    let mut robot = Robot::boot(&before);
    robot.change(|config| config.heater.kp = 0.5);
    robot.save();
    let first_word = before.cells.borrow().steps();
    let (mut old, mut new) = (0, 0);
    for (word, seed) in (0..8).flat_map(|word| (0..25).map(move |seed| (word, seed))) {
        let chip = before.copy(seed);
        let mut robot = Robot::boot(&chip);
        let cut = first_word + word;
        chip.cells.borrow_mut().cut_at(cut, Phase::Middle);
        robot.change(|config| config.heater.kp = 0.25);
        robot.run_ms(510);
        assert!(!chip.cells.borrow().is_powered());
        chip.cells.borrow_mut().power_up();
        let kp = Robot::boot(&chip).config.heater.kp;
        match kp {
            0.5 => old += 1,
            0.25 => new += 1,
            _ => panic!("{kp} was never set"),
        }
        for _ in 0..5 {
            let again = Robot::boot(&chip).config.heater.kp;
            assert_eq!(again, kp, "word {word}, seed {seed}");
        }
    }
    assert!(old > 0 && new > 0, "{old} old, {new} new");
}

/// Another firmware's group, a later version, a value out of range and a joint of the other make.
fn others_records() -> [Vec<u8>; 4] {
    [
        slot([200, 9, 3], &[1.0, 2.0, 3.0]),
        slot([7, 2, 0], &[45.0, 0.5, 0.25, 0.75, 9.0]),
        slot([4, 1, 0], &[f32::NAN; 15]),
        slot([16, 1, 2], &[1.0, 0.5, -1.0, 1.0, 3.0, 15.0, 100.0, 5.0]),
    ]
}

#[test]
fn unknown_records_are_reported_and_replaced_by_defaults() {
    let robot = Robot::boot(&dump::chip(1, &others_records()));
    assert_eq!(robot.config, RobotConfig::default());
    let status = robot.status();
    assert_eq!(status.refused, HEATER | SAFETY);
    assert_eq!((status.loaded, status.foreign), (0, 2));
    assert_eq!(status.state, ParamState::Saved);
}

/// 300 saves fill two sectors.
#[test]
fn unknown_records_stay_in_flash_bit_for_bit() {
    let chip = dump::chip(1, &others_records());
    let mut robot = Robot::boot(&chip);
    for number in 0..300u16 {
        robot.change(|config| config.wheel_odom.wheel_track_m = 0.3 + f32::from(number) * 1e-3);
        robot.save();
    }
    assert_eq!(
        (robot.status().save_ok, robot.status().generation),
        (300, 3)
    );
    for record in others_records() {
        assert!(dump::copies(&chip.dump(), &record) >= 1);
    }
    let again = Robot::boot(&chip);
    assert_eq!(again.status().refused, HEATER | SAFETY);
    assert_eq!(again.status().foreign, 2);
    let rs00 = Robot::boot_with(&chip, &RS00_LAYOUT);
    assert_eq!(rs00.config.joints[0].zero_rad, 0.5);
    assert_eq!(rs00.status().loaded, GEOMETRY | bit_of("joint-left-front"));
}

#[test]
fn a_refused_group_is_saved_once_it_is_changed() {
    let chip = dump::chip(1, &others_records());
    let mut robot = Robot::boot(&chip);
    robot.change(|config| config.safety.stick_centre = 0.1);
    robot.save();
    let again = Robot::boot(&chip);
    assert_eq!(again.status().loaded, SAFETY);
    assert_eq!(robot.status().refused, HEATER);
    assert_eq!(again.config.safety, robot.config.safety);
}

const STICK_CENTRE: fn(&RobotConfig) -> f32 = |config| config.safety.stick_centre;

/// The defaults are in use already, but flash still holds the refused record.
#[test]
fn a_refused_group_is_saved_once_it_is_given_its_defaults() {
    let chip = dump::chip(1, &others_records());
    let mut robot = Robot::boot(&chip);
    robot.run_ms(5_000);
    assert_eq!(robot.status().refused, HEATER | SAFETY);
    robot.restore(SAFETY);
    robot.step();
    assert_eq!(robot.status().unsaved, SAFETY);
    robot.save();
    assert_eq!(
        (robot.status().refused, robot.status().save_ok),
        (HEATER, 1)
    );
    let mut again = Robot::boot(&chip);
    assert_eq!(
        (again.status().loaded, again.status().refused),
        (SAFETY, HEATER)
    );
    assert_eq!(
        STICK_CENTRE(&again.config),
        STICK_CENTRE(&RobotConfig::default())
    );
    // All groups: nothing else is refused, and what is saved already is not saved again.
    again.restore(0x7FF);
    again.save();
    assert_eq!((again.status().refused, again.status().save_ok), (0, 1));
    assert_eq!(Robot::boot(&chip).status().refused, 0);
}

#[test]
fn a_refused_group_stays_refused_until_its_defaults_are_really_in_flash() {
    let chip = dump::chip(1, &others_records());
    let mut robot = Robot::ready(&chip);
    robot.chip.refuses_words.set(true);
    robot.restore(SAFETY);
    robot.run_ms(5_000);
    assert_eq!(robot.status().unsaved, SAFETY);
    assert_eq!(robot.status().refused, HEATER | SAFETY);
    robot.chip.refuses_words.set(false);
    robot.run_ms(70_000);
    assert_eq!(
        (robot.status().unsaved, robot.status().refused),
        (0, HEATER)
    );
}

/// The newest sector is ruined while another one is clean, which no power cut does.
#[test]
fn older_values_after_damage_are_reported() {
    let chip = Chip::blank();
    let mut robot = Robot::boot(&chip);
    for number in 0..200u8 {
        robot.change(|config| config.heater.target_c = 20.0 + f32::from(number) * 0.1);
        robot.save();
    }
    assert_eq!(robot.status().generation, 2);
    let mut cells = chip.cells.borrow_mut();
    cells.set_contents(0x0800_8000, &[0x5A; 16 * 1024]).unwrap();
    drop(cells);
    let mut robot = Robot::boot(&chip);
    assert!((robot.config.heater.target_c - 39.9).abs() > 1.0);
    assert_eq!(
        (robot.status().generation, robot.status().lost_sectors),
        (1, 1)
    );
    robot.change(|config| config.heater.target_c = 35.0);
    robot.save();
    assert_eq!(robot.status().save_ok, 1);
}

#[test]
fn each_make_of_motors_keeps_its_own_joint_settings() {
    let chip = Chip::blank();
    for (layout, zero_rad) in [(&ROBOT_LAYOUT, 0.25), (&RS00_LAYOUT, -0.75)] {
        let mut robot = Robot::boot_with(&chip, layout);
        assert_eq!(robot.config.joints[1].zero_rad, 0.0);
        robot.change(|config| config.joints[1].zero_rad = zero_rad);
        robot.save();
    }
    let zero = |layout| Robot::boot_with(&chip, layout).config.joints[1].zero_rad;
    assert_eq!(zero(&ROBOT_LAYOUT), 0.25);
    assert_eq!(zero(&RS00_LAYOUT), -0.75);
}
