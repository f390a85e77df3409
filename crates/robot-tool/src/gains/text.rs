//! Tables for the terminal.

use std::fmt::Write;

use robot_balance_design::Margins;

use super::study::{AtLength, Study, settled_s};

const STATES: [&str; 10] = [
    "s", "s'", "yaw", "yaw'", "lean l", "lean l'", "lean r", "lean r'", "pitch", "pitch'",
];

pub fn tables(study: &Study) -> String {
    let robot = &study.robot;
    let mut text = format!(
        "{}: {:.2} kg, torques {} ms late\n",
        robot.name,
        robot.total_mass_kg(),
        study.delay_ms
    );
    for at in study.shown() {
        text += &length(at);
    }
    text += &margins_over_length(study);
    let schedule = &study.schedule;
    let _ = writeln!(
        text,
        "\nfit: quadratic in both lengths from {:.2} to {:.2} m, off by at most {:.1} % of a gain's largest value",
        schedule.min_m,
        schedule.max_m,
        100.0 * schedule.worst_fit
    );
    for (push_mps, samples) in &study.pushes {
        let outcome = match settled_s(samples) {
            Some(time_s) => format!("within 5 cm/s and 2 degrees after {time_s:.2} s"),
            None => "falls".to_owned(),
        };
        let _ = writeln!(text, "push of {push_mps:.1} m/s: {outcome}");
    }
    text
}

fn length(at: &AtLength) -> String {
    let mut text = format!(
        "\nlegs {:.3} m: lean {:.3} rad, torque on each leg {:.2} N m\n{:<12}",
        at.length_m,
        unsigned_zero(at.equilibrium.lean_rad),
        unsigned_zero(at.equilibrium.leg_torque_nm[0]),
        "N m per"
    );
    for state in STATES {
        let _ = write!(text, "{state:>9}");
    }
    for (name, row) in ["left wheel", "right wheel", "left leg", "right leg"]
        .iter()
        .zip(at.gains.row_iter())
    {
        let _ = write!(text, "\n{name:<12}");
        for gain in row.iter() {
            let _ = write!(text, "{gain:9.3}");
        }
    }
    text += "\npoles, 1/s: ";
    for [re, im] in &at.poles {
        if *im > 1e-6 {
            let _ = write!(text, " {re:.1}±{im:.1}i");
        } else if *im > -1e-6 {
            let _ = write!(text, " {re:.1}");
        }
    }
    text + "\n"
}

fn margins_over_length(study: &Study) -> String {
    let mut text = String::from(
        "\nlength   wheel: gain    phase  to -1   leg: gain      phase  to -1   more delay  largest push\n",
    );
    for at in &study.lengths {
        let _ = writeln!(
            text,
            "{:.3} m  {}   {}   {:>7} ms  {:>8.2} m/s",
            at.length_m,
            margin(&at.wheel),
            margin(&at.leg),
            at.extra_delay_ms,
            at.largest_push_mps
        );
    }
    text
}

fn margin(margins: &Margins) -> String {
    let gain = format!("{:.2}..{:.1}", margins.least_gain, margins.most_gain);
    format!(
        "{gain:<10}  {:>4.0} deg  {:.2}",
        margins.phase_rad.to_degrees(),
        margins.modulus
    )
}

/// A number that is zero to a millionth has no sign.
fn unsigned_zero(value: f64) -> f64 {
    if value.abs() < 1e-6 { 0.0 } else { value }
}
