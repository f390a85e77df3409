//! Measures accelerometer and gyro of a board that is held and turned by hand.

use std::{
    thread,
    time::{Duration, Instant},
};

use super::verdict::{AXES, Measured, Verdict, read, vector};
use crate::tuning::{TuningClient, TuningError};

/// Time to turn the board by hand.
const TURN: Duration = if cfg!(test) {
    Duration::ZERO
} else {
    Duration::from_secs(5)
};
const PAUSE: Duration = Duration::from_millis(20);

/// Expects gravity along one axis only. It records the magnetometer's values for the reader of the report.
fn gravity_on(client: &mut TuningClient, axis: usize, sign: f64) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
    let accel = vector(&mut found, client, "accel", "mps2")?;
    vector(&mut found, client, "mag", "ut")?;
    let along = sign * accel[axis];
    let others = (0..3).filter(|other| *other != axis);
    let across = others.map(|other| accel[other].abs()).fold(0.0, f64::max);
    found.must((9.0..=10.6).contains(&along) && across < 2.5, || {
        format!(
            "{} must be about {:+} and the other axes about 0",
            AXES[axis],
            sign * 9.8
        )
    });
    Ok(found)
}

pub fn flat(client: &mut TuningClient) -> Result<Measured, TuningError> {
    gravity_on(client, 2, 1.0)
}

pub fn upside_down(client: &mut TuningClient) -> Result<Measured, TuningError> {
    gravity_on(client, 2, -1.0)
}

pub fn nose_up(client: &mut TuningClient) -> Result<Measured, TuningError> {
    gravity_on(client, 0, 1.0)
}

pub fn left_up(client: &mut TuningClient) -> Result<Measured, TuningError> {
    gravity_on(client, 1, 1.0)
}

/// Measures the fastest rate of each axis while the board is turned to the left.
pub fn left_turn(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
    let mut fastest = [0.0_f64; 3];
    let end = Instant::now() + TURN;
    loop {
        let gyro = read(client, "gyro", 0)?;
        for (fastest, axis) in fastest.iter_mut().zip(AXES) {
            let rate = gyro.number(&format!("{axis}-dps")).unwrap_or(f64::NAN);
            if rate.is_nan() || rate.abs() > fastest.abs() {
                *fastest = rate;
            }
        }
        if Instant::now() >= end {
            break;
        }
        thread::sleep(PAUSE);
    }
    for (axis, fastest) in AXES.iter().zip(fastest) {
        found.values.push((format!("fastest-{axis}-dps"), fastest));
    }
    let [x, y, z] = fastest;
    found.must(z > 20.0 && x.abs() < z / 2.0 && y.abs() < z / 2.0, || {
        "z must be positive and by far the fastest: a turn to the left, seen from above".to_owned()
    });
    Ok(found)
}

pub fn after_an_hour(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
    let uptime = found.value(&read(client, "run", 0)?, "uptime-s");
    found.must(uptime >= 3_600.0, || {
        "the robot has not run for an hour yet".to_owned()
    });
    let rejects = read(client, "rejects", 0)?;
    for why in ["absent", "frozen", "implausible", "saturated"] {
        found.value(&rejects, why);
    }
    let sensors = read(client, "sensors", 0)?;
    for count in ["imu-errors", "mag-errors", "imu-restarts", "mag-restarts"] {
        found.value(&sensors, count);
    }
    let buffer = read(client, "gyro-buffer", 0)?;
    for count in ["spikes", "differences", "resets", "overruns"] {
        found.value(&buffer, count);
    }
    let turned = left_turn(client)?;
    found.values.extend(turned.values);
    if found.verdict == Verdict::AsItMustBe {
        found.verdict = turned.verdict;
    }
    Ok(found)
}
