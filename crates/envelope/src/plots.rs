//! The page with plots: how many survive, and the most telling run of each task.

use robot_chart::{
    BLUE, ChartError, Colour, Curve, Figure, GREEN, ORANGE, TimePlot, document, header, table,
};

use crate::{
    limit::Limit,
    report::{self, Report},
    survey::{Run, Survey},
    tasks::Task,
    trial::{READY_AT_S, Sample},
};

const HEIGHT: u32 = 200;
/// Points of the survival curve.
const STRENGTHS: u32 = 100;

/// The whole page.
pub(crate) fn page(
    report: &Report,
    tasks: &[&Task],
    surveys: &[Survey],
) -> Result<String, ChartError> {
    let subtitle = format!("{}, {} robots a task", report.robot, report.seeds);
    let mut body = header("What the robot survives", &subtitle);
    body += &table(
        &["task", "runs", "ok", "rate", "wanted", "worst", "unit"],
        &report
            .tasks
            .iter()
            .map(|(name, task)| {
                vec![
                    format!("{name}: {}", task.what),
                    task.runs.to_string(),
                    task.ok.to_string(),
                    format!("{:.1} %", 100.0 * task.rate),
                    format!("{:.1} %", 100.0 * task.wanted),
                    task.worst
                        .map_or(String::new(), |worst| format!("{worst:.3}")),
                    format!("{} {}", task.unit, task.figure),
                ]
            })
            .collect::<Vec<_>>(),
    );
    for (task, survey) in tasks.iter().zip(surveys) {
        if let Some(limit) = &survey.limit {
            body += &survival(task, limit)?;
        }
        if let Some(run) = report::most_telling(task, survey) {
            body += &trace(task, run)?;
        }
    }
    Ok(document("Envelope", &body))
}

fn survival(task: &Task, limit: &Limit) -> Result<String, ChartError> {
    let strongest = limit.each.last().copied().unwrap_or(1.0) * 1.1;
    let points = (0..=STRENGTHS)
        .map(|step| strongest * f64::from(step) / f64::from(STRENGTHS))
        .map(|strength| (strength, Some(100.0 * limit.surviving(strength))));
    let plot = TimePlot {
        unit: "%",
        height: HEIGHT,
        time: 0.0..strongest,
        marks: &[limit.median()],
        shaded: &[],
        curves: vec![curve("robots that survive", BLUE, points.collect())],
    };
    let caption = format!(
        "Below: {} in {}. Half of the robots survive {:.2} {}.",
        limit.what,
        limit.unit,
        limit.median(),
        limit.unit
    );
    figure(&plot, format!("{}: survivors", task.name), caption)
}

fn trace(task: &Task, run: &Run) -> Result<String, ChartError> {
    let end_s = run.samples.last().map_or(1.0, |sample| sample.t_s);
    let marks = [READY_AT_S];
    let degrees = |axis: usize| move |sample: &Sample| sample.rpy_rad[axis].to_degrees();
    let how = match &run.figure {
        Ok(figure) => format!("{} {figure:.3} {}", task.figure, task.unit),
        Err(failure) => format!("failed at {:.2} s: {}", failure.at_s, failure.what),
    };
    let angles = vec![
        of(run, "pitch", BLUE, degrees(1)),
        of(run, "roll", ORANGE, degrees(0)),
    ];
    let motion = vec![
        of(run, "speed, m/s", BLUE, |sample| sample.forward_mps),
        of(run, "turn rate, rad/s", ORANGE, |sample| sample.yaw_rps),
        of(run, "wheel torque, N·m", GREEN, |sample| {
            0.5 * (sample.wheel_nm[0] + sample.wheel_nm[1])
        }),
    ];
    let lengths = vec![
        of(run, "left leg", BLUE, |sample| sample.leg_m[0]),
        of(run, "right leg", ORANGE, |sample| sample.leg_m[1]),
        of(run, "height of the hips", GREEN, |sample| sample.place_m[2]),
    ];
    let mut html = String::new();
    for (unit, curves) in [("°", angles), ("", motion), ("m", lengths)] {
        let plot = TimePlot {
            unit,
            height: HEIGHT,
            time: 0.0..end_s,
            marks: &marks,
            shaded: &[],
            curves,
        };
        html += &figure(
            &plot,
            format!("{}, seed {}", task.name, run.seed),
            how.clone(),
        )?;
    }
    Ok(html)
}

fn of(run: &Run, label: &str, colour: Colour, read: impl Fn(&Sample) -> f64) -> Curve {
    let points = run
        .samples
        .iter()
        .map(|sample| (sample.t_s, Some(read(sample))));
    curve(
        label,
        colour,
        robot_chart::thinned(&points.collect::<Vec<_>>()),
    )
}

fn curve(label: &str, colour: Colour, points: Vec<(f64, Option<f64>)>) -> Curve {
    Curve {
        label: label.to_owned(),
        colour,
        faint: false,
        points,
    }
}

fn figure(plot: &TimePlot<'_>, title: String, caption: String) -> Result<String, ChartError> {
    let Some(svg) = plot.draw()? else {
        return Ok(String::new());
    };
    let legend = plot.legend();
    Ok(Figure {
        title,
        caption,
        legend,
        svg,
    }
    .html())
}
