//! The Kalman filter over the errors of attitude, speed and gyro model, one piece of work a sample.
//!
//! A window of 0.2 s is worked off while the next one fills; the correction found at its end is carried forward to the
//! moment at which it is applied.

use super::{
    covariance::{BIAS, Covariance, Lesson, Row, SPEED, UP, parameters},
    forecast::Forecast,
    rows,
    strapdown::GyroModel,
    window::Window,
};
use crate::math::{Vector3, vector};

/// What was measured at the end of a window, less what was believed then.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::estimation) struct Finding {
    pub innovation: f32,
    /// Variance.
    pub noise: f32,
}

/// Of speed east and north, heading, gyro bias by axis.
pub(super) type Findings = [Option<Finding>; 6];
/// The errors that they are of.
const MEASURED: [usize; 6] = [SPEED, SPEED + 1, UP, BIAS, BIAS + 1, BIAS + 2];

/// One correction of all that is estimated.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Correction {
    errors: Row,
}

#[derive(Clone, Debug)]
pub(super) struct ErrorFilter {
    pub covariance: Covariance,
    /// The window that is worked off: pieces of work done, none once all are.
    done: Option<u8>,
    forecast: Forecast,
    findings: Findings,
    lesson: Lesson,
    correction: Correction,
    /// See [`Covariance::doubt_turn`].
    unseen_rad: Option<[Vector3; 3]>,
}

impl ErrorFilter {
    pub fn new() -> Self {
        let mut covariance = Covariance::new();
        covariance.restart();
        Self {
            covariance,
            done: None,
            forecast: Forecast::default(),
            findings: Findings::default(),
            lesson: Lesson::default(),
            correction: Correction::default(),
            unseen_rad: None,
        }
    }

    /// Nothing is known of the errors any more.
    #[cold]
    pub fn restart(&mut self) {
        self.done = None;
        self.unseen_rad = None;
        self.covariance.restart();
    }

    /// Rest has shown where up is; see [`Covariance::know_up`].
    #[cold]
    pub fn know_up(&mut self, turn_variance: f32) {
        self.done = None;
        self.unseen_rad = None;
        self.covariance.know_up(turn_variance);
    }

    /// In the window that is about to be worked off.
    pub fn doubt_turn(&mut self, unseen_rad: [Vector3; 3]) {
        self.unseen_rad = Some(unseen_rad);
    }

    /// Nothing that was not seen waits to be taken into account.
    pub const fn is_up_to_date(&self) -> bool {
        self.unseen_rad.is_none()
    }

    /// The gyro bias is another one from now on; what was being found out of the old one is not added to it.
    #[cold]
    pub fn replace_bias(&mut self, variance: f32) {
        self.covariance.replace_bias(variance);
        let [_, _, _, bias @ ..] = &mut self.findings;
        *bias = [None; 3];
        let [_, _, _, _, _, x, y, z, ..] = &mut self.correction.errors;
        (*x, *y, *z) = (0.0, 0.0, 0.0);
    }

    pub fn begin(&mut self, window: &Window, findings: Findings) {
        self.forecast.begin(window);
        self.findings = findings;
        self.correction = Correction::default();
        self.done = Some(0);
    }

    /// Does the next piece. The correction once all is done.
    pub fn continue_work(&mut self) -> Option<&Correction> {
        let done = self.done?;
        self.done = Some(done.saturating_add(1));
        match done {
            0..3 => self.forecast.turn_axis(done.into(), &self.covariance),
            3 => self.forecast.carry_rows(&mut self.covariance),
            4 => self.forecast.carry_columns(&mut self.covariance),
            5 => {
                self.forecast.add_noise(&mut self.covariance);
                if let Some(unseen_rad) = self.unseen_rad.take() {
                    self.covariance.doubt_turn(&unseen_rad);
                }
            }
            6..18 => self.learn(done.saturating_sub(6)),
            _ => {
                self.done = None;
                return Some(&self.correction);
            }
        }
        None
    }

    /// Each finding in two pieces.
    fn learn(&mut self, piece: u8) {
        let order = usize::from(piece / 2);
        let (Some(Some(finding)), Some(error)) = (self.findings.get(order), MEASURED.get(order))
        else {
            return;
        };
        if !piece.is_multiple_of(2) {
            self.covariance.end_lesson(&self.lesson);
            return;
        }
        let (correction, lesson) = (&mut self.correction.errors, &mut self.lesson);
        if !self
            .covariance
            .begin_lesson(*error, finding, correction, lesson)
        {
            self.restart();
        }
    }
}

impl Correction {
    /// What it has grown to since its window ended: `window` is the one that fills now.
    pub fn carried_through(&self, window: &Window) -> (Vector3, [f32; 2]) {
        let [x, y, z, east, north, ..] = self.errors;
        let t = window.duration_s;
        let [ax, ay, az] = vector::scale(window.accel_mps2(), t);
        let speed_mps = [east + y * az - z * ay, north + z * ax - x * az];
        let turned = window
            .turn_by_parameter
            .each_ref()
            .map(|turn| rows::product(parameters(&self.errors), turn));
        (vector::add([x, y, z], turned), speed_mps)
    }

    /// Adds the slow part to the model of the gyro.
    pub fn add_to(&self, model: &mut GyroModel) {
        let [_, _, _, _, _, bx, by, bz, misalignment @ ..] = &self.errors;
        model.bias_rps = vector::add(model.bias_rps, [*bx, *by, *bz]);
        let parts = model.misalignment.as_flattened_mut().iter_mut();
        for (part, more) in parts.zip(misalignment) {
            *part += more;
        }
    }
}

#[cfg(test)]
mod tests;
