//! Power cuts before, in and after steps of the flash, and second cuts in the recovery.

use std::fmt;

use robot_plant::{
    flash_chip::Phase,
    time::{MS, Ps, SECOND},
};
use robot_test_support::is_whole;

use crate::{
    cells::run_all,
    flash_image::{Image, Stored, newest},
    robot::Robot,
    settings::{Make, Setting, Settings, calibrated, image, in_flash},
};

const PHASES: [Phase; 3] = [Phase::Before, Phase::Middle, Phase::After];
/// Changes that the user makes together. Each is saved as its own record.
const CHANGES: [(Setting, f32); 3] = [((2, 0), 1.125), ((4, 0), 90_000.0), ((7, 0), 43.5)];
/// The change that is saved after the cuts.
const NEXT: (Setting, f32) = ((5, 3), 1.03);
const FOREIGN: [((u8, u8), u8); 2] = [((16, 2), 1), ((77, 3), 9)];
const OFF_TIME: Ps = 5 * MS;
const RUNS: usize = 160;
const TIMEOUT: Ps = 4 * SECOND;

/// The work that the cut interrupts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Work {
    /// The sector's last slot, the move to the next sector, two more records, and the erase of the oldest sector.
    Save,
    /// The erase after boot of a robot whose last erase was cut.
    Erase,
}

#[derive(Clone, Copy)]
struct Cell {
    work: Work,
    step: usize,
    phase: Phase,
    /// Flash steps from the first cut to the second.
    second: Option<(usize, Phase)>,
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}, step {} {:?}", self.work, self.step, self.phase)?;
        match self.second {
            Some((step, phase)) => write!(f, ", then {step} later {phase:?}"),
            None => Ok(()),
        }
    }
}

#[derive(Debug, Default)]
struct Seen {
    cuts: usize,
    wrong: Vec<String>,
}

fn start(work: Work) -> Image {
    let full = image(Make::Dm4310, 124);
    let foreign = FOREIGN.into_iter().zip(125..);
    let full = foreign.fold(full, |image, ((id, version), slot)| {
        image.record(0, slot, id, &foreign_record(id, version))
    });
    let old = Stored::of(1, &[0.3, 0.3, 30.0, 1.0, 1.0]);
    match work {
        Work::Save => full.erased(2).headed(2, 6).record(2, 1, (1, 0), &old),
        Work::Erase => {
            let full = full.garbage(1, || 0x5A).erased(2).headed(2, 6);
            full.record(2, 1, (1, 0), &old)
        }
    }
}

fn foreign_record((key, variant): (u8, u8), version: u8) -> Stored {
    let noise = (1..=20_u32).map(|n| n.wrapping_mul(0x9E37_79B9) ^ u32::from(key ^ variant));
    Stored {
        version,
        values: noise.collect(),
    }
}

/// Figures of the work without a cut.
fn steps(work: Work) -> usize {
    let mut robot = Robot::with_flash(Make::Dm4310, &start(work));
    do_work(&mut robot, work, &mut Vec::new(), |_| false);
    robot.machine.flash_steps().len()
}

/// Works until all is done or `cut` returns true. `acknowledged` collects the changes that the robot reported as saved.
fn do_work(
    robot: &mut Robot,
    work: Work,
    acknowledged: &mut Vec<Setting>,
    cut: impl Fn(&Robot) -> bool,
) {
    robot.wait(SECOND, |robot| cut(robot) || robot.diag("ts_us").is_some());
    if work == Work::Save && !cut(robot) {
        for (setting, value) in CHANGES {
            robot.ask_to_set(setting, value);
            robot.run_for(5 * MS);
        }
    }
    robot.wait(TIMEOUT, |robot| {
        if cut(robot) {
            return true;
        }
        let (Some(seen), Some(unsaved)) = (robot.diag("params.seen"), robot.diag("params.unsaved"))
        else {
            return false;
        };
        if work == Work::Erase {
            return robot.is_tidy();
        }
        if seen < CHANGES.len() as f64 {
            return false;
        }
        for (setting, _) in CHANGES {
            let bit = 1 << position(setting.0);
            if unsaved as u32 & bit == 0 && !acknowledged.contains(&setting) {
                acknowledged.push(setting);
            }
        }
        unsaved == 0.0 && robot.is_tidy()
    });
}

/// The bit of a group in `diag.params.unsaved`.
fn position(group: u8) -> u8 {
    if group < 16 {
        group - 1
    } else {
        group - 16 + 11
    }
}

fn run(cell: &Cell) -> Seen {
    let mut robot = Robot::with_flash(Make::Dm4310, &start(cell.work));
    let seed = (cell.step * 31 + cell.phase as usize) as u64;
    robot.machine.set_off_time(OFF_TIME);
    robot
        .machine
        .cut_power_at_flash_step(cell.step, cell.phase, seed);
    let mut acknowledged = Vec::new();
    do_work(&mut robot, cell.work, &mut acknowledged, |robot| {
        robot.machine.resets() > 0
    });
    let mut seen = Seen::default();
    if robot.machine.resets() == 0
        && robot
            .wait(TIMEOUT, |robot| robot.machine.resets() > 0)
            .is_none()
    {
        seen.wrong.push("the power was never cut".into());
        return seen;
    }
    let mut known = expected(cell.work, &acknowledged);
    if let Some((later, phase)) = cell.second {
        let step = robot.machine.flash_steps().len() + later;
        robot.machine.cut_power_at_flash_step(step, phase, seed + 1);
        // The next save is interrupted by the cut, and may or may not be complete.
        robot.run_for(20 * MS);
        if robot.machine.resets() == 1 {
            known.look(&mut robot, &mut seen, "after the first cut");
        }
        if robot.machine.resets() == 1 {
            robot.ask_to_set(NEXT.0, NEXT.1);
            known.allow(NEXT);
            robot.wait(2 * SECOND, |robot| {
                robot.machine.resets() > 1 || (robot.is_saved(1) && robot.is_tidy())
            });
        }
        robot.run_for(OFF_TIME + 2 * MS);
        // If there was no such step.
        robot.machine.cut_power_at_flash_step(usize::MAX, phase, 0);
    }
    seen.cuts = robot.machine.resets();
    known.look(&mut robot, &mut seen, "after the cuts");
    next_save(&mut robot, &mut known, &mut seen);
    seen.wrong.extend(robot.board_errors());
    seen
}

fn next_save(robot: &mut Robot, known: &mut Known, seen: &mut Seen) {
    let (setting, value) = ((5, 6), 0.625);
    let changes = robot.diag("tuning.revision").unwrap_or(0.0) as usize;
    robot.set(setting, value);
    let saved = robot.wait(TIMEOUT, |robot| robot.is_saved(changes + 1));
    if saved.is_none() {
        seen.wrong.push("the next save was never done".into());
    }
    known.must_be(setting, value);
    robot.machine.cut_power(OFF_TIME);
    robot.run_for(OFF_TIME + 20 * MS);
    known.look(robot, seen, "after the next save");
    let stored = newest(&robot.machine.parameter_flash());
    for (id, version) in FOREIGN {
        if stored.get(&id) != Some(&foreign_record(id, version)) {
            seen.wrong
                .push(format!("the foreign record {id:?} is gone"));
        }
    }
}

/// The values that each setting may have.
struct Known {
    settings: Settings,
    /// Another value that it may have.
    or: Settings,
}

fn expected(work: Work, acknowledged: &[Setting]) -> Known {
    let mut known = Known {
        settings: calibrated(),
        or: Settings::new(),
    };
    for (setting, value) in CHANGES {
        if acknowledged.contains(&setting) {
            known.must_be(setting, value);
        } else if work == Work::Save {
            known.allow((setting, value));
        }
    }
    known
}

impl Known {
    fn must_be(&mut self, setting: Setting, value: f32) {
        self.settings.insert(setting, value.to_bits());
        self.or.remove(&setting);
    }

    fn allow(&mut self, (setting, value): (Setting, f32)) {
        self.or.insert(setting, value.to_bits());
    }

    /// Compares all settings. From now on no value may change again.
    fn look(&mut self, robot: &mut Robot, seen: &mut Seen, when: &str) {
        let settings = robot.settings();
        for (setting, bits) in &settings {
            let known = self.settings[setting] == *bits || self.or.get(setting) == Some(bits);
            if !known {
                let value = f32::from_bits(*bits);
                seen.wrong.push(format!("{when}: {setting:?} = {value}"));
            }
        }
        let stored = in_flash(&newest(&robot.machine.parameter_flash()), Make::Dm4310);
        if stored != settings {
            seen.wrong
                .push(format!("{when}: flash says something else"));
        }
        self.settings = settings;
        self.or.clear();
    }
}

/// A selection spread evenly over all cuts, or all in a whole test run.
fn chosen(cells: &[Cell]) -> Vec<Cell> {
    let wanted = if is_whole() { cells.len() } else { RUNS };
    let places = (0..wanted).map(|n| n * cells.len() / wanted);
    places.map(|place| cells[place]).collect()
}

fn cells() -> Vec<Cell> {
    let first = |work, step, phase| Cell {
        work,
        step,
        phase,
        second: None,
    };
    let of_work = |work| {
        let steps = 0..steps(work);
        steps.flat_map(move |step| PHASES.map(|phase| first(work, step, phase)))
    };
    let once: Vec<Cell> = of_work(Work::Save).chain(of_work(Work::Erase)).collect();
    // Each first cut of every seventh cell, followed by second cuts at later and later steps.
    let twice = once.iter().step_by(7).zip(0..).map(|(cell, n)| Cell {
        second: Some((n * 5 % 48, PHASES[n % 3])),
        ..*cell
    });
    once.iter().copied().chain(twice).collect()
}

#[test]
fn no_power_cut_loses_a_setting() {
    let all = cells();
    let cells = chosen(&all);
    let seen = run_all(&cells, run);
    let cuts: usize = seen.iter().map(|seen| seen.cuts).sum();
    let twice = seen.iter().filter(|seen| seen.cuts > 1).count();
    println!(
        "{} of {} runs, {cuts} cuts, {twice} runs with a second cut in the recovery",
        cells.len(),
        all.len()
    );
    let wrong: Vec<String> = cells
        .iter()
        .zip(&seen)
        .flat_map(|(cell, seen)| seen.wrong.iter().map(move |what| format!("{cell}: {what}")))
        .collect();
    println!("{} lost or changed", wrong.len());
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
