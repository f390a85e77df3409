//! The settings of the robot as `docs/tuning.md` numbers them, and a set of values that differ from all defaults.

use std::collections::BTreeMap;

use crate::flash_image::{Id, Image, LAST_SLOT, Stored};

/// Group and index.
pub type Setting = (u8, u8);

/// Bits of the `f32` of every setting.
pub type Settings = BTreeMap<Setting, u32>;

/// Number of settings in all groups.
pub const COUNT: usize = 140;

/// Number of groups; each is a record.
pub const GROUPS: usize = CALIBRATED.len();

/// Groups from here on are joints and belong to a make of motor.
const FIRST_JOINT: u8 = 16;

/// The variant of a joint's record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Make {
    Dm4310 = 1,
    Rs00 = 2,
}

const JOINT: [f32; 8] = [1.0, 0.25, -1.25, 1.25, 3.0, 8.0, 90.0, 2.0];

const TRAVEL: [f32; 21] = [
    182.0, 990.0, 1801.0, 182.0, 993.0, 1801.0, 182.0, 992.0, 1801.0, 182.0, 992.0, 1801.0, 182.0,
    992.0, 1801.0, 182.0, 992.0, 1801.0, 182.0, 992.0, 1801.0,
];

/// Allowed values with which the robot drives. They differ from the defaults, except for directions and settings that
/// the pilot needs.
#[rustfmt::skip] // One line a group.
const CALIBRATED: [(u8, &[f32]); 15] = [
    (1, &[0.07, 0.45, 17.5, 1.0, -1.0]),
    (2, &[1.25, 3.5, 50_000.0, 7_000.0, 900.0, 40_000.0]),
    (3, &[18.0, 0.75, 1.0]),
    (4, &[120_000.0, 0.4, 20_000.0, 40_000.0, 25.0, 30.0, 0.07, 2_500_000.0, 40_000.0, 0.8, 80.0, 85.0, 20.5, 18.5, 1_500_000.0, 0.0, 150_000.0, 3_000_000.0, 0.65, 30_000.0]),
    (5, &[0.1, -0.2, 0.15, 1.01, 0.99, 1.02, 0.5, -0.25, 0.75, 1.005, 0.995, 1.015]),
    (6, &[12.0, -20.0, 7.0, 1.1, 0.9, 1.05, 0.05, -0.02, 0.03]),
    (7, &[42.0, 0.25, 0.02, 0.9]),
    (8, &[4.0, 9.0]),
    (9, &[0.0, 1.0, 7.0, 8.0, 4.0, 5.0, 6.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 9.0, 10.0, 11.0, 12.0, 0.0, 1.0, 1.0, 1.0]),
    (10, &TRAVEL),
    (11, &[2_500_000.0, 6.0, 12.0, 9_000.0]),
    (16, &JOINT),
    (17, &JOINT),
    (18, &JOINT),
    (19, &JOINT),
];

/// Every setting with the values above.
pub fn calibrated() -> Settings {
    let groups = CALIBRATED.into_iter();
    groups
        .flat_map(|(group, values)| {
            let indices = (0..).zip(values);
            indices.map(move |(index, value)| ((group, index), value.to_bits()))
        })
        .collect()
}

/// Records with the values above, in the order of the groups.
pub fn records(make: Make) -> Vec<(Id, Stored)> {
    let groups = CALIBRATED.into_iter();
    groups
        .map(|(group, values)| (id(group, make), Stored::of(version(group), values)))
        .collect()
}

/// The settings that these records hold for a robot with motors of this make.
pub fn in_flash(stored: &BTreeMap<Id, Stored>, make: Make) -> Settings {
    let found = CALIBRATED.into_iter().filter_map(|(group, _)| {
        let stored = stored.get(&id(group, make))?;
        Some((group, stored))
    });
    found
        .flat_map(|(group, stored)| {
            let indices = (0..).zip(&stored.values);
            indices.map(move |(index, bits)| ((group, index), *bits))
        })
        .collect()
}

/// Group, version and variant of a record of this group.
pub fn id(group: u8, make: Make) -> Id {
    (group, variant(group, make))
}

/// Version of the group's record.
fn version(group: u8) -> u8 {
    match group {
        3 | 9 => 2,
        4 => 4,
        _ => 1,
    }
}

fn variant(group: u8, make: Make) -> u8 {
    if group < FIRST_JOINT { 0 } else { make as u8 }
}

/// The flash of a robot in use. Everything is in sector 0, of generation 7; the other sectors are clean. The slots before
/// the newest copies, up to `used`, hold older ones.
pub fn image(make: Make, used: usize) -> Image {
    let records = records(make);
    assert!((records.len()..=LAST_SLOT).contains(&used));
    let old = Stored::of(1, &[0.25, 0.25, 20.0, 1.0, 1.0]);
    let older = used - records.len();
    let image = Image::blank().headed(0, 7).clean(1).clean(2);
    let image = (1..=older).fold(image, |image, slot| image.record(0, slot, (1, 0), &old));
    let newest = (older + 1..).zip(&records);
    newest.fold(image, |image, (slot, (id, stored))| {
        image.record(0, slot, *id, stored)
    })
}

#[test]
fn the_calibrated_set_is_complete() {
    assert_eq!(calibrated().len(), COUNT);
}
