//! Flash is not written while armed; the cost of a save at rest.

use robot_plant::time::{MS, Ps, SECOND};
use robot_sim::machine::flash::{FlashStepKind, FlashTimes};

use crate::{
    cells::run_all,
    flash_image::{Image, Stored, newest},
    robot::{Robot, has_image_for, state},
    settings::{Make, image},
};

/// By this time calibration and set-up of the motors are over.
const READY: Ps = 2_400 * MS;
const TRACK: (u8, u8) = (1, 1);
const MAKES: [Make; 2] = [Make::Dm4310, Make::Rs00];

/// The next save begins another sector, after which the oldest one has to be erased.
pub fn before_a_rotation(make: Make) -> Image {
    let old = Stored::of(1, &[0.3, 0.3, 30.0, 1.0, 1.0]);
    let full = image(make, 127).erased(2).headed(2, 6);
    full.record(2, 1, (1, 0), &old)
}

struct Drive {
    robot: Robot,
    /// Flash steps before arming.
    steps_before: usize,
}

/// Armed 300 ms after a change, if there is one, and driven for six seconds.
fn drive(make: Make, change: bool) -> Drive {
    let mut robot = Robot::with_flash(make, &before_a_rotation(make));
    robot.until(READY);
    if change {
        robot.set(TRACK, 0.44);
    }
    robot.until(READY + 300 * MS);
    let steps_before = robot.machine.flash_steps().len();
    robot.enable(true);
    robot.wait(500 * MS, Robot::armed).expect("it arms");
    robot.stick(0.3);
    robot.run_for(6 * SECOND);
    assert!(robot.armed());
    Drive {
        robot,
        steps_before,
    }
}

#[test]
fn a_save_waits_until_an_armed_robot_is_at_rest() {
    let makes: Vec<Make> = MAKES
        .into_iter()
        .filter(|make| has_image_for(*make))
        .collect();
    let cells: Vec<(Make, bool)> = makes
        .iter()
        .flat_map(|make| [true, false].map(|change| (*make, change)))
        .collect();
    let gaps = run_all(&cells, |(make, change)| {
        let Drive {
            mut robot,
            steps_before,
        } = drive(*make, *change);
        assert_eq!(
            robot.machine.flash_steps().len(),
            steps_before,
            "{make:?}: none begins"
        );
        let gap = robot.machine.stats().longest_gap_us.armed;
        if *change {
            assert_eq!(robot.diag("params.state"), Some(state::WAITING_FOR_REST));
            saved_once_at_rest(&mut robot, *make);
        }
        gap
    });
    for (n, make) in makes.iter().enumerate() {
        let [with, without] = [gaps[2 * n], gaps[2 * n + 1]];
        println!(
            "{make:?}: longest tick gap while armed {with:.2} us, {without:.2} us with nothing to save"
        );
        assert!(
            with <= without + 1.0,
            "a save that waits costs an armed robot nothing"
        );
    }
}

fn saved_once_at_rest(robot: &mut Robot, make: Make) {
    robot.stick(0.0);
    robot.run_for(SECOND);
    let disarmed = robot.now();
    robot.enable(false);
    robot
        .wait(3 * SECOND, |robot| robot.is_saved(1) && robot.is_tidy())
        .expect("at rest it is saved");
    let first = robot.machine.flash_steps()[0];
    println!(
        "{make:?}: first flash step {} ms after the switch went off",
        (first.at - disarmed) / MS
    );
    assert!(
        first.at > disarmed + 500 * MS,
        "{make:?}: the motors come to rest first"
    );
    let stored = newest(&robot.machine.parameter_flash());
    assert_eq!(stored[&(1, 0)].values[1], 0.44_f32.to_bits());
}

/// Interval at which the test looks whether the robot is armed. A record that was written just before arming is allowed.
const LOOK: Ps = MS / 20;

/// Times from the change to the switch: around the end of the 500 ms, in the middle of the records' move to another
/// sector, and right before the erase.
fn arm_into_a_save(after: Ps) -> Vec<String> {
    let mut robot = Robot::with_flash(Make::Dm4310, &before_a_rotation(Make::Dm4310));
    robot.until(READY);
    robot.set(TRACK, 0.44);
    robot.until(READY + after);
    robot.enable(true);
    let mut wrong = Vec::new();
    let mut demand = |holds: bool, what: &str| {
        if !holds {
            wrong.push(format!("{} ms after the change: {what}", after / MS));
        }
    };
    let armed_in_time = (0..2_000).any(|_| {
        robot.run_for(LOOK);
        robot.armed()
    });
    demand(armed_in_time, "it never arms");
    let armed = robot.now();
    robot.run_for(400 * MS);
    demand(robot.armed(), "it does not stay armed");
    let steps = robot.machine.flash_steps();
    let begun = steps.iter().filter(|step| step.at > armed - LOOK).count();
    demand(begun == 0, "a flash step began while it was armed");
    robot.enable(false);
    let saved = robot.wait(4 * SECOND, |robot| robot.is_saved(1) && robot.is_tidy());
    demand(saved.is_some(), "the change is never saved");
    demand(robot.machine.resets() == 0, "it was reset");
    let stored = newest(&robot.machine.parameter_flash());
    demand(
        stored[&(1, 0)].values[1] == 0.44_f32.to_bits(),
        "flash holds something else",
    );
    wrong
}

#[test]
fn no_flash_step_begins_while_armed_whenever_the_pilot_arms() {
    let moments: Vec<Ps> = (0..32).map(|n| 470 * MS + n * 4 * MS).collect();
    let wrong = run_all(&moments, |after| arm_into_a_save(*after)).concat();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

struct Cost {
    append_gap_us: f64,
    append_words: usize,
    erase_gap_us: f64,
    erase_stall_us: u64,
}

fn cost(times: FlashTimes) -> Cost {
    let mut robot = Robot::with_flash(Make::Dm4310, &image(Make::Dm4310, 20));
    robot.machine.set_flash_times(times);
    robot.until(SECOND);
    // A record of 12 values, of 15 settings at most.
    robot.set((5, 0), 0.5);
    robot
        .wait(2 * SECOND, |robot| robot.is_saved(1))
        .expect("it is saved");
    let append_words = robot.machine.flash_steps().len();
    let append_gap_us = robot.machine.stats().longest_gap_us.disarmed;

    let mut robot = Robot::with_flash(Make::Dm4310, &before_a_rotation(Make::Dm4310));
    robot.machine.set_flash_times(times);
    robot.until(SECOND);
    robot.set(TRACK, 0.44);
    robot
        .wait(3 * SECOND, |robot| robot.is_saved(1) && robot.is_tidy())
        .expect("it is saved, and the old sector erased");
    robot.run_for(100 * MS);
    let erases = robot.machine.flash_steps().iter();
    assert_eq!(
        erases
            .filter(|step| step.kind == FlashStepKind::Erase)
            .count(),
        1
    );
    let stats = robot.machine.stats();
    assert_eq!(stats.missed, 0, "a stall is no missed tick");
    Cost {
        append_gap_us,
        append_words,
        erase_gap_us: stats.longest_gap_us.disarmed,
        erase_stall_us: stats.flash.longest_stall_us,
    }
}

#[test]
fn what_a_save_costs_a_robot_at_rest() {
    let times = [FlashTimes::Typical, FlashTimes::Max];
    let limits = [(1_700.0, 250_000), (4_500.0, 500_000)];
    let costs = run_all(&times, |times| cost(*times));
    for ((times, cost), (append_us, erase_us)) in times.iter().zip(&costs).zip(limits) {
        println!(
            "{times:?}: longest tick gap {:.0} us by an append of {} words, {:.0} us by an erase of {} us",
            cost.append_gap_us, cost.append_words, cost.erase_gap_us, cost.erase_stall_us
        );
        assert_eq!(cost.erase_stall_us, erase_us);
        assert!(cost.append_gap_us <= append_us, "{}", cost.append_gap_us);
        let around_us = cost.erase_gap_us - erase_us as f64;
        assert!(
            (0.0..5_000.0).contains(&around_us),
            "{around_us} us around the erase"
        );
    }
}
