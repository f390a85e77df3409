//! Flipped bits, sectors of garbage, random contents: the robot boots, uses what is good, and saves again.

use robot_plant::time::{MS, SECOND};
use robot_test_support::Random;

use crate::{
    at_rest_only::before_a_rotation,
    cells::run_all,
    flash_image::{Image, SECTOR_BYTES, SLOT_BYTES, SectorState, newest, sectors},
    robot::Robot,
    settings::{GROUPS, Make, Settings, image, in_flash},
};

struct Damaged {
    what: String,
    flash: Image,
}

/// Flips one bit in each word of the newest copy of a record, and in each word of the head.
fn flips() -> Vec<Damaged> {
    let start = image(Make::Dm4310, 60);
    let slot_of_group_4 = 60 - GROUPS + 4;
    let places = |slot: usize| {
        (0..SLOT_BYTES)
            .step_by(4)
            .map(move |at| slot * SLOT_BYTES + at)
    };
    let mut noise = Random::new(7);
    places(0)
        .chain(places(slot_of_group_4))
        .map(|word| {
            let (place, bit) = (word + noise.below(4), noise.byte() % 8);
            Damaged {
                what: format!("bit {bit} of byte {place:#x} flipped"),
                flash: start.clone().flipped(place, bit),
            }
        })
        .collect()
}

/// Every choice of one, two or three sectors; of an image in which sector 0 is active and sector 2 the backup.
fn garbage() -> Vec<Damaged> {
    let sectors_of = |choice: u8| (0..3).filter(move |sector| choice >> sector & 1 == 1);
    (1..8)
        .map(|choice| {
            let mut noise = Random::new(choice.into());
            let start = before_a_rotation(Make::Dm4310);
            let flash = sectors_of(choice).fold(start, |image, sector| {
                image.garbage(sector, || noise.byte())
            });
            let sectors: Vec<_> = sectors_of(choice).collect();
            Damaged {
                what: format!("garbage in sectors {sectors:?}"),
                flash,
            }
        })
        .collect()
}

/// Heads without records, records without a head, half-blank sectors, all zeros.
fn strange() -> Vec<Damaged> {
    let mut noise = Random::new(99);
    let full = image(Make::Dm4310, 127);
    let mut sparse = Random::new(3);
    let named = |what: &str, flash: Image| Damaged {
        what: what.to_owned(),
        flash,
    };
    let equal = full.clone().erased(1).headed(1, 7);
    vec![
        named("a new chip", Image::blank()),
        named(
            "all zero",
            (0..3).fold(Image::blank(), |image, sector| image.garbage(sector, || 0)),
        ),
        named(
            "a head over noise",
            Image::blank().garbage(0, || noise.byte()).headed(0, 3),
        ),
        named(
            "no head over a full sector",
            full.clone().garbage_head(0, || 0x3C),
        ),
        named(
            "a high generation",
            Image::blank().headed(0, 0xFFFF_0000).clean(1).clean(2),
        ),
        named("two sectors of one generation", equal),
        named(
            "one bit in a hundred cleared",
            Image::of(&full.bytes().map(|byte| {
                if sparse.below(12) == 0 {
                    byte & !(1 << (sparse.byte() % 8))
                } else {
                    byte
                }
            })),
        ),
    ]
}

fn run(damaged: &Damaged, defaults: &Settings) -> Vec<String> {
    let Damaged { what, flash } = damaged;
    let mut robot = Robot::with_flash(Make::Dm4310, flash);
    let mut wrong = Vec::new();
    let mut demand = |holds: bool, why: String| {
        if !holds {
            wrong.push(format!("{what}: {why}"));
        }
    };
    let booted = robot.wait(SECOND, |robot| robot.diag("ts_us").is_some());
    demand(booted.is_some(), "it does not boot".into());
    robot.run_for(20 * MS);
    let mut expected = defaults.clone();
    let good = in_flash(&newest(flash.bytes()), Make::Dm4310);
    let groups: std::collections::BTreeSet<u8> = good.keys().map(|(group, _)| *group).collect();
    expected.extend(good);
    demand(
        robot.settings() == expected,
        "it does not use exactly what is good".into(),
    );

    let loaded = robot
        .diag("params.loaded")
        .map(|mask| (mask as u32).count_ones() as usize);
    demand(
        loaded == Some(groups.len()),
        format!("{loaded:?} of {} groups loaded", groups.len()),
    );
    let active = sectors(flash.bytes())
        .into_iter()
        .max_by_key(|sector| match sector.state {
            SectorState::Headed { generation } => i64::from(generation),
            _ => -1,
        });
    let damaged = active.filter(|sector| matches!(sector.state, SectorState::Headed { .. }));
    let damaged = damaged.map_or(0, |sector| sector.damaged) as f64;
    let reported = robot.diag("params.damaged");
    demand(
        reported == Some(damaged),
        format!("{reported:?} of {damaged} damaged places reported"),
    );

    robot.set((1, 1), 0.47);
    expected.insert((1, 1), 0.47_f32.to_bits());
    let saved = robot.wait(4 * SECOND, |robot| robot.is_saved(1));
    demand(saved.is_some(), "the next save is never done".into());
    robot.machine.cut_power(5 * MS);
    robot.run_for(25 * MS);
    demand(
        robot.settings() == expected,
        "the next boot finds something else".into(),
    );
    demand(
        robot.board_errors().is_empty(),
        format!("{:?}", robot.board_errors()),
    );
    wrong
}

#[test]
fn a_damaged_store_boots_and_saves_again() {
    let mut fresh = Robot::with_flash(Make::Dm4310, &Image::blank().clean(0).clean(1).clean(2));
    fresh.run_for(100 * MS);
    let defaults = fresh.settings();
    let stores: Vec<Damaged> = [flips(), garbage(), strange()]
        .into_iter()
        .flatten()
        .collect();
    println!(
        "{} damaged stores of {} bytes a sector",
        stores.len(),
        SECTOR_BYTES
    );
    let wrong = run_all(&stores, |store| run(store, &defaults)).concat();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
