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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::tests::at_rest;
    use robot_plant::world::{Start, Terrain};

    #[test]
    fn pictures_and_viewer_need_no_other_file_and_have_all_their_numbers() {
        let (table, values, robot) = at_rest(Start::Sitting);
        let signals = SkeletonSignals::find(&table).expect("it is free");
        let frame = |t_s| Frame {
            t_s,
            skeleton: signals.read(&values, &robot).expect("values"),
        };
        let frames = [frame(0.0), frame(1.0)];
        let ground = course::profiles(&Terrain::Flat);
        let viewer = viewer::html(&frames, &robot, &ground);
        let strip = strip::svg(&frames, &robot, &ground);
        for outside in ["src=", "href=", "import", "fetch("] {
            assert!(!viewer.contains(outside) && !strip.contains(outside));
        }
        assert!(strip.contains("0.00 s") && strip.contains("1.00 s"));
        let data = viewer.split_once("const run = ").expect("data").1;
        let data = data.split_once(";\n").expect("one line").0;
        let data: serde_json::Value = serde_json::from_str(data).expect("JSON");
        let rows = data["frames"].as_array().expect("frames");
        // As `viewer.js` counts: time, place, attitude, seven of each leg, speed, pitch.
        let lengths: Vec<_> = rows.iter().filter_map(|row| row.as_array()).collect();
        assert!(lengths.len() == 2 && lengths.iter().all(|row| row.len() == 24));
        let pitch = table.index("truth.body.pitch").and_then(|at| values[at]);
        let shown = rows[0][23].as_f64();
        assert!(pitch.zip(shown).is_some_and(|(a, b)| (a - b).abs() < 1e-4));
        assert_eq!(
            data["ground"],
            serde_json::json!([[[0.0, 0.0]], [[0.0, 0.0]]])
        );
    }
}
