//! Measures what the motors report while they are disabled.

use std::time::{Duration, Instant};

use robot_app::tuning::{JOINTS, WHEELS};

use super::verdict::{Measured, read};
use crate::tuning::{TuningClient, TuningError};

/// Time for which the joints are watched.
const LOOK: Duration = if cfg!(test) {
    Duration::ZERO
} else {
    Duration::from_secs(2)
};

/// Watches all joints while the robot is disarmed.
pub fn joints_answer(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
    let mut oldest_ms = [0.0_f64; JOINTS.len()];
    let end = Instant::now() + LOOK;
    loop {
        for (part, name) in JOINTS.iter().enumerate() {
            let joint = read(client, "joint", part)?;
            let state = joint.choice("state");
            found.must(state == "disabled", || format!("{name} is {state}"));
            found.must(!joint.has("marks", "gives-torque"), || {
                format!("{name} reports that it gives torque, though it was told to be off")
            });
            let health = read(client, "joint-health", part)?;
            let age_ms = health.number("age-ms").unwrap_or(f64::INFINITY);
            oldest_ms[part] = oldest_ms[part].max(age_ms);
        }
        if Instant::now() >= end {
            break;
        }
    }
    for (name, oldest_ms) in JOINTS.iter().zip(oldest_ms) {
        found.values.push((format!("{name}-oldest-ms"), oldest_ms));
        found.must(oldest_ms <= 10.0, || {
            format!("{name} was silent for {oldest_ms} ms")
        });
    }
    Ok(found)
}

pub fn wheels_heard(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
    for (part, name) in WHEELS.iter().enumerate() {
        let wheel = read(client, "wheel", part)?;
        let age = wheel.number("age-ms").unwrap_or(f64::INFINITY);
        found.values.push((format!("{name}-age-ms"), age));
        found.must(age <= 10.0, || format!("the {name} wheel is not heard"));
        let rpm = wheel.number("rotor-rpm").unwrap_or(f64::NAN);
        found.values.push((format!("{name}-rotor-rpm"), rpm));
    }
    Ok(found)
}
