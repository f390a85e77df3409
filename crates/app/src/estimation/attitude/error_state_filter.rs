//! The error-state Kalman filter of attitude, velocity and gyro model, one small step a sample.
//!
//! A window of 0.2 s is processed while the next one fills. The correction found for its end is then propagated to the
//! moment at which it is applied.

use super::{
    covariance::{Covariance, ScalarUpdate},
    error_state::{self, BIAS, ErrorVector, HEADING, SPEED, gyro_parameters},
    prediction::Prediction,
    window::Window,
};
use crate::{
    estimation::{measurement::Measurement, strapdown::GyroModel},
    math::{Vector3, vector},
};

/// Measurements at the end of a window: velocity east and north, heading, gyro bias x, y, z.
pub(super) type Measurements = [Option<Measurement>; 6];
/// The error state that each of them measures.
const MEASURED_STATES: [usize; 6] = [SPEED, SPEED + 1, HEADING, BIAS, BIAS + 1, BIAS + 2];

/// Estimate of the errors, to be added to the nominal state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Correction {
    errors: ErrorVector,
}

/// The filter. Its work on one window is 19 steps long.
#[derive(Clone, Debug)]
pub(super) struct ErrorStateFilter {
    pub covariance: Covariance,
    /// Steps done for the current window; none while there is nothing to do.
    done: Option<u8>,
    prediction: Prediction,
    measurements: Measurements,
    update: ScalarUpdate,
    correction: Correction,
    /// See [`Covariance::add_lost_rotation`].
    lost_rotation_rad: Option<[Vector3; 3]>,
}

impl ErrorStateFilter {
    pub fn new() -> Self {
        let mut covariance = Covariance::new();
        covariance.reset();
        Self {
            covariance,
            done: None,
            prediction: Prediction::default(),
            measurements: Measurements::default(),
            update: ScalarUpdate::default(),
            correction: Correction::default(),
            lost_rotation_rad: None,
        }
    }

    /// Resets the covariance to its initial values and drops the current window.
    #[cold]
    pub fn reset(&mut self) {
        self.done = None;
        self.lost_rotation_rad = None;
        self.covariance.reset();
    }

    /// Resets the tilt after levelling at rest, and drops the current window; see [`Covariance::reset_tilt`].
    #[cold]
    pub fn reset_tilt(&mut self, added_heading_variance: f32) {
        self.done = None;
        self.lost_rotation_rad = None;
        self.covariance.reset_tilt(added_heading_variance);
    }

    /// Notes the rotation that was lost in the window to begin; see [`Covariance::add_lost_rotation`].
    pub fn add_lost_rotation(&mut self, lost_rotation_rad: [Vector3; 3]) {
        self.lost_rotation_rad = Some(lost_rotation_rad);
    }

    /// True while a lost rotation is not in the covariance yet.
    pub const fn has_lost_rotation_to_add(&self) -> bool {
        self.lost_rotation_rad.is_some()
    }

    /// Resets the gyro bias to `variance`, (rad/s)². The current window then corrects it no more.
    #[cold]
    pub fn reset_bias(&mut self, variance: f32) {
        self.covariance.reset_bias(variance);
        let [_, _, _, bias @ ..] = &mut self.measurements;
        *bias = [None; 3];
        let [_, _, _, _, _, x, y, z, ..] = &mut self.correction.errors;
        (*x, *y, *z) = (0.0, 0.0, 0.0);
    }

    /// Starts processing a window that has ended.
    pub fn begin(&mut self, window: &Window, measurements: Measurements) {
        self.prediction.begin(window);
        self.measurements = measurements;
        self.correction = Correction::default();
        self.done = Some(0);
    }

    /// Does the next step. Returns the correction once all are done.
    pub fn step(&mut self) -> Option<&Correction> {
        let done = self.done?;
        self.done = Some(done.saturating_add(1));
        match done {
            0..3 => self
                .prediction
                .correlate_rotation(done.into(), &self.covariance),
            3 => self.prediction.propagate_rows(&mut self.covariance),
            4 => self.prediction.propagate_columns(&mut self.covariance),
            5 => {
                self.prediction.add_process_noise(&mut self.covariance);
                if let Some(lost_rotation_rad) = self.lost_rotation_rad.take() {
                    self.covariance.add_lost_rotation(&lost_rotation_rad);
                }
            }
            6..18 => self.update_step(done.saturating_sub(6)),
            _ => {
                self.done = None;
                return Some(&self.correction);
            }
        }
        None
    }

    /// One of the two steps of an update with one measurement.
    fn update_step(&mut self, step: u8) {
        let order = usize::from(step / 2);
        let (Some(Some(measurement)), Some(state)) =
            (self.measurements.get(order), MEASURED_STATES.get(order))
        else {
            return;
        };
        if !step.is_multiple_of(2) {
            self.covariance.finish_update(&self.update);
            return;
        }
        let (correction, update) = (&mut self.correction.errors, &mut self.update);
        if !self
            .covariance
            .begin_update(*state, measurement, correction, update)
        {
            self.reset();
        }
    }
}

impl Correction {
    /// The corrections of angle (rad, ENU) and velocity (m/s, east and north), propagated from the end of their window
    /// through `window`, the one that is filling now.
    pub fn propagated_through(&self, window: &Window) -> (Vector3, [f32; 2]) {
        let [x, y, z, east, north, ..] = self.errors;
        let t = window.duration_s;
        let [ax, ay, az] = vector::scale(window.accel_mps2(), t);
        let speed_mps = [east + y * az - z * ay, north + z * ax - x * az];
        let rotated = window
            .angle_jacobian
            .each_ref()
            .map(|jacobian| error_state::dot(gyro_parameters(&self.errors), jacobian));
        (vector::add([x, y, z], rotated), speed_mps)
    }

    /// Adds the corrections of bias and misalignment to the gyro model.
    pub fn apply_to(&self, model: &mut GyroModel) {
        let [_, _, _, _, _, bx, by, bz, misalignment @ ..] = &self.errors;
        model.bias_rps = vector::add(model.bias_rps, [*bx, *by, *bz]);
        let parts = model.misalignment.as_flattened_mut().iter_mut();
        for (part, error) in parts.zip(misalignment) {
            *part += error;
        }
    }
}

#[cfg(test)]
mod tests;
