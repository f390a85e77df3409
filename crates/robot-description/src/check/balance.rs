//! What the robot can do: stand, balance, drive, jump.

use super::{
    Findings,
    Severity::{Error, Warning},
};
use crate::{Robot, figures};

/// Share of the continuous torque above which a hip gets hot in a long stand on uneven ground.
const WARM: f64 = 0.7;
/// Share of the unloaded wheel's speed that leaves torque to balance.
const TOP: f64 = 0.9;
/// Lean in rad that braking and pushes need.
const MIN_LEAN_RAD: f64 = 0.25;

pub(super) fn check(robot: &Robot, findings: &mut Findings) {
    standing(robot, findings);
    centre(robot, findings);
    speeds(robot, findings);
    jump(robot, findings);
    wishes(robot, findings);
}

fn standing(robot: &Robot, findings: &mut Findings) {
    let worst = figures::hardest_stand(robot);
    let value = format!(
        "standing at {:.2} m needs {:.2} N m of each hip, {:.0} % of it",
        worst.length_m,
        worst.hip_nm,
        100.0 * worst.share
    );
    findings.note(
        Error,
        worst.share <= 1.0,
        "joints.continuous_nm",
        value.clone(),
        "100 %",
        "Make the robot lighter, its thighs shorter, or take stronger motors.",
    );
    findings.note(
        Warning,
        worst.share > 1.0 || worst.share <= WARM,
        "joints.continuous_nm",
        value,
        "70 %, so that the motors stay cool on uneven ground",
        "Make the robot lighter, its thighs shorter, or stand lower.",
    );
    let clearance_m = figures::clearance_m(robot);
    findings.note(
        Error,
        clearance_m > 0.0,
        "control.limits.height_m",
        format!("the body is {clearance_m:.3} m above the ground at the lowest height"),
        "more than 0 m",
        "Raise the lowest height.",
    );
}

fn centre(robot: &Robot, findings: &mut Findings) {
    let lean_rad = figures::leans_rad(robot, figures::middle_m(robot));
    findings.note(
        Warning,
        lean_rad[1].min(-lean_rad[0]) >= MIN_LEAN_RAD,
        "joints.range_rad",
        format!(
            "at middle height the legs lean by {:.2} to {:.2} rad",
            lean_rad[0], lean_rad[1]
        ),
        format!("{MIN_LEAN_RAD} rad either way, for braking and pushes"),
        "Widen the ranges of the hips.",
    );
    // With the legs folded the axles must come under the centre of mass.
    let needed_rad = figures::folded_lean_rad(robot);
    let [back_rad, fore_rad] = figures::leans_rad(robot, robot.legs.min_m);
    findings.note(
        Error,
        (back_rad..=fore_rad).contains(&needed_rad),
        "body.com_m",
        format!(
            "{} m forward; with folded legs the legs would have to lean by {needed_rad:.2} rad",
            robot.body.com_m[0]
        ),
        format!("{back_rad:.2} to {fore_rad:.2} rad, so that the wheels come under it"),
        "Move the battery, or check the sign: forward is positive.",
    );
    let sideways_m = robot.body.com_m[1];
    findings.note(
        Warning,
        sideways_m.abs() <= 0.1 * robot.wheels.track_m,
        "body.com_m",
        format!("{sideways_m} m to the left"),
        "a tenth of the track",
        "Move the battery.",
    );
}

fn speeds(robot: &Robot, findings: &mut Findings) {
    let top_mps = figures::top_speed_mps(robot);
    let speed_mps = robot.control.limits.max_speed_mps;
    let most_mps = TOP * top_mps;
    findings.up_to(
        most_mps,
        &format!("{most_mps:.2} m/s, 90 % of the unloaded wheel's {top_mps:.2}"),
        "control.limits.max_speed_mps",
        (speed_mps, "m/s"),
        "Ask for less, or take larger wheels: at its top speed a motor has no torque left to balance.",
    );
    let yaw_rps = robot.control.limits.max_yaw_rps;
    let most_rps = most_mps / (robot.wheels.track_m / 2.0);
    findings.up_to(
        most_rps,
        &format!("{most_rps:.1} rad/s, 90 % of what unloaded wheels turn it"),
        "control.limits.max_yaw_rps",
        (yaw_rps, "rad/s"),
        "Ask for less.",
    );
    let travel_m = robot.legs.max_m - robot.legs.min_m;
    let most_rad = (travel_m / robot.wheels.track_m).atan();
    let roll_rad = robot.control.limits.max_roll_rad;
    findings.note(
        Error,
        (0.0..=most_rad).contains(&roll_rad),
        "control.limits.max_roll_rad",
        format!("{roll_rad} rad"),
        format!("0 to {most_rad:.2} rad, one leg folded and one stretched"),
        "Ask for less.",
    );
}

fn jump(robot: &Robot, findings: &mut Findings) {
    let jump = figures::jump(robot);
    findings.note(
        Error,
        robot.control.limits.jump_m >= 0.0 && robot.control.limits.jump_m <= jump.clearance_m,
        "control.limits.jump_m",
        format!("{} m", robot.control.limits.jump_m),
        format!(
            "0 to {:.2} m, which the hips' torque, speed and stroke give ({:.2} m/s at take-off)",
            jump.clearance_m, jump.take_off_mps
        ),
        "Ask for less, raise torque_limit_nm, or make the robot lighter.",
    );
}

fn wishes(robot: &Robot, findings: &mut Findings) {
    let control = &robot.control;
    findings.note(
        Error,
        (0.0..=0.02).contains(&control.delay_s),
        "control.delay_s",
        format!("{} s", control.delay_s),
        "0 to 0.02 s",
        "Enter seconds; 0.003 is usual here.",
    );
    let fine = |weight: &f64| *weight >= 0.0 && weight.is_finite();
    findings.note(
        Error,
        control.weights.q.iter().all(fine),
        "control.weights.q",
        format!("{:?}", control.weights.q),
        "ten figures of at least 0",
        "A larger weight keeps that state smaller.",
    );
    findings.note(
        Error,
        control
            .weights
            .r
            .iter()
            .all(|weight| *weight > 0.0 && weight.is_finite()),
        "control.weights.r",
        format!("{:?}", control.weights.r),
        "four figures above 0",
        "A larger weight spares that torque.",
    );
    let inside = (0..3).all(|axis| {
        let from_centre_m = robot.imu.place_m[axis] - robot.body.box_centre_m[axis];
        from_centre_m.abs() <= robot.body.box_m[axis] / 2.0
    });
    let [x, y, z] = robot.imu.place_m;
    findings.note(
        Error,
        inside,
        "imu.place_m",
        format!("{x}, {y}, {z} m"),
        "a place in the body's box",
        "Measure from the hip centre to the board's middle.",
    );
}
