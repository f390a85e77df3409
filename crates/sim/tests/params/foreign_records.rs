//! Records of another firmware and of other motors: kept bit for bit, never applied.

use robot_plant::time::{MS, SECOND};

use crate::{
    flash_image::{Id, Image, Stored, newest},
    robot::{Robot, has_image_for},
    settings::{Make, calibrated, image},
};

/// A group of the future, a later version of a group of today, one that no firmware knows, with every bit set.
fn foreign() -> [(Id, Stored); 3] {
    let pattern = |count: u32| (0..count).map(|n| n.wrapping_mul(0x9E37_79B9)).collect();
    [
        (
            (41, 0),
            Stored {
                version: 3,
                values: pattern(28),
            },
        ),
        (
            (3, 0),
            Stored {
                version: 3,
                values: pattern(7),
            },
        ),
        (
            (255, 255),
            Stored {
                version: 255,
                values: vec![u32::MAX; 5],
            },
        ),
    ]
}

fn with_foreign(make: Make, used: usize) -> Image {
    let slots = used + 1..;
    slots
        .zip(foreign())
        .fold(image(make, used), |image, (slot, (id, stored))| {
            image.record(0, slot, id, &stored)
        })
}

/// Saves by the robot, one after the other.
fn save(robot: &mut Robot, track_m: impl IntoIterator<Item = f32>) {
    for (value, changes) in track_m.into_iter().zip(1..) {
        robot.set((1, 1), value);
        robot
            .wait(3 * SECOND, |robot| robot.is_saved(changes))
            .expect("it is saved");
    }
}

#[test]
fn records_of_a_later_firmware_survive_saves_and_a_change_of_sectors() {
    let mut robot = Robot::with_flash(Make::Dm4310, &with_foreign(Make::Dm4310, 123));
    robot.run_for(SECOND);
    let calibrated = calibrated();
    let settings = robot.settings();
    assert_ne!(
        settings[&(3, 0)],
        calibrated[&(3, 0)],
        "the defaults of a group of a later version"
    );
    assert_eq!(settings[&(2, 0)], calibrated[&(2, 0)]);
    assert_eq!(robot.diag("params.foreign"), Some(2.0));
    assert_eq!(robot.diag("params.refused"), Some(f64::from(1 << 2)));

    save(&mut robot, [0.5, 0.51, 0.52]);
    robot.machine.cut_power(5 * MS);
    robot.run_for(SECOND);
    assert_eq!(
        robot.diag("params.generation"),
        Some(8.0),
        "it began another sector"
    );
    let stored = newest(&robot.machine.parameter_flash());
    for (id, record) in foreign() {
        assert_eq!(stored.get(&id), Some(&record), "{id:?}");
    }

    // A change of the group replaces its record.
    robot.set((3, 0), 19.0);
    robot
        .wait(3 * SECOND, |robot| robot.is_saved(1))
        .expect("it is saved");
    let stored = newest(&robot.machine.parameter_flash());
    assert_eq!(stored[&(3, 0)].version, 2);
    assert_eq!(stored[&(3, 0)].values[0], 19.0_f32.to_bits());
    assert_eq!(stored[&(41, 0)], foreign()[0].1);
}

#[test]
fn each_make_of_motor_has_joint_settings_of_its_own() {
    if !has_image_for(Make::Rs00) {
        println!("skipped: ROBOT_ELF_DBUS_RS00 names no image");
        return;
    }
    let mut of_rs00 = Robot::with_flash(Make::Rs00, &Image::blank().clean(0).clean(1));
    of_rs00.run_for(100 * MS);
    let defaults = of_rs00.settings();

    let mut robot = Robot::with_flash(Make::Rs00, &image(Make::Dm4310, 125));
    robot.run_for(SECOND);
    let settings = robot.settings();
    for (setting, bits) in calibrated() {
        let expected = if setting.0 < 16 {
            bits
        } else {
            defaults[&setting]
        };
        assert_eq!(settings[&setting], expected, "{setting:?}");
    }
    assert_eq!(robot.diag("params.foreign"), Some(4.0));
    // Two records fill the sector, the third begins the next one.
    for (setting, value, changes) in [((16, 1), -0.5, 1), ((17, 1), 0.75, 2), ((18, 1), 1.0, 3)] {
        robot.set(setting, value);
        robot
            .wait(3 * SECOND, |robot| robot.is_saved(changes))
            .expect("it is saved");
    }
    let dump = robot.machine.parameter_flash();
    let stored = newest(&dump);
    assert_eq!(stored[&(16, 2)].values[1], (-0.5_f32).to_bits());
    assert_eq!(robot.diag("params.generation"), Some(8.0));

    let mut back = Robot::with_flash(Make::Dm4310, &Image::of(&dump));
    back.run_for(100 * MS);
    assert_eq!(
        back.settings(),
        calibrated(),
        "the first motors find theirs"
    );
    let mut again = Robot::with_flash(Make::Rs00, &Image::of(&dump));
    again.run_for(100 * MS);
    let settings = again.settings();
    assert_eq!(settings[&(17, 1)], 0.75_f32.to_bits());
    assert_eq!(settings[&(18, 1)], 1.0_f32.to_bits());
}
