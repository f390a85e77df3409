//! The Kalman filter over the errors of attitude, speed and gyro model, one piece of work a sample.
//!
//! A window of 0.2 s is worked off while the next one fills; the correction found at its end is carried forward to the
//! moment at which it is applied.

use super::{
    covariance::{Column, Correction, Covariance},
    forecast::Forecast,
    rows,
    strapdown::GyroModel,
    window::Window,
};
use crate::math::{Vector3, vector};

/// What was measured at the end of a window, less what was believed then.
#[derive(Clone, Copy, Debug)]
pub(super) struct Findings {
    /// East and north.
    pub speed: [Finding; 2],
    /// About up.
    pub heading: Option<Finding>,
    /// Gyro bias by axis, at rest.
    pub bias: Option<[Finding; 3]>,
}

#[derive(Clone, Copy, Debug)]
pub(in crate::estimation) struct Finding {
    pub innovation: f32,
    /// Variance.
    pub noise: f32,
}

#[derive(Clone, Debug)]
pub(super) struct ErrorFilter {
    pub covariance: Covariance,
    work: Option<Work>,
}

#[derive(Clone, Debug)]
struct Work {
    forecast: Forecast,
    findings: Findings,
    correction: Correction,
    done: u8,
}

const UP: usize = 2;
const SPEED: usize = 3;

impl ErrorFilter {
    pub fn new() -> Self {
        Self {
            covariance: Covariance::new(),
            work: None,
        }
    }

    /// Nothing is known of the errors any more.
    #[cold]
    #[inline(never)]
    pub fn restart(&mut self) {
        self.work = None;
        self.covariance = Covariance::new();
    }

    pub fn begin(&mut self, window: &Window, findings: Findings) {
        self.work = Some(Work {
            forecast: Forecast::new(window),
            findings,
            correction: Correction::default(),
            done: 0,
        });
    }

    /// Does the next piece. The correction once all is done.
    pub fn continue_work(&mut self) -> Option<Correction> {
        let work = self.work.as_mut()?;
        let done = work.done;
        work.done = done.saturating_add(1);
        let covariance = &mut self.covariance;
        let sound = match done {
            0..3 => {
                work.forecast.turn_axis(usize::from(done), covariance);
                true
            }
            3 => {
                work.forecast.relate(covariance);
                true
            }
            4 => {
                work.forecast.carry_fast(covariance);
                true
            }
            5 => {
                work.forecast.carry_cross(covariance);
                true
            }
            6 => work.take_speed(covariance, 0),
            7 => work.take_speed(covariance, 1),
            8 => work.take_heading(covariance),
            9..12 => work.take_bias(covariance, usize::from(done).saturating_sub(9)),
            _ => {
                let correction = work.correction;
                self.work = None;
                return Some(correction);
            }
        };
        if !sound {
            self.restart();
        }
        None
    }
}

impl Work {
    fn take_speed(&mut self, covariance: &mut Covariance, axis: usize) -> bool {
        let index = SPEED.saturating_add(axis);
        let finding = self.findings.speed.get(axis).copied();
        let so_far = self.correction.fast.get(index).copied();
        self.take(covariance, covariance.fast_column(index), finding, so_far)
    }

    fn take_heading(&mut self, covariance: &mut Covariance) -> bool {
        let so_far = self.correction.fast.get(UP).copied();
        let finding = self.findings.heading;
        self.take(covariance, covariance.fast_column(UP), finding, so_far)
    }

    fn take_bias(&mut self, covariance: &mut Covariance, axis: usize) -> bool {
        let finding = self.findings.bias.and_then(|bias| bias.get(axis).copied());
        let so_far = self.correction.parameters.get(axis).copied();
        self.take(covariance, covariance.slow_column(axis), finding, so_far)
    }

    fn take(
        &mut self,
        covariance: &mut Covariance,
        column: Option<Column>,
        finding: Option<Finding>,
        so_far: Option<f32>,
    ) -> bool {
        let (Some(column), Some(finding), Some(so_far)) = (column, finding, so_far) else {
            return true;
        };
        let innovation = finding.innovation - so_far;
        covariance.observe(&column, innovation, finding.noise, &mut self.correction)
    }
}

impl Correction {
    /// What it has grown to since its window ended: `window` is the one that fills now.
    pub fn carried_through(&self, window: &Window) -> (Vector3, [f32; 2]) {
        let [x, y, z, mut east, mut north] = self.fast;
        let [ax, ay, az] = window.accel_mps2();
        let t = window.duration_s;
        east += t * (y * az - z * ay);
        north += t * (z * ax - x * az);
        let mut turned = [0.0; 3];
        rows::products(&self.parameters, &window.turn_by_parameter, &mut turned);
        (vector::add([x, y, z], turned), [east, north])
    }

    /// Adds the slow part to the model of the gyro.
    pub fn add_to(&self, model: &mut GyroModel) {
        let [bx, by, bz, xx, xy, xz, yx, yy, yz, zx, zy, zz] = self.parameters;
        model.bias_rps = vector::add(model.bias_rps, [bx, by, bz]);
        let rows = [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]];
        for (row, by) in model.misalignment.iter_mut().zip(rows) {
            *row = vector::add(*row, by);
        }
    }
}

#[cfg(test)]
mod tests;
