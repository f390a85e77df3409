//! A sample of the tasks: what every robot does that is as its file says.

use robot_envelope::{Report, Robots, TASKS, Task, survey, table};
use robot_plant::world::WorldConfig;

/// Tasks of a few seconds each.
const SAMPLE: &[&str] = &[
    "stand-up-sitting",
    "drive",
    "spin",
    "ramp",
    "push",
    "push-diagonal",
    "lost",
];

#[test]
fn robots_as_in_their_file_succeed() {
    let robots = Robots {
        robot: WorldConfig::default().robot,
        vary: false,
    };
    let tasks: Vec<&Task> = TASKS
        .iter()
        .filter(|task| SAMPLE.contains(&task.name))
        .collect();
    assert_eq!(tasks.len(), SAMPLE.len());
    let surveys = survey(&tasks, &robots, 0..2, false, &|| ());
    let report = Report::new("fivebar", 2, &tasks, &surveys);
    assert!(report.holds(), "\n{}", table(&report));
}

/// Friction of the gears, errors of the horizon and of the centre of mass do not make it creep to and fro.
#[test]
fn robots_that_differ_stand_still() {
    let robots = Robots {
        robot: WorldConfig::default().robot,
        vary: true,
    };
    let tasks: Vec<&Task> = TASKS.iter().filter(|task| task.name == "stand").collect();
    let surveys = survey(&tasks, &robots, 0..2, false, &|| ());
    let report = Report::new("fivebar", 2, &tasks, &surveys);
    assert!(report.holds(), "\n{}", table(&report));
}

#[test]
fn robots_that_differ_jump_and_land() {
    let robots = Robots {
        robot: WorldConfig::default().robot,
        vary: true,
    };
    let tasks: Vec<&Task> = TASKS.iter().filter(|task| task.name == "jump").collect();
    let surveys = survey(&tasks, &robots, 0..6, false, &|| ());
    let report = Report::new("fivebar", 6, &tasks, &surveys);
    assert!(report.holds(), "\n{}", table(&report));
}

/// The centre of mass of one of them is 2.6 cm towards the edge on which it lies.
#[test]
fn robots_that_differ_stand_up_from_sitting() {
    let robots = Robots {
        robot: WorldConfig::default().robot,
        vary: true,
    };
    let tasks: Vec<&Task> = TASKS
        .iter()
        .filter(|task| task.name == "stand-up-sitting")
        .collect();
    let surveys = survey(&tasks, &robots, 0..20, false, &|| ());
    let report = Report::new("fivebar", 20, &tasks, &surveys);
    assert!(report.holds(), "\n{}", table(&report));
}

/// The estimate of one of them has drifted while it lay, that of another when it has come up.
#[test]
fn robots_that_differ_stand_up_with_folded_legs() {
    let robots = Robots {
        robot: WorldConfig::default().robot,
        vary: true,
    };
    let tasks: Vec<&Task> = TASKS
        .iter()
        .filter(|task| task.name == "stand-up-folded")
        .collect();
    let surveys = survey(&tasks, &robots, 0..27, false, &|| ());
    let report = Report::new("fivebar", 27, &tasks, &surveys);
    assert!(report.holds(), "\n{}", table(&report));
}

/// Among them robots whose centre of mass is high, which tip over the edge onto which they sink too fast.
#[test]
fn robots_that_differ_sit_down_gently() {
    let robots = Robots {
        robot: WorldConfig::default().robot,
        vary: true,
    };
    let tasks: Vec<&Task> = TASKS
        .iter()
        .filter(|task| task.name == "sit-down")
        .collect();
    let surveys = survey(&tasks, &robots, 0..10, false, &|| ());
    let report = Report::new("fivebar", 10, &tasks, &surveys);
    assert!(report.holds(), "\n{}", table(&report));
}

#[test]
fn specimens_differ_within_their_limits_and_repeat() {
    let robots = Robots {
        robot: WorldConfig::default().robot,
        vary: true,
    };
    let mut heaviest = 0.0_f64;
    for seed in 0..200 {
        let one = robots.variation(seed);
        assert_eq!(one, robots.variation(seed));
        let body = one.body;
        assert!((0.8..1.4).contains(&body.mass_factor));
        assert!((0.4..1.2).contains(&body.ground_friction));
        assert!(body.com_offset_m.iter().all(|m| m.abs() <= 0.03));
        heaviest = heaviest.max(body.mass_factor);
    }
    assert!(heaviest > 1.3, "{heaviest}");
}
