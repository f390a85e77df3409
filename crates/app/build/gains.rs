//! `GainSchedule` of a robot.

use robot_balance_design::Schedule;
use robot_description::Robot;

use crate::literal::f32;

/// The expression of a robot's gains, or why the robot has none.
pub fn schedule(robot: &Robot) -> Result<String, String> {
    let schedule =
        Schedule::new(robot).map_err(|error| format!("the robot {}: {error}", robot.name))?;
    let coefficients = schedule
        .coefficients
        .map(|states| states.map(|of| of.map(f32)));
    Ok(format!(
        "GainSchedule {{ centre_m: {centre_m}, min_m: {min_m}, max_m: {max_m}, k: {k} }}",
        centre_m = f32(schedule.centre_m),
        min_m = f32(schedule.min_m),
        max_m = f32(schedule.max_m),
        k = format!("{coefficients:?}").replace('"', ""),
    ))
}
