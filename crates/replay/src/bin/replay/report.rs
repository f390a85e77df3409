//! `report.html`: the table of errors, then two plots a trial.

use std::{fmt::Write, ops::Range};

use robot_chart::{
    BLUE, ChartError, Curve, Figure, GREEN, ORANGE, TimePlot, document, escaped, header, thinned,
};
use robot_replay::{At, Figures, Instant, Run, Tick, Trial};

use crate::{
    outcome::{Outcome, Task},
    table,
};

/// Returns the plots of a trial: error over time, then gyro bias over time.
pub fn plots(
    trial: &Trial,
    run: &Run,
    gyro_offset_dps: [f32; 3],
) -> Result<Vec<Figure>, ChartError> {
    let settled = run.ticks.iter().find(|tick| tick.valid).map_or(0.0, time_s);
    let mut compared = run.compare(trial, At::EveryTick);
    compared.retain(|instant| instant.t_s >= settled);
    let scored = scored_spans(&compared);
    let plot = |unit, height, curves| TimePlot {
        unit,
        height,
        time: 0.0..trial.seconds().max(1e-3),
        marks: &[],
        shaded: &scored,
        curves,
    };
    let errors = plot("error, °", 260, error_curves(&compared));
    let biases = plot("bias, °/s", 190, bias_curves(run, gyro_offset_dps));
    let seen = [
        (
            errors,
            trial.name.clone(),
            error_caption(run.score(trial, At::EveryTick)),
        ),
        (
            biases,
            format!("{}: gyro bias", trial.name),
            "What the estimator takes out of the gyro, the sensor's own offset included."
                .to_owned(),
        ),
    ];
    let mut figures = Vec::new();
    for (plot, title, caption) in seen {
        figures.extend(plot.draw()?.map(|svg| Figure {
            title,
            caption,
            legend: plot.legend(),
            svg,
        }));
    }
    Ok(figures)
}

fn error_caption(figures: Option<Figures>) -> String {
    match figures {
        Some(f) => format!(
            "Tinted: scored, {:.2}° total, {:.2}° heading, {:.2}° inclination.",
            f.total_deg, f.heading_deg, f.inclination_deg
        ),
        None => "Nothing to score.".to_owned(),
    }
}

fn time_s(tick: &Tick) -> f64 {
    tick.t_us as f64 * 1e-6
}

fn scored_spans(compared: &[Instant]) -> Vec<Range<f64>> {
    let phases = compared.chunk_by(|a, b| a.scored == b.scored);
    let scored = phases.filter(|phase| phase.first().is_some_and(|instant| instant.scored));
    let span = |phase: &[Instant]| Some(phase.first()?.t_s..phase.last()?.t_s);
    scored.filter_map(span).collect()
}

fn error_curves(compared: &[Instant]) -> Vec<Curve> {
    let points = |part: fn(&Instant) -> Option<f64>| {
        let all: Vec<_> = compared.iter().map(|i| (i.t_s, part(i))).collect();
        thinned(&all)
    };
    let heading = points(|i| i.error.map(|error| error.heading_deg()));
    let inclination = points(|i| i.error.map(|error| error.inclination_deg()));
    vec![
        curve("heading (left positive)", BLUE, heading),
        curve("inclination", ORANGE, inclination),
    ]
}

/// Plots the bias found over the offset added, if any, which is a faint line.
fn bias_curves(run: &Run, gyro_offset_dps: [f32; 3]) -> Vec<Curve> {
    let axes = [("x", BLUE), ("y", GREEN), ("z", ORANGE)];
    let ends = [run.ticks.first(), run.ticks.last()];
    let mut curves = Vec::new();
    for (axis, (name, colour)) in axes.into_iter().enumerate() {
        let put_in = f64::from(gyro_offset_dps[axis]);
        if put_in != 0.0 {
            let line = ends
                .iter()
                .flatten()
                .map(|tick| (time_s(tick), Some(put_in)));
            let label = format!("{name}, put in");
            curves.push(Curve {
                faint: true,
                ..curve(&label, colour, line.collect())
            });
        }
        let bias_dps = |tick: &Tick| f64::from(tick.gyro_bias_rps[axis]).to_degrees();
        let found: Vec<_> = run
            .ticks
            .iter()
            .map(|tick| (time_s(tick), Some(bias_dps(tick))))
            .collect();
        curves.push(curve(name, colour, thinned(&found)));
    }
    curves
}

fn curve(label: &str, colour: robot_chart::Colour, points: Vec<(f64, Option<f64>)>) -> Curve {
    Curve {
        label: label.into(),
        colour,
        faint: false,
        points,
    }
}

const SUBTITLE: &str = "Root mean square errors in degrees over the scored phase, at the reference's times and at every \
    output. Plots: time in s, from the first valid estimate on.";

pub fn page(task: &Task, outcomes: &[Outcome]) -> String {
    let title = format!("Replay {}", table::title(task));
    let parts = [
        header(&title, SUBTITLE),
        errors_table(outcomes),
        outcomes
            .iter()
            .flat_map(|outcome| &outcome.plots)
            .map(Figure::html)
            .collect(),
    ];
    document(&title, &parts.concat())
}

fn errors_table(outcomes: &[Outcome]) -> String {
    let mut html = String::from(
        "<table>\n<tr><th></th><th class=\"n\" colspan=\"3\">at the samples</th>\
         <th class=\"n\" colspan=\"3\">at 1 kHz</th><th></th></tr>\n<tr><th>trial</th>",
    );
    for part in ["total", "heading", "inclination"].iter().cycle().take(6) {
        let _ = write!(html, "<th class=\"n\">{part}</th>");
    }
    html += "<th></th></tr>\n";
    for outcome in outcomes {
        let troubles: Vec<String> = table::troubles(outcome).collect();
        let figures = (outcome.at_samples, outcome.at_1khz);
        row(&mut html, &outcome.name, figures, &troubles.join("; "));
    }
    html += "<tfoot>\n";
    row(&mut html, "mean", table::means(outcomes), "");
    html + "</tfoot>\n</table>\n"
}

fn row(html: &mut String, name: &str, figures: (Option<Figures>, Option<Figures>), note: &str) {
    let cells = |figures: Option<Figures>| match figures {
        Some(f) => [f.total_deg, f.heading_deg, f.inclination_deg]
            .map(|value| format!("<td class=\"n\">{value:.2}</td>"))
            .concat(),
        None => "<td class=\"n\" colspan=\"3\">no reference</td>".to_owned(),
    };
    let _ = writeln!(
        html,
        "<tr><td>{}</td>{}{}<td class=\"soft\">{}</td></tr>",
        escaped(name),
        cells(figures.0),
        cells(figures.1),
        escaped(note)
    );
}
