//! The free robot in pictures: a strip, and a viewer that plays the run.

mod strip;
mod viewer;

use robot_chart::escaped;

use super::Report;
use crate::{
    course,
    skeleton::{Skeleton, SkeletonSignals},
};

/// The robot at one instant.
struct Frame {
    t_s: f64,
    skeleton: Skeleton,
}

/// The section of the page with both, empty for a robot that is not free.
pub fn section(report: &Report) -> String {
    let frames = frames(report);
    if frames.len() < 2 {
        return String::new();
    }
    let robot = &report.scenario.robot;
    let ground = course::profiles(&report.scenario.terrain);
    format!(
        "<h2>The robot</h2>\n<figure><figcaption>{}</figcaption>\n{}</figure>\n{}",
        escaped(
            "Seen from its right side, at instants between which it moves about as much. Blue: left leg; orange: right leg."
        ),
        strip::svg(&frames, robot, &ground),
        viewer::html(&frames, robot, &ground),
    )
}

fn frames(report: &Report) -> Vec<Frame> {
    let Some(signals) = SkeletonSignals::find(&report.result.table) else {
        return Vec::new();
    };
    let samples = report.traces.samples();
    let seen = samples.filter_map(|(t_s, values)| {
        Some(Frame {
            t_s,
            skeleton: signals.read(values, &report.scenario.robot)?,
        })
    });
    seen.collect()
}
