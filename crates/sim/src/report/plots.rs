//! The plots of a report.

mod motion;
mod phases;

use std::ops::Range;

use plotters::style::RGBColor;
use robot_chart::{
    BLUE, ChartError, Curve, Figure, GREEN, GREY, Lane, ORANGE, PURPLE, TimePlot, draw_histogram,
    draw_lanes, draw_path,
};
use robot_plant::time;

use super::{
    Report, attitude,
    shape::{distinct, rises, spans},
};

use crate::machine::diagnostics::meaning::Meaning;

/// 1 in the movement phase of a recording; there only while one plays.
const SCORED_PHASE: &str = "truth.trial.mov";

/// Width of a bin of the release jitter histogram (`Stats::jitter_bins`).
const JITTER_BIN_US: f64 = 0.5;

/// Signals without which nothing moves.
const DRIVING: [&str; 5] = [
    "radio.vx",
    "radio.wz",
    "radio.enable",
    "can.m3508.0.current_ma",
    "can.m3508.1.current_ma",
];

const JOINTS: [(usize, &str, RGBColor); 4] = [
    (0, "left front", BLUE),
    (1, "left rear", GREEN),
    (2, "right front", ORANGE),
    (3, "right rear", PURPLE),
];

pub fn all(report: &Report) -> Result<Vec<Figure>, ChartError> {
    let marks: Vec<f64> = report
        .scenario
        .events
        .iter()
        .map(|a| time::to_seconds(a.at))
        .collect();
    let mut plots = Plots {
        report,
        marks,
        scored: Vec::new(),
    };
    let figures = match report.traces.signal(SCORED_PHASE) {
        Some(scored) => {
            plots.scored = spans(&plots.points(scored));
            plots.replayed()?
        }
        None => plots.driven()?,
    };
    Ok(figures.into_iter().flatten().collect())
}

struct Plots<'a> {
    report: &'a Report<'a>,
    marks: Vec<f64>,
    /// The span of time in which a recording was in its scored phase.
    scored: Vec<Range<f64>>,
}

type MaybeFigure = Result<Option<Figure>, ChartError>;

impl Plots<'_> {
    fn driven(&self) -> Result<Vec<Option<Figure>>, ChartError> {
        let mut figures = self.drive()?;
        figures.extend([self.timeline()?, self.attitude()?, self.attitude_error()?]);
        figures.extend([self.pitch_phase()?, self.lean_phase()?]);
        figures.extend([self.can_load()?, self.jitter()?]);
        Ok(figures)
    }

    /// The plots of a played recording: first the attitude, and the drive only if anything moves.
    fn replayed(&self) -> Result<Vec<Option<Figure>>, ChartError> {
        let mut figures = vec![self.attitude_error()?, self.attitude()?];
        if DRIVING.iter().any(|signal| self.happens(signal)) {
            figures.extend(self.drive()?);
        }
        figures.extend([self.timeline()?, self.can_load()?, self.jitter()?]);
        Ok(figures)
    }

    fn drive(&self) -> Result<Vec<Option<Figure>>, ChartError> {
        Ok(vec![
            self.sticks()?,
            self.wheels()?,
            self.currents()?,
            self.joint_angles()?,
            self.joint_torques()?,
            self.path()?,
            self.speed()?,
            self.position()?,
        ])
    }

    /// Whether a signal is ever other than 0.
    fn happens(&self, signal: &str) -> bool {
        let values = self.report.traces.signal(signal).unwrap_or_default();
        values.into_iter().flatten().any(|value| value != 0.0)
    }

    fn points(&self, values: Vec<Option<f64>>) -> Vec<(f64, Option<f64>)> {
        let times = self.report.traces.times_s();
        times.iter().copied().zip(values).collect()
    }

    /// The curve of a signal, with every value multiplied by `scale`; empty if there is no such signal.
    fn curve(&self, label: &str, signal: &str, scale: f64, colour: RGBColor) -> Curve {
        let values = self.report.traces.signal(signal).unwrap_or_default();
        let scaled = values.into_iter().map(|v| v.map(|v| v * scale)).collect();
        Curve {
            label: label.into(),
            colour,
            faint: false,
            points: self.points(scaled),
        }
    }

    fn time_plot(
        &self,
        title: &'static str,
        caption: &'static str,
        unit: &str,
        height: u32,
        curves: Vec<Curve>,
    ) -> MaybeFigure {
        let plot = TimePlot {
            unit,
            height,
            time: 0.0..time::to_seconds(self.report.result.ran).max(1e-3),
            marks: &self.marks,
            shaded: &self.scored,
            curves,
        };
        Ok(plot.draw()?.map(|svg| Figure {
            title: title.into(),
            caption: caption.into(),
            legend: plot.legend(),
            svg,
        }))
    }

    fn sticks(&self) -> MaybeFigure {
        self.time_plot(
            "Sticks",
            "What the pilot does. Dashed lines: the scenario acts.",
            "stick, −1 … 1",
            200,
            vec![
                self.curve("forward (vx)", "radio.vx", 1.0, BLUE),
                self.curve("turn left (wz)", "radio.wz", 1.0, ORANGE),
            ],
        )
    }

    fn wheels(&self) -> MaybeFigure {
        self.time_plot(
            "Wheel speed",
            "True speed of each wheel's rim, forward positive.",
            "m/s",
            260,
            vec![
                self.curve("left wheel", "truth.wheel.0.speed_mps", 1.0, BLUE),
                self.curve("right wheel", "truth.wheel.1.speed_mps", 1.0, ORANGE),
            ],
        )
    }

    fn currents(&self) -> MaybeFigure {
        self.time_plot(
            "Commanded current",
            "As each ESC decodes it from the CAN bus. It must be 0 whenever the robot is not armed.",
            "A",
            260,
            vec![
                self.curve("left wheel", "can.m3508.0.current_ma", 1e-3, BLUE),
                self.curve("right wheel", "can.m3508.1.current_ma", 1e-3, ORANGE),
            ],
        )
    }

    fn joint_angles(&self) -> MaybeFigure {
        let curves = JOINTS.map(|(joint, label, colour)| {
            let signal = format!("truth.joint.{joint}.pos_rad");
            self.curve(label, &signal, 1.0, colour)
        });
        self.time_plot(
            "Joint angle",
            "True angle of each joint, in the joints' own sense.",
            "rad",
            260,
            curves.into(),
        )
    }

    fn joint_torques(&self) -> MaybeFigure {
        let curves = JOINTS.map(|(joint, label, colour)| {
            let signal = format!("can.joint.{joint}.torque_nm");
            self.curve(label, &signal, 1.0, colour)
        });
        self.time_plot(
            "Commanded joint torque",
            "What the motor's present command asks for, as decoded from the CAN bus. It must be 0 whenever the robot is not armed.",
            "N·m",
            260,
            curves.into(),
        )
    }

    fn path(&self) -> MaybeFigure {
        let signal = |name| self.report.traces.signal(name);
        let (Some(x), Some(y)) = (signal("truth.body.x"), signal("truth.body.y")) else {
            return Ok(None);
        };
        let points: Vec<(f64, f64)> = x
            .into_iter()
            .zip(y)
            .filter_map(|(x, y)| Some((x?, y?)))
            .collect();
        if points.iter().all(|p| p.0.abs() < 1e-3 && p.1.abs() < 1e-3) {
            return Ok(None);
        }
        Ok(Some(Figure {
            title: "Path on the ground".into(),
            caption: "Seen from above; green: start, orange: end.".into(),
            legend: Vec::new(),
            svg: draw_path(&points, "m")?,
        }))
    }

    fn meaning(&self, signal: &str) -> Option<&Meaning> {
        let table = &self.report.result.table;
        table.meaning(table.index(signal)?)
    }

    fn timeline(&self) -> MaybeFigure {
        let points = |name: &str| Some(self.points(self.report.traces.signal(name)?));
        let mut rows: Vec<Lane> = Vec::new();
        for (label, signal, colour) in [
            ("enable switch", "radio.enable", GREY),
            ("e-stop switch", "radio.e_stop", ORANGE),
            ("operator enabled", "diag.operator.enabled", BLUE),
            ("estimate valid", "diag.estimate.valid", BLUE),
            ("remote failsafe", "diag.remote_diag.failsafe", ORANGE),
        ] {
            if let Some(points) = points(signal) {
                rows.push(Lane::new(label, colour, &points, |v| v != 0.0));
            }
        }
        if let Some(points) = points("diag.arming.state") {
            for state in distinct(&points) {
                let words = self
                    .meaning("diag.arming.state")
                    .and_then(|m| m.words(state as f64));
                let label = words.unwrap_or_else(|| format!("arming state {state}"));
                rows.push(Lane::new(label, GREEN, &points, |v| v == state as f64));
            }
        }
        for (label, signal, colour) in [
            ("arming blocker", "diag.arming.blockers", PURPLE),
            ("safety flag", "diag.safety.flags", ORANGE),
        ] {
            let Some(points) = points(signal) else {
                continue;
            };
            let seen = distinct(&points).into_iter().fold(0, |all, v| all | v);
            for bit in (0..64_u8).filter(|bit| seen >> bit & 1 == 1) {
                let is_on = |v: f64| v as u64 >> bit & 1 == 1;
                let name = self.meaning(signal).and_then(|m| m.bit(bit));
                let label = name.map_or_else(|| format!("{label} {bit}"), str::to_owned);
                rows.push(Lane::new(label, colour, &points, is_on));
            }
        }
        for (label, signal) in [
            ("settings written", "emu.flash.programs"),
            ("flash erased", "emu.flash.erases"),
        ] {
            let counts = points(signal).unwrap_or_default();
            let steps = rises(&counts);
            if steps.iter().any(|(_, rise)| *rise > Some(0.0)) {
                rows.push(Lane::new(label, GREY, &steps, |v| v > 0.0));
            }
        }
        if rows.is_empty() {
            return Ok(None);
        }
        let end = time::to_seconds(self.report.result.ran).max(1e-3);
        Ok(Some(Figure {
            title: "Arming and safety".into(),
            caption: "A lane is filled while it is on. Blockers in purple, safety flags in orange; the flash to 0.1 s.".into(),
            legend: Vec::new(),
            svg: draw_lanes(&rows, 0.0..end, &self.marks)?,
        }))
    }

    fn attitude(&self) -> MaybeFigure {
        let truth = ["w", "x", "y", "z"].map(|part| format!("truth.attitude.{part}"));
        let estimate = ["0", "1", "2", "3"].map(|part| format!("diag.estimate.q_wxyz.{part}"));
        let mut curves = Vec::new();
        for (names, suffix, faint) in [(truth, "truth", true), (estimate, "estimate", false)] {
            let names = names.each_ref().map(String::as_str);
            let Some(angles) = attitude::angles_deg(self.report.traces, names) else {
                continue;
            };
            let labels = [("roll", BLUE), ("pitch", GREEN), ("yaw", ORANGE)];
            for (values, (label, colour)) in angles.into_iter().zip(labels) {
                curves.push(Curve {
                    label: format!("{label}, {suffix}"),
                    colour,
                    faint,
                    points: self.points(values),
                });
            }
        }
        self.time_plot(
            "Attitude",
            "Broad lines: the plant's truth or the recording's reference. Thin lines: the firmware's estimate.",
            "°",
            300,
            curves,
        )
    }

    fn attitude_error(&self) -> MaybeFigure {
        let caption = if self.scored.is_empty() {
            "While the firmware calls its estimate valid."
        } else {
            "While the firmware calls its estimate valid. Tinted: the movement phase, which is scored."
        };
        self.time_plot(
            "Attitude error",
            caption,
            "°",
            260,
            vec![
                self.curve("total", "emu.att_error.total_deg", 1.0, GREY),
                self.curve("heading", "emu.att_error.heading_deg", 1.0, ORANGE),
                self.curve("inclination", "emu.att_error.inclination_deg", 1.0, BLUE),
            ],
        )
    }

    fn can_load(&self) -> MaybeFigure {
        self.time_plot(
            "CAN load",
            "Share of time each bus is busy, over 100 ms; budget 80 %.",
            "%",
            200,
            vec![
                self.curve("CAN1", "emu.can1.load", 100.0, BLUE),
                self.curve("CAN2", "emu.can2.load", 100.0, ORANGE),
            ],
        )
    }

    fn jitter(&self) -> MaybeFigure {
        let bins = &self.report.result.stats.jitter_bins;
        if bins.iter().all(|n| *n == 0) {
            return Ok(None);
        }
        Ok(Some(Figure {
            title: "Release jitter of the control tick".into(),
            caption: "How late each 1 kHz tick starts; budget 5 µs.".into(),
            legend: Vec::new(),
            svg: draw_histogram(bins, JITTER_BIN_US, "µs late")?,
        }))
    }
}
