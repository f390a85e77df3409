//! The firmware's estimate of the motion beside the truth.

use robot_chart::{BLUE, Curve, GREEN, ORANGE};

use super::{MaybeFigure, Plots, attitude};

impl Plots<'_> {
    /// The plot of the speeds, if the robot or its wheels move.
    pub(super) fn speed(&self) -> MaybeFigure {
        let mut truth = self.curve("robot, truth", "truth.body.vx", 1.0, BLUE);
        truth.faint = true;
        let mut curves = vec![truth];
        if let Some(points) = self.estimated_forward() {
            curves.push(Curve {
                label: "robot, estimate".into(),
                colour: BLUE,
                faint: false,
                points,
            });
        }
        curves.push(self.curve("left wheel", "truth.wheel.0.speed_mps", 1.0, ORANGE));
        self.time_plot(
            "Speed over ground",
            "Forward. Broad line: the plant's truth; thin: the firmware's estimate. Where the wheel's rim runs off, it slips.",
            "m/s",
            260,
            curves,
        )
    }

    /// Velocity of the estimate along its own heading.
    fn estimated_forward(&self) -> Option<Vec<(f64, Option<f64>)>> {
        let names = ["0", "1", "2", "3"].map(|part| format!("diag.estimate.q_wxyz.{part}"));
        let angles = attitude::angles_deg(self.report.traces, names.each_ref().map(String::as_str));
        let [_, _, yaw_deg] = angles?;
        let east = self.report.traces.signal("diag.estimate.vel_mps.0")?;
        let north = self.report.traces.signal("diag.estimate.vel_mps.1")?;
        let forward = yaw_deg.into_iter().zip(east.into_iter().zip(north));
        let forward = forward.map(|(yaw_deg, (east, north))| {
            let (sin, cos) = yaw_deg?.to_radians().sin_cos();
            Some(cos * east? + sin * north?)
        });
        Some(self.points(forward.collect()))
    }

    pub(super) fn position(&self) -> MaybeFigure {
        let axes = [("x", 0, BLUE), ("y", 1, GREEN)];
        let mut curves = Vec::new();
        for (axis, index, colour) in axes {
            let truth = format!("truth.body.{axis}");
            if !self.happens(&truth) {
                continue;
            }
            let mut truth = self.curve(&format!("{axis}, truth"), &truth, 1.0, colour);
            truth.faint = true;
            let estimate = format!("diag.estimate.pos_m.{index}");
            let estimate = self.curve(&format!("{axis}, estimate"), &estimate, 1.0, colour);
            curves.extend([truth, estimate]);
        }
        self.time_plot(
            "Position",
            "x to the east, y to the north of the place of booting. Broad lines: the plant's truth; thin: the firmware's estimate.",
            "m",
            260,
            curves,
        )
    }
}
