//! The page of a CAN bus.

use std::collections::BTreeMap;

use robot_chart::{ChartError, Figure, table};

use super::{
    Content,
    messages::Messages,
    series::{Axis, Points, Words, gaps, with_gaps},
};

/// A longer silence of the bus is a gap. Its motors report at least every 2 ms.
const SILENCE_S: f64 = 0.02;
const RATE_BIN_S: f64 = 0.1;

/// Title, unit and field of a plot, and what the topics of its curves begin with.
const PLOTS: [(&str, &str, &str, &str); 8] = [
    ("Currents commanded", "A", "current_", "/esc/command"),
    ("Currents measured", "A", "current_a", "/esc/"),
    ("Rotor speeds", "rpm", "rotor_rpm", "/esc/"),
    (
        "Joint angles, as the motors count them",
        "rad",
        "angle_rad",
        "/joint/",
    ),
    (
        "Joint speeds, as the motors count them",
        "rad/s",
        "speed_rps",
        "/joint/",
    ),
    (
        "Joint torques, as the motors count them",
        "N·m",
        "torque_nm",
        "/joint/",
    ),
    (
        "Temperatures of the wheels' motors",
        "°C",
        "temperature_c",
        "/esc/",
    ),
    (
        "Temperatures of the joints' motors",
        "°C",
        "temperature_c",
        "/joint/",
    ),
];

pub(super) fn content(messages: &Messages) -> Result<Content, ChartError> {
    let times = || messages.can.iter().map(|frame| frame.t_s);
    let start_s = times().next().unwrap_or(0.0);
    let duration_s = (times().next_back().unwrap_or(0.0) - start_s).max(1e-3);
    let axis = Axis {
        time: 0.0..duration_s,
        gaps: gaps(times().map(|t| t - start_s), SILENCE_S),
        marks: Vec::new(),
    };
    let mut body = identifiers(messages, duration_s);
    for (title, unit, field, topics) in PLOTS {
        let words = Words {
            title,
            caption: "",
            unit,
        };
        let figure = axis.figure(&words, curves(messages, start_s, field, topics))?;
        body.extend(figure.as_ref().map(Figure::html));
    }
    body.extend(rate(messages, &axis, start_s)?.as_ref().map(Figure::html));
    Ok(Content {
        summary: format!(
            "{duration_s:.1} s, {} frames, {:.0} a second, {} silences longer than {:.0} ms",
            messages.can.len(),
            messages.can.len() as f64 / duration_s,
            axis.gaps.len(),
            SILENCE_S * 1e3
        ),
        body,
    })
}

/// Returns a curve for each motor with this field, and for a command one for each of its fields that has a value.
fn curves(messages: &Messages, start_s: f64, field: &str, topics: &str) -> Vec<(String, Points)> {
    let mut curves: BTreeMap<String, Points> = BTreeMap::new();
    let of_kind = messages
        .motors
        .iter()
        .filter(|(topic, _)| topic.starts_with(topics));
    for (topic, reports) in of_kind {
        for (t_s, fields) in reports {
            let found = fields.iter().filter(|(name, _)| match topic == topics {
                true => name.starts_with(field),
                false => *name == field,
            });
            for (name, value) in found {
                let motor = match topic == topics {
                    true => name.trim_start_matches(field).trim_end_matches("_a"),
                    false => topic.trim_start_matches(topics),
                };
                let label = match topics.starts_with("/esc/") {
                    true => format!("ESC {motor}"),
                    false => motor.to_owned(),
                };
                let points = curves.entry(label).or_default();
                points.push((t_s - start_s, Some(*value)));
            }
        }
    }
    // Speed controllers that do not exist get zero.
    let is_used =
        |points: &Points| topics != "/esc/command" || points.iter().any(|p| p.1 != Some(0.0));
    let used = curves.into_iter().filter(|(_, points)| is_used(points));
    used.map(|(label, points)| (label, with_gaps(points.into_iter(), SILENCE_S)))
        .collect()
}

fn identifiers(messages: &Messages, duration_s: f64) -> String {
    let mut counts: BTreeMap<u16, u64> = BTreeMap::new();
    for frame in &messages.can {
        *counts.entry(frame.id).or_default() += 1;
    }
    let rows: Vec<_> = counts
        .iter()
        .map(|(id, count)| {
            vec![
                format!("{id:#05x}"),
                count.to_string(),
                format!("{:.1}", *count as f64 / duration_s),
            ]
        })
        .collect();
    table(&["identifier", "frames", "a second"], &rows)
}

fn rate(messages: &Messages, axis: &Axis, start_s: f64) -> Result<Option<Figure>, ChartError> {
    let mut bins = vec![0.0; (axis.time.end / RATE_BIN_S) as usize];
    for frame in &messages.can {
        if let Some(count) = bins.get_mut(((frame.t_s - start_s) / RATE_BIN_S) as usize) {
            *count += 1.0;
        }
    }
    let points = bins
        .iter()
        .enumerate()
        .map(|(n, count)| ((n as f64 + 0.5) * RATE_BIN_S, Some(count / RATE_BIN_S)));
    let words = Words {
        title: "Frames a second",
        caption: "Tinted: silence of the bus.",
        unit: "1/s",
    };
    axis.figure(&words, vec![("frames".to_owned(), points.collect())])
}
