//! When a save begins, and what happens if it fails.

use robot_app::domain::{FlashRequest, ParamError, ParamState, RobotConfig};
use robot_plant::flash_chip::{EraseFault, StuckBit, sector_range};

use crate::{
    dump,
    robot::{Chip, Robot},
};

#[test]
fn a_save_comes_half_a_second_after_the_last_change() {
    let mut robot = Robot::ready(&Chip::blank());
    let programs = robot.chip.cells.borrow().programs();
    robot.change(|config| config.heater.kp = 1.0);
    robot.step();
    assert_eq!(robot.status().state, ParamState::Settling);
    assert_eq!((robot.status().unsaved, robot.status().seen), (1 << 6, 1));
    robot.run_ms(400);
    robot.change(|config| config.heater.kp = 2.0);
    robot.run_ms(500);
    assert_eq!(robot.status().seen, 2);
    assert_eq!(robot.asked(), FlashRequest::None);
    assert_eq!(robot.chip.cells.borrow().programs(), programs);
    robot.run_ms(20);
    assert_eq!(robot.status().state, ParamState::Saved);
    assert_eq!((robot.status().save_ok, robot.status().unsaved), (1, 0));
}

#[test]
fn while_the_robot_may_move_flash_is_left_alone() {
    let mut robot = Robot::ready(&Chip::blank());
    robot.rests = false;
    let steps = robot.chip.cells.borrow().steps();
    robot.change(|config| config.heater.kp = 1.0);
    robot.run_ms(60_000);
    assert_eq!(robot.chip.cells.borrow().steps(), steps);
    assert_eq!(robot.status().state, ParamState::WaitingForRest);
    assert_eq!(robot.asked(), FlashRequest::Program);
    robot.rests = true;
    robot.run_ms(20);
    assert_eq!(robot.status().save_ok, 1);
}

/// All values of a slow drag of a slider: one save.
#[test]
fn a_burst_of_changes_is_one_save() {
    let mut robot = Robot::boot(&Chip::blank());
    for number in 0..1_000u16 {
        robot.change(|config| config.heater.target_c = 20.0 + f32::from(number) * 0.01);
        robot.run_ms(10);
    }
    robot.save();
    assert_eq!(robot.status().save_ok, 1);
    assert_eq!(Robot::boot(&robot.chip).config, robot.config);
}

/// docs/parameters.md: 1, 10, 60, 300 s, and then every 300 s.
#[test]
fn a_failing_save_is_repeated_after_growing_pauses() {
    let mut robot = Robot::boot(&Chip::blank());
    robot.change(|config| config.heater.kp = 0.5);
    robot.save();
    robot.chip.refuses_words.set(true);
    robot.change(|config| config.heater.kp = 1.0);
    let start_s = robot.seconds();
    let mut attempts_s = Vec::new();
    while attempts_s.len() < 6 {
        robot.step();
        if robot.status().save_failed as usize > attempts_s.len() {
            attempts_s.push(robot.seconds() - start_s);
            robot.step();
            assert_eq!(robot.status().state, ParamState::BackingOff);
        }
    }
    for (attempt_s, expected_s) in attempts_s.iter().zip([0.5, 1.5, 11.5, 71.5, 371.5, 671.5]) {
        assert!((attempt_s - expected_s).abs() < 0.05, "{attempts_s:?}");
    }
    let status = robot.status();
    assert_eq!(status.last_error, ParamError::Flash);
    assert_eq!((status.save_ok, status.unsaved), (1, 1 << 6));

    robot.chip.refuses_words.set(false);
    robot.run_ms(300_010);
    assert_eq!(robot.status().save_ok, 2);
    robot.chip.refuses_words.set(true);
    robot.change(|config| config.heater.kp = 2.0);
    robot.run_ms(600);
    assert_eq!(robot.status().save_failed, 7);
    robot.run_ms(1_000);
    assert_eq!(robot.status().save_failed, 8, "the pauses begin anew");
}

/// A cell in the next slot cannot be cleared, so the slot after it takes the record.
#[test]
fn a_worn_out_slot_delays_a_save_by_a_second() {
    let chip = Chip::blank();
    let mut robot = Robot::boot(&chip);
    robot.change(|config| config.heater.kp = 1.0);
    robot.save();
    for sector in [0x0800_4000, 0x0800_8000, 0x0800_C000] {
        chip.cells.borrow_mut().stick(StuckBit {
            address: sector + 2 * 128 + 4 + 3,
            bit: 0,
            value: true,
        });
    }
    robot.change(|config| config.heater.kp = 2.0);
    robot.run_ms(1_000);
    assert_eq!(robot.status().state, ParamState::BackingOff);
    assert_eq!(robot.status().last_error, ParamError::NotProgrammed);
    robot.run_ms(600);
    assert_eq!((robot.status().save_ok, robot.status().save_failed), (2, 1));
    assert_eq!(Robot::boot(&chip).config.heater.kp, 2.0);
}

/// No slot of the active sector takes a record. After three attempts and the pauses between them, the next sector
/// does.
#[test]
fn a_worn_out_sector_delays_a_save_by_about_a_minute() {
    let chip = Chip::blank();
    let mut robot = Robot::boot(&chip);
    robot.change(|config| config.heater.kp = 1.0);
    robot.save();
    for slot in 2..128 {
        chip.cells.borrow_mut().stick(StuckBit {
            address: 0x0800_4000 + slot * 128 + 5,
            bit: 7,
            value: true,
        });
    }
    robot.change(|config| config.heater.kp = 2.0);
    robot.run_ms(71_000);
    assert_eq!((robot.status().save_ok, robot.status().save_failed), (1, 3));
    robot.run_ms(1_000);
    assert_eq!((robot.status().save_ok, robot.status().save_failed), (2, 3));
    robot.change(|config| config.heater.kp = 3.0);
    robot.run_ms(1_000);
    assert_eq!((robot.status().save_ok, robot.status().save_failed), (3, 3));
    assert_eq!(Robot::boot(&chip).config.heater.kp, 3.0);
}

/// Its spare sectors cannot be erased, but the active one has room.
fn chip_that_cannot_be_erased() -> Chip {
    let chip = dump::chip(1, &[]);
    for sector in [2, 3] {
        let mut cells = chip.cells.borrow_mut();
        let range = sector_range(sector).unwrap();
        cells
            .set_contents(range.start, &vec![0x5A; range.len()])
            .unwrap();
        cells.set_erase_fault(sector, Some(EraseFault::DoesNothing));
    }
    chip
}

/// The clock does not run while the chip stands still; the pause of a second begins when it goes on.
#[test]
fn an_erase_that_failed_is_repeated_a_pause_after_its_stall() {
    for stall_ms in [0, 400] {
        let mut robot = Robot::boot(&chip_that_cannot_be_erased());
        let erased = (0..10).any(|_| {
            robot.step();
            robot.status().erases == 1
        });
        assert!(erased);
        let told = robot.status();
        robot.note_stall_ms(stall_ms);
        assert_eq!(robot.status().longest_stall_us, stall_ms * 1_000);
        assert_ne!(robot.status().revision, told.revision);
        robot.run_ms(999 + stall_ms);
        assert_eq!(robot.status().erases, 1, "after a stall of {stall_ms} ms");
        robot.run_ms(3);
        assert_eq!(robot.status().erases, 2, "after a stall of {stall_ms} ms");
        robot.note_stall_ms(1);
        assert_eq!(robot.status().longest_stall_us, stall_ms.max(1) * 1_000);
    }
}

#[test]
fn sectors_that_cannot_be_erased_do_not_delay_a_save() {
    let chip = chip_that_cannot_be_erased();
    let mut robot = Robot::boot(&chip);
    robot.run_ms(5);
    assert_eq!(robot.status().last_error, ParamError::NotErased);
    for number in 0..50u8 {
        robot.change(|config| config.heater.target_c = 20.0 + f32::from(number) * 0.1);
        robot.run_ms(520);
        assert_eq!(robot.status().unsaved, 0, "save {number}");
    }
    // The erases were tried after 0, 1 and 11 s of these 26 s.
    assert_eq!((robot.status().erases, robot.status().save_failed), (3, 3));
    assert_eq!(robot.status().state, ParamState::BackingOff);
    assert_eq!(Robot::boot(&chip).config, robot.config);
}

#[test]
fn a_change_undone_in_time_is_not_saved() {
    let mut robot = Robot::boot(&Chip::blank());
    robot.change(|config| config.heater.kp = 1.0);
    robot.run_ms(400);
    robot.change(|config| *config = RobotConfig::default());
    robot.run_ms(2_000);
    assert_eq!(robot.status().save_ok, 0);
    assert_eq!(robot.status().state, ParamState::Saved);
}

#[test]
fn the_status_shows_an_erase_while_it_runs() {
    let mut robot = Robot::boot(&Chip::blank());
    let mut told = Vec::new();
    for number in 0..130u8 {
        robot.change(|config| config.heater.target_c = 20.0 + f32::from(number) * 0.1);
        for _ in 0..600 {
            let (erases, state) = (robot.chip.erases(), robot.status().state);
            robot.step();
            if robot.chip.erases() > erases {
                told.push(state);
            }
        }
    }
    assert!(told.len() >= 2, "{told:?}");
    assert!(told.iter().all(|state| *state == ParamState::Erasing));
}
