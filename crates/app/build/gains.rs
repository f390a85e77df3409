//! `GainSchedule` of a robot.

use robot_description::Robot;

use crate::literal::f32;

/// The expression of a robot's gains.
///
/// It is zero for now.
pub fn schedule(robot: &Robot) -> String {
    let [min_m, max_m] = robot.control.limits.height_m;
    format!(
        "GainSchedule {{ centre_m: {centre_m}, min_m: {min_m}, max_m: {max_m}, k: [[[0.0; 6]; 10]; 4] }}",
        centre_m = f32((min_m + max_m) / 2.0),
        min_m = f32(min_m),
        max_m = f32(max_m),
    )
}
