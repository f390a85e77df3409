//! `GainSchedule` of a robot.

use robot_balance_design::Schedule;
use robot_description::Robot;

use crate::literal::f32;

/// The expression of a robot's gains, or why there are none.
pub fn schedule(robot: &Robot) -> Result<String, String> {
    let schedule =
        Schedule::new(robot).map_err(|error| format!("robot {}: {error}", robot.name))?;
    let inputs = schedule.coefficients.iter().map(|states| {
        let states = states.iter().map(|coefficients| {
            let coefficients = coefficients.iter().map(|value| f32(*value));
            list(coefficients)
        });
        list(states)
    });
    Ok(format!(
        "GainSchedule {{ centre_m: {centre_m}, min_m: {min_m}, max_m: {max_m}, k: {k} }}",
        centre_m = f32(schedule.centre_m),
        min_m = f32(schedule.min_m),
        max_m = f32(schedule.max_m),
        k = list(inputs),
    ))
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}
