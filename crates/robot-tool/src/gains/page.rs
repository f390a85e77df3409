//! The page with the plots.

use robot_balance_design::Sample;
use robot_chart::{
    BLUE, ChartError, Colour, Curve, Figure, GREEN, GREY, Legend, ORANGE, TimePlot, document,
    header, paragraph,
};

use super::{
    over_length::{self, Line},
    study::{AtLength, Study},
};

const COLOURS: [Colour; 3] = [GREEN, BLUE, ORANGE];

/// Returns the page.
pub fn html(study: &Study) -> Result<String, ChartError> {
    let title = format!("Balance of {}", study.robot.name);
    let subtitle = format!(
        "{:.2} kg, torques {} ms late",
        study.robot.total_mass_kg(),
        study.delay_ms
    );
    let mut body = header(&title, &subtitle);
    body += &paragraph(
        "Responses start from standing with legs of middle length, friction 0.6 and the motors' limits.",
    );
    let pushes = [
        Quantity("speed of the body", "m/s", |s| s.body_mps),
        Quantity("speed of the axles", "m/s", |s| s.axle_mps),
        Quantity("lean of the legs", "rad", |s| s.lean_rad),
        Quantity("pitch of the body", "rad", |s| s.pitch_rad),
        Quantity("torque of a wheel", "N m", |s| s.wheel_nm),
    ];
    for quantity in &pushes {
        body += &push(study, quantity)?;
    }
    body += &step(study)?;
    body += &over_lengths(study)?;
    Ok(document(&title, &body))
}

/// Name, unit and value.
struct Quantity(&'static str, &'static str, fn(&Sample) -> f64);

fn push(study: &Study, Quantity(name, unit, value): &Quantity) -> Result<String, ChartError> {
    let curves = study.pushes.iter().zip(COLOURS);
    let curves = curves.map(|((push_mps, samples), colour)| {
        curve(format!("{push_mps:.1} m/s"), colour, false, samples, value)
    });
    figure(
        format!("Pushed: {name}"),
        "A push at the body's centre of mass; the momentum is that of the whole robot at the speed given. A line that ends is a fall.",
        unit,
        curves.collect(),
    )
}

fn step(study: &Study) -> Result<String, ChartError> {
    let curves = vec![
        curve("asked".to_owned(), GREY, true, &study.step, &|s| {
            s.asked_mps
        }),
        curve("body".to_owned(), BLUE, false, &study.step, &|s| s.body_mps),
        curve("axles".to_owned(), ORANGE, false, &study.step, &|s| {
            s.axle_mps
        }),
    ];
    let speed = figure(
        "Asked for 1 m/s: speed".to_owned(),
        "The wheels first go back, so that the robot leans into its way.",
        "m/s",
        curves,
    )?;
    let curves = vec![
        curve("lean".to_owned(), BLUE, false, &study.step, &|s| s.lean_rad),
        curve("pitch".to_owned(), ORANGE, false, &study.step, &|s| {
            s.pitch_rad
        }),
    ];
    let angles = figure(
        "Asked for 1 m/s: angles".to_owned(),
        "Legs lean, the body stays level.",
        "rad",
        curves,
    )?;
    Ok(speed + &angles)
}

/// A line over the leg length: its label, its colour and its value.
type Measure = (&'static str, Colour, fn(&AtLength) -> f64);

fn over_lengths(study: &Study) -> Result<String, ChartError> {
    let phase: [Measure; 2] = [
        ("wheel", BLUE, |at| at.wheel.phase_rad.to_degrees()),
        ("leg", ORANGE, |at| at.leg.phase_rad.to_degrees()),
    ];
    let modulus: [Measure; 2] = [
        ("wheel", BLUE, |at| at.wheel.modulus),
        ("leg", ORANGE, |at| at.leg.modulus),
    ];
    let delay: [Measure; 1] = [("all torques", BLUE, |at| at.extra_delay_ms as f64)];
    let push: [Measure; 1] = [("push", BLUE, |at| at.largest_push_mps)];
    Ok(over_length_figure(
        study,
        &phase,
        "Phase margin over leg length",
        "degrees",
        "The loop is broken at one input, with the file's delay.",
    )? + &over_length_figure(
        study,
        &modulus,
        "Distance from −1 over leg length",
        "",
        "0.5 stands for a gain margin of at least 2 and a phase margin of at least 29 degrees.",
    )? + &over_length_figure(
        study,
        &delay,
        "More delay over leg length",
        "ms",
        "The loop holds with this much delay beyond the file's, up to 40 ms.",
    )? + &over_length_figure(
        study,
        &push,
        "Largest push over leg length",
        "m/s",
        "The robot does not fall over, with friction 0.6 and the motors' limits.",
    )?)
}

fn over_length_figure(
    study: &Study,
    measures: &[Measure],
    title: &str,
    unit: &str,
    caption: &str,
) -> Result<String, ChartError> {
    let lines: Vec<_> = measures
        .iter()
        .map(|(_, colour, value)| Line {
            colour: *colour,
            points: study
                .lengths
                .iter()
                .map(|at| (at.length_m, value(at)))
                .collect(),
        })
        .collect();
    let legend = measures.iter().map(|(label, colour, _)| Legend {
        label: (*label).to_owned(),
        colour: *colour,
        faint: false,
    });
    let figure = Figure {
        title: title.to_owned(),
        caption: caption.to_owned(),
        legend: legend.collect(),
        svg: over_length::draw(&lines, unit)?,
    };
    Ok(figure.html())
}

fn curve(
    label: String,
    colour: Colour,
    faint: bool,
    samples: &[Sample],
    value: &dyn Fn(&Sample) -> f64,
) -> Curve {
    // Every fifth tick is enough for the eye.
    let samples = samples.iter().step_by(5);
    Curve {
        label,
        colour,
        faint,
        points: samples.map(|s| (s.time_s, Some(value(s)))).collect(),
    }
}

fn figure(
    title: String,
    caption: &str,
    unit: &str,
    curves: Vec<Curve>,
) -> Result<String, ChartError> {
    let end_s = curves
        .iter()
        .flat_map(|curve| curve.points.last())
        .map(|point| point.0)
        .fold(0.0, f64::max);
    let plot = TimePlot {
        unit,
        height: 240,
        time: 0.0..end_s,
        marks: &[],
        shaded: &[],
        curves,
    };
    let figure = Figure {
        title,
        caption: caption.to_owned(),
        legend: plot.legend(),
        svg: plot.draw()?.unwrap_or_default(),
    };
    Ok(figure.html())
}
