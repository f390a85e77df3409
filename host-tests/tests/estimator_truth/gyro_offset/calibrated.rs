//! A calibration removes the bias from the samples and says so.

use crate::{figures::Figures, motion::Motion, run::Run, sensors::Sensors};

const OFFSET_DPS: [f64; 3] = [3.0, -2.0, 4.0];
const CALIBRATED_S: f64 = 15.0;

/// The estimator's own bias is reset. The samples change by 5.4 °/s, but that is no rotation.
#[test]
fn a_bias_removed_by_a_calibration_is_no_rotation() {
    let mut figures = Figures::default();
    for sensors in [Sensors::real(), Sensors::real().without_mag()] {
        let mut sensors = sensors.with_offset(OFFSET_DPS);
        sensors.removed_bias_dps =
            Box::new(|t| OFFSET_DPS.map(|part| if t < CALIBRATED_S { 0.0 } else { part }));
        let mut run = Run::new(Motion::at_rest(), sensors);
        run.skip(CALIBRATED_S - 0.1);
        let worst = run.worst(CALIBRATED_S + 30.0);
        figures.at_most(
            "calibrated, heading drift in °",
            worst.heading_drift_deg,
            0.5,
        );
        figures.at_most("calibrated, inclination in °", worst.inclination_deg, 0.5);
        figures.at_most("calibrated, offset in °/s", run.bias_error_dps(), 0.05);
    }
    figures.done();
}
