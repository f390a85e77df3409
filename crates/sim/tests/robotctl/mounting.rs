//! A robot with another board orientation is tilted and turned by hand, and the tool finds the orientation with the shipped
//! image.

use std::path::{Path, PathBuf};

use anyhow::Context;
use robot_plant::{
    attitude::{self, Quaternion},
    recording::run_length,
    world::CanBusId,
};
use robot_sim::scenario::Scenario;
use robotctl::{
    mounting::{Poses, Watch, WatchError, enough_turned, find_board, find_mag},
    settings,
    tuning::TuningClient,
};

use crate::{
    support,
    tool::Tool,
    trial::{Columns, GRAVITY_MPS2, ROWS_A_SECOND, Vector, save},
};

const EARTH_UT: Vector = [0.0, 22.0, -42.0];
/// Seconds, and °/s about the robot's axes: level until the gyro is calibrated, nose up by 45°, level, left side up by
/// 45°, level again, and turned about.
const BY_HAND: [(f64, Vector); 8] = [
    (4.0, [0.0; 3]),
    (1.0, [0.0, -45.0, 0.0]),
    (2.5, [0.0; 3]),
    (1.0, [0.0, 45.0, 0.0]),
    (1.0, [45.0, 0.0, 0.0]),
    (2.5, [0.0; 3]),
    (1.0, [-45.0, 0.0, 0.0]),
    (3.0, [0.0; 3]),
];
const ABOUT: [(f64, Vector); 4] = [
    (1.0, [60.0, 0.0, 0.0]),
    (1.0, [0.0, 60.0, 0.0]),
    (1.0, [0.0, 0.0, 60.0]),
    (1.0, [-60.0, -30.0, 0.0]),
];

fn motion(directory: &Path) -> PathBuf {
    let mut columns = Columns::default();
    let mut q: Quaternion = [1.0, 0.0, 0.0, 0.0];
    let turning = std::iter::repeat_n(ABOUT, 3).flatten();
    for (seconds, rate_dps) in BY_HAND.into_iter().chain(turning) {
        let rate_rps = rate_dps.map(f64::to_radians);
        let [x, y, z] = rate_rps.map(|rate| 0.5 * rate / ROWS_A_SECOND as f64);
        for _ in 0..(seconds * ROWS_A_SECOND as f64) as usize {
            q = attitude::normalised(attitude::multiply(q, [1.0, x, y, z])).expect("a rotation");
            let force = attitude::to_body(q, [0.0, 0.0, GRAVITY_MPS2]);
            columns.push_turning(rate_rps, force, attitude::to_body(q, EARTH_UT));
        }
    }
    save(directory, "by-hand", &columns)
}

/// Names of the orientations that it found.
fn find_out(client: &mut TuningClient) -> anyhow::Result<[&'static str; 2]> {
    let mut poses = Vec::new();
    while poses.len() < 3 {
        match Watch::new(client)?.still_force() {
            Ok(force) if poses.iter().all(|pose| force.angle(pose) > 0.5) => poses.push(force),
            Ok(_) | Err(WatchError::Moved(_)) => {}
            Err(error) => return Err(error.into()),
        }
    }
    let [level, nose_up, left_up] = poses[..].try_into().context("three")?;
    let board = find_board(&Poses {
        level,
        nose_up,
        left_up,
    })?;
    let setting = settings::find("mounting.board")?;
    client.write(setting, setting.parse(board.orientation.name())?)?;
    let mut watch = Watch::new(client)?;
    while watch.check_attitude().is_err() {}
    let mut samples = Vec::new();
    while !enough_turned(&samples) {
        samples.push(watch.field()?);
    }
    let mag = find_mag(watch.board(), &samples)?;
    Ok([board.orientation.name(), mag.orientation.name()])
}

#[test]
fn a_robot_tilted_by_hand_shows_how_its_sensors_sit() {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("mounting");
    let trial = motion(&directory);
    let sits = ["x-left-z-down", "x-up-z-right"];
    let text = format!(
        "name = \"by hand\"\nseconds = 1\nplant = \"stand\"\nmounting = \"{}\"\nmag_mounting = \"{}\"\n",
        sits[0], sits[1]
    );
    let mut job = support::job(Scenario::parse(&text, "by hand").expect("it parses"));
    job.pc.can_on_pty = vec![CanBusId::Can1];
    let flash = directory.join("flash.bin");
    std::fs::write(&flash, crate::clean_flash()).expect("a file for its flash");
    job.flash_file = Some(flash);
    job.scenario.length = run_length(&trial).expect("a trial");
    job.imu_trial = Some(trial);
    let mut tool = Tool::new(find_out);
    let outcome = job.run(&mut [&mut tool]).expect("the machine starts");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(tool.result().expect("it finds out"), sits);
}
