//! The page on an accelerometer calibration.

use robot_chart::{ChartError, Figure, before_and_after, document, draw_residuals, header, table};

use crate::calibration::accel::{AccelCorrection, AccelFit, Face, GRAVITY_MPS2, StillWindow};

/// Returns the page with all positions, their errors before and after, and the correction.
pub fn accel_report(fit: &AccelFit) -> Result<String, ChartError> {
    let errors = |c: &AccelCorrection| -> Vec<f64> {
        fit.windows.iter().map(|w| error_mps2(c, w)).collect()
    };
    let figure = Figure {
        title: "Error of gravity in each still position".to_owned(),
        caption: "Zero is 1 g.".to_owned(),
        legend: before_and_after(),
        svg: draw_residuals(
            &errors(&AccelCorrection::NONE),
            &errors(&fit.correction),
            "m/s²",
        )?,
    };
    let title = "Accelerometer calibration";
    let summary = format!(
        "{} positions, {} left out. Error (root mean square) {:.4} m/s² before, {:.4} after.",
        fit.windows.len(),
        fit.rejected.len(),
        fit.residual_before_mps2,
        fit.residual_after_mps2
    );
    let parts = [
        header(title, &summary),
        correction_table(&fit.correction),
        figure.html(),
        position_table(fit),
    ];
    Ok(document(title, &parts.concat()))
}

fn error_mps2(correction: &AccelCorrection, window: &StillWindow) -> f64 {
    correction.apply(window.mean_mps2).norm() - GRAVITY_MPS2
}

fn correction_table(correction: &AccelCorrection) -> String {
    let rows: Vec<_> = ["x", "y", "z"]
        .iter()
        .enumerate()
        .map(|(axis, name)| {
            vec![
                (*name).to_owned(),
                format!("{:+.4}", correction.bias_mps2[axis]),
                format!("{:.5}", correction.scale[axis]),
            ]
        })
        .collect();
    table(&["axis", "offset, m/s²", "scale"], &rows)
}

fn position_table(fit: &AccelFit) -> String {
    let used = fit.windows.iter().zip(1..).map(|(w, n)| (w, n.to_string()));
    let left_out = fit.rejected.iter().map(|w| (w, "left out".to_owned()));
    let rows: Vec<_> = used
        .chain(left_out)
        .map(|(window, number)| {
            let up = Face::up(window.mean_mps2).map_or("slanted", Face::describe);
            vec![
                format!("{number}: {up}"),
                format!("{:.1} – {:.1}", window.start_s, window.end_s),
                format!("{:+.4}", error_mps2(&AccelCorrection::NONE, window)),
                format!("{:+.4}", error_mps2(&fit.correction, window)),
            ]
        })
        .collect();
    table(
        &["position", "time, s", "error before, m/s²", "after"],
        &rows,
    )
}
