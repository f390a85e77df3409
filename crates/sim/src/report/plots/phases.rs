//! Phase plots of a free robot: how it tips, and how its lean goes with its speed.

use robot_chart::{Figure, Phase};

use super::{MaybeFigure, Plots};

impl Plots<'_> {
    /// Pitch rate over pitch.
    pub(super) fn pitch_phase(&self) -> MaybeFigure {
        let (Some(_), Some(pitch), Some(rate)) = (
            self.report.traces.signal("truth.leg.0.length_m"),
            self.report.traces.signal("truth.body.pitch"),
            self.report.traces.signal("truth.imu.gy"),
        ) else {
            return Ok(None);
        };
        let points = paired(pitch, rate, [f64::to_degrees, f64::to_degrees]);
        phase(
            "Pitch and its rate",
            "Truth. A robot that balances winds into a point; one that falls runs away. Green: start, orange: end.",
            ["pitch, nose down, °", "pitch rate, °/s"],
            points,
        )
    }

    /// Speed over the legs' lean in the world.
    pub(super) fn lean_phase(&self) -> MaybeFigure {
        let signal = |name: &str| self.report.traces.signal(name);
        let (Some(pitch), Some(left), Some(right), Some(speed)) = (
            signal("truth.body.pitch"),
            signal("truth.leg.0.angle_rad"),
            signal("truth.leg.1.angle_rad"),
            signal("truth.body.vx"),
        ) else {
            return Ok(None);
        };
        let legs = left.into_iter().zip(right);
        let lean = pitch
            .into_iter()
            .zip(legs)
            .map(|(pitch, (left, right))| Some(pitch? - (left? + right?) / 2.0));
        let points = paired(lean.collect(), speed, [f64::to_degrees, |mps| mps]);
        phase(
            "Lean and speed",
            "Truth. Lean is the legs' angle in the world, positive with the hips ahead of the wheels: it leads the speed.",
            ["lean, °", "speed, m/s"],
            points,
        )
    }
}

fn paired(
    x: Vec<Option<f64>>,
    y: Vec<Option<f64>>,
    scales: [fn(f64) -> f64; 2],
) -> Vec<(f64, f64)> {
    let pairs = x.into_iter().zip(y);
    pairs
        .filter_map(|(x, y)| Some((scales[0](x?), scales[1](y?))))
        .collect()
}

fn phase(title: &str, caption: &str, labels: [&str; 2], points: Vec<(f64, f64)>) -> MaybeFigure {
    if points.is_empty() {
        return Ok(None);
    }
    let [x_label, y_label] = labels;
    let plot = Phase {
        x_label,
        y_label,
        points,
    };
    Ok(Some(Figure {
        title: title.into(),
        caption: caption.into(),
        legend: Vec::new(),
        svg: plot.draw()?,
    }))
}
