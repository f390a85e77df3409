//! The pilot wants to drive while a sector is being erased, and other things that happen in that time.

use robot_plant::time::{MS, Ps, SECOND, US};
use robot_sim::machine::flash::{FlashStepKind, FlashTimes};

use crate::{
    at_rest_only::before_a_rotation,
    cells::run_all,
    robot::{Robot, has_image_for},
    settings::Make,
};

/// By this time calibration and set-up of the motors are over.
const READY: Ps = 2_400 * MS;
const FLASH_BUSY: &str = "flash-busy";
const REMOTE_NOT_FRESH: &str = "remote-not-fresh";
const SILENT: &str = "sbus-silent";
/// Time until a silent radio must stop the robot: the firmware's own limit is 100 ms.
const REMOTE_TIMEOUT: Ps = 100 * MS;

/// The tick's release jitter may be this large when no flash step delays it.
const JITTER_US: u32 = 5;

/// Time in which the chip stands still while it programs a word: 16 µs, at most 100 (STM32F407 datasheet, flash memory programming). A
/// tick that is due in it comes that much late.
fn word_us(times: FlashTimes) -> u32 {
    match times {
        FlashTimes::Typical => 16,
        FlashTimes::Max => 100,
    }
}

/// A robot whose erase began within the last millisecond, and the end of the erase.
fn erasing(make: Make, times: FlashTimes) -> (Robot, Ps) {
    let mut robot = Robot::with_flash(make, &before_a_rotation(make));
    robot.machine.set_flash_times(times);
    robot.until(READY);
    robot.set((1, 1), 0.44);
    let erase = |robot: &mut Robot| {
        let mut steps = robot.machine.flash_steps().iter();
        steps
            .find(|step| step.kind == FlashStepKind::Erase)
            .map(|step| step.at)
    };
    robot
        .wait(2 * SECOND, |robot| erase(robot).is_some())
        .expect("it erases the oldest sector");
    let lasts = match times {
        FlashTimes::Typical => 250 * MS,
        FlashTimes::Max => 500 * MS,
    };
    let ends = erase(&mut robot).expect("it was seen") + lasts;
    (robot, ends)
}

/// Lag of the image's clock behind the emulated time.
fn lag(robot: &mut Robot) -> Ps {
    let lags = (0..20).map(|_| {
        robot.step();
        let image = robot.diag("ts_us").expect("it runs") as Ps * US;
        robot.now().saturating_sub(image)
    });
    lags.min().expect("there are some")
}

fn clean_after(robot: &mut Robot, cell: &Cell, lag_before: Ps) -> Vec<String> {
    let Cell { make, times, .. } = *cell;
    let mut wrong = Vec::new();
    let mut demand = |holds: bool, what: String| {
        if !holds {
            wrong.push(format!("{make:?}: {what}"));
        }
    };
    let lag = lag(robot);
    println!(
        "{make:?}: the image's clock moved by {} us against the emulated one",
        lag.abs_diff(lag_before) / US
    );
    demand(
        lag.abs_diff(lag_before) <= MS,
        format!("its clock lost {} us", lag.abs_diff(lag_before) / US),
    );
    demand(robot.machine.resets() == 0, "it was reset".into());
    let stats = robot.machine.stats();
    demand(stats.missed == 0, format!("{} missed ticks", stats.missed));
    for (name, wanted) in [("tick.missed", 0.0), ("tick.stalls", 1.0)] {
        let value = robot.diag(name);
        demand(value == Some(wanted), format!("{name} = {value:?}"));
    }
    let jitter_us = robot.diag("tick.max_jitter_us");
    let most_us = f64::from(word_us(times) + JITTER_US);
    demand(jitter_us <= Some(most_us), format!("jitter {jitter_us:?}"));
    let flags = robot.names_in("safety.flags");
    demand(flags.is_empty(), format!("flags {flags:?}"));
    let errors = robot.board_errors();
    demand(errors.is_empty(), format!("board errors {errors:?}"));
    wrong
}

struct Cell {
    make: Make,
    times: FlashTimes,
    /// Time since the erase began.
    asked: Ps,
}

fn arm(cell: &Cell) -> Vec<String> {
    let Cell { make, times, asked } = *cell;
    let mut undisturbed = Robot::with_flash(make, &before_a_rotation(make));
    undisturbed.until(READY);
    let lag_before = lag(&mut undisturbed);
    let (mut robot, ends) = erasing(make, times);
    let began = robot.now();
    robot.until(began + asked);
    robot.enable(true);
    let mut busy_seen = false;
    let armed = robot.wait(2 * SECOND, |robot| {
        busy_seen |= robot
            .names_in("arming.blockers")
            .iter()
            .any(|name| name == FLASH_BUSY);
        robot.armed()
    });
    let mut wrong = Vec::new();
    match armed {
        None => wrong.push(format!(
            "{make:?}: it never arms: {:?}",
            robot.names_in("arming.blockers")
        )),
        Some(_) if robot.now() < ends => wrong.push(format!("{make:?}: armed during the erase")),
        Some(_) => println!(
            "{make:?}, {times:?}, asked {} ms into the erase: armed {} ms after its end",
            asked / MS,
            (robot.now() - ends) / MS
        ),
    }
    if !busy_seen {
        wrong.push(format!("{make:?}: nothing says why arming waits"));
    }
    robot.stick(0.3);
    robot.run_for(500 * MS);
    if !robot.drives() {
        wrong.push(format!("{make:?}: the wheels do not turn"));
    }
    wrong.extend(clean_after(&mut robot, cell, lag_before));
    wrong
}

#[test]
fn arming_waits_for_the_erase_and_then_happens() {
    let makes = [Make::Dm4310, Make::Rs00];
    let makes = makes.into_iter().filter(|make| has_image_for(*make));
    let cells: Vec<Cell> = makes
        .flat_map(|make| {
            [
                (FlashTimes::Typical, 20 * MS),
                (FlashTimes::Typical, 150 * MS),
                (FlashTimes::Typical, 240 * MS),
                (FlashTimes::Max, 300 * MS),
            ]
            .map(|(times, asked)| Cell { make, times, asked })
        })
        .collect();
    let wrong = run_all(&cells, arm).concat();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// The radio goes silent during the erase. Frames from before must not count as fresh afterwards.
#[test]
fn a_radio_that_dies_during_an_erase_is_missed_in_time() {
    let makes = [Make::Dm4310, Make::Rs00];
    let makes = makes.into_iter().filter(|make| has_image_for(*make));
    let cells: Vec<(Make, Ps)> = makes
        .flat_map(|make| [10 * MS, 100 * MS, 200 * MS, 240 * MS].map(|dies| (make, dies)))
        .collect();
    let wrong = run_all(&cells, |(make, dies)| {
        let (mut robot, ends) = erasing(*make, FlashTimes::Typical);
        let began = robot.now();
        // The pilot asked for arming just before.
        robot.until(began + dies - 8 * MS);
        robot.enable(true);
        robot.until(began + dies);
        robot.fault(SILENT, true);
        let dead = robot.now();
        robot.until(ends);
        let stale = |robot: &mut Robot| {
            let blockers = robot.names_in("arming.blockers");
            blockers.iter().any(|name| name == REMOTE_NOT_FRESH)
        };
        robot.wait(SECOND, |robot| {
            robot.diag("ts_us") > Some((ends / US) as f64) && stale(robot)
        });
        let missed = robot.now();
        println!(
            "{make:?}: radio silent {} ms into the erase, missed {} ms later, {} ms after the end",
            dies / MS,
            (missed - dead) / MS,
            (missed - ends) / MS
        );
        // A frame may have been on its way for as long as it takes.
        let due = (dead + REMOTE_TIMEOUT).max(ends) + 20 * MS;
        let mut wrong = Vec::new();
        if missed > due {
            wrong.push(format!(
                "{make:?}, {} ms: missed {} ms late",
                dies / MS,
                (missed - due) / MS
            ));
        }
        robot.run_for(SECOND);
        if robot.armed() {
            wrong.push(format!("{make:?}: armed without a radio"));
        }
        robot.fault(SILENT, false);
        robot.enable(false);
        robot.run_for(500 * MS);
        robot.enable(true);
        if robot.wait(SECOND, Robot::armed).is_none() {
            let why = robot.names_in("arming.blockers");
            wrong.push(format!(
                "{make:?}: it does not arm when the radio is back: {why:?}"
            ));
        }
        wrong
    })
    .concat();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
