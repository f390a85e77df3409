//! The page on a magnetometer calibration.

use robot_chart::{ChartError, Cloud, Figure, before_and_after, document, header, table};

use crate::calibration::mag::MagFit;

/// Returns the page with the samples before and after, and the correction.
pub fn mag_report(fit: &MagFit) -> Result<String, ChartError> {
    let before: Vec<[f64; 3]> = fit.samples.iter().map(|v| (*v).into()).collect();
    let corrected = fit.samples.iter().map(|v| fit.correction.apply(*v));
    let after: Vec<[f64; 3]> = corrected.map(Into::into).collect();
    let cloud = Cloud {
        before: &before,
        after: &after,
        radius: fit.field_ut,
    };
    let figure = Figure {
        title: "The field seen along each axis".to_owned(),
        caption: "The circle is a field of equal strength in all attitudes.".to_owned(),
        legend: before_and_after(),
        svg: cloud.draw("µT")?,
    };
    let title = "Magnetometer calibration";
    let summary = format!(
        "{} samples, {} left out, {:.0} % of all directions. Strength {:.2} µT; it varies (root mean square) by {:.2} µT \
         before and {:.2} µT after.",
        fit.samples.len(),
        fit.rejected,
        fit.coverage.share * 100.0,
        fit.field_ut,
        fit.residual_before_ut,
        fit.residual_after_ut
    );
    let parts = [
        header(title, &summary),
        correction_table(fit),
        figure.html(),
    ];
    Ok(document(title, &parts.concat()))
}

fn correction_table(fit: &MagFit) -> String {
    let correction = &fit.correction;
    let rows: Vec<_> = ["x", "y", "z"]
        .iter()
        .enumerate()
        .map(|(axis, name)| {
            let mut row = vec![
                (*name).to_owned(),
                format!("{:+.2}", correction.bias_ut[axis]),
            ];
            row.extend(
                (0..3).map(|column| format!("{:+.4}", correction.soft_iron[(axis, column)])),
            );
            row
        })
        .collect();
    table(&["axis", "offset, µT", "soft iron", "", ""], &rows)
}
