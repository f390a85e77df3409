//! Lengths and poses of the legs.

use super::{Findings, Severity::Error};
use crate::{Robot, figures, five_bar::FiveBar};

/// 10°. Nearer than that, forces in the shanks grow beyond six times the leg's force.
const MIN_BETWEEN_SHANKS_RAD: f64 = 0.175;
/// 3°. At 0 the hips could no longer lift a robot whose legs have folded.
const MIN_AT_KNEE_RAD: f64 = 0.05;

pub(super) fn check_lengths(robot: &Robot, findings: &mut Findings) {
    let legs = &robot.legs;
    for (field, length_m) in [
        ("legs.hip_gap_m", legs.hip_gap_m),
        ("legs.plane_y_m", legs.plane_y_m),
        ("legs.thigh.length_m", legs.thigh.length_m),
        ("legs.shank.length_m", legs.shank.length_m),
        ("legs.min_m", legs.min_m),
    ] {
        findings.note(
            Error,
            length_m > 0.0 && length_m < 2.0,
            field,
            format!("{length_m} m"),
            "more than 0, less than 2 m",
            "Measure from axis to axis, in m.",
        );
    }
    findings.note(
        Error,
        legs.min_m < legs.max_m,
        "legs.max_m",
        format!("{} m", legs.max_m),
        format!("more than min_m, {} m", legs.min_m),
        "Enter the longest usable leg.",
    );
    let [low_m, high_m] = robot.control.limits.height_m;
    findings.note(
        Error,
        legs.min_m <= low_m && low_m < high_m && high_m <= legs.max_m,
        "control.limits.height_m",
        format!("{low_m} to {high_m} m"),
        format!(
            "a range within the leg's {} to {} m",
            legs.min_m, legs.max_m
        ),
        "Leave some travel at both ends for bumps.",
    );
    let inner_m = robot.wheels.track_m / 2.0 - robot.wheels.width_m / 2.0;
    let half_m = robot.body.box_m[1] / 2.0;
    findings.note(
        Error,
        inner_m > half_m,
        "wheels.track_m",
        format!("{} m", robot.wheels.track_m),
        format!(
            "more than {:.3} m, so that the wheels pass the body",
            2.0 * half_m + robot.wheels.width_m
        ),
        "Measure between the middles of the tyres.",
    );
}

pub(super) fn check_poses(robot: &Robot, findings: &mut Findings) {
    let margins = figures::worst_margins(robot);
    findings.note(
        Error,
        margins.is_some(),
        "joints.range_rad",
        "the shanks do not meet at some hip angles".to_owned(),
        "shanks that meet at all hip angles",
        "Narrow the ranges, or make the shanks longer.",
    );
    let Some(margins) = margins else { return };
    findings.note(
        Error,
        margins.between_shanks_rad >= MIN_BETWEEN_SHANKS_RAD,
        "joints.range_rad",
        format!(
            "the shanks come within {:.1} degrees of one line, where the axle gives way",
            margins.between_shanks_rad.to_degrees()
        ),
        "10 degrees",
        "Narrow the ranges.",
    );
    findings.note(Error,
        margins.at_knee_rad >= MIN_AT_KNEE_RAD,
        "joints.range_rad",
        format!(
            "a knee comes within {:.1} degrees of folded or straight, where its hip cannot move the axle",
            margins.at_knee_rad.to_degrees()
        ),
        "3 degrees",
        "Narrow the ranges, with a stop on each thigh.",
    );
    let leg = FiveBar::new(&robot.legs);
    for (field, length_m) in [
        ("legs.min_m", robot.legs.min_m),
        ("legs.max_m", robot.legs.max_m),
    ] {
        let hips = leg.hips_rad(length_m, 0.0);
        let value = match hips {
            Some([front, rear]) => {
                format!("{length_m} m needs hips at {front:.2} and {rear:.2} rad")
            }
            None => format!("{length_m} m is beyond what the links reach"),
        };
        findings.note(
            Error,
            hips.is_some_and(|hips| figures::in_range(robot, hips)),
            field,
            value,
            format!(
                "a length with hips in {:?} and {:?} rad",
                robot.joints.range_rad.front, robot.joints.range_rad.rear
            ),
            "Change the length or the ranges of the hips.",
        );
    }
}
