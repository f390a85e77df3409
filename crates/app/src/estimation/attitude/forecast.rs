//! How the errors grow over one window, in small pieces of work.
//!
//! Over a window of T seconds with mean specific force a the errors of angle θ, speed v and gyro parameters p go
//!
//! θ ← θ + Φ·p, v ← κ·v + C·(θ + Φ·p/2), C·θ = T·θ × a
//!
//! (only the level parts of v). Φ is [`Window::turn_by_parameter`], κ what is left of a speed. Applied to the rows of the
//! covariance and then to its columns these lines carry it forward; noise is added.

use super::{
    covariance::{BIAS, Covariance, Row, parameters},
    rows,
    strapdown::SPEED_MEMORY_S,
    window::{Parameters, Window},
};
use crate::math::{Vector3, vector};

const DEG: f32 = 1.0_f32.to_radians();
/// What the model leaves out turns the attitude like white noise: 0.15 °/√s …
const TURN_DENSITY: f32 = (0.15 * DEG) * (0.15 * DEG);
/// … and more while turning, rad per √rad of it: gyros are not quite linear.
const TURN_SHARE: f32 = 0.0002 * 0.0002;
/// The gyro bias wanders by 0.0045 °/s in a second, as a random walk.
const BIAS_DENSITY: f32 = (0.0045 * DEG) * (0.0045 * DEG);
/// Acceleration that may go unseen while the accelerometer is beyond its range, m/s².
const BLIND_ACCEL_MPS2: f32 = 200.0;

/// What the forecast needs of a window that is over.
#[derive(Clone, Debug, Default)]
pub(super) struct Forecast {
    /// Φ.
    turn_by_parameter: [Parameters; 3],
    /// Rows of C.
    speed_by_angle: [Vector3; 2],
    /// κ.
    kept: f32,
    turn_noise: f32,
    speed_noise: f32,
    bias_noise: f32,
    /// Covariance of Φ·p with all errors.
    turns: [Row; 3],
}

impl Forecast {
    pub fn begin(&mut self, window: &Window) {
        let t = window.duration_s;
        let [ax, ay, az] = vector::scale(window.accel_mps2(), t);
        let blind_mps = BLIND_ACCEL_MPS2 * window.blind_s;
        let forgotten = t / SPEED_MEMORY_S;
        self.turn_by_parameter = window.turn_by_parameter;
        self.speed_by_angle = [[0.0, az, -ay], [-az, 0.0, ax]];
        self.kept = 1.0 - forgotten + 0.5 * forgotten * forgotten;
        self.turn_noise =
            TURN_DENSITY * t + TURN_SHARE * window.turned_rad2_per_s + window.unseen_rad2;
        self.speed_noise = blind_mps * blind_mps;
        self.bias_noise = BIAS_DENSITY * t;
    }

    /// What the turn about one axis has to do with all errors.
    pub fn turn_axis(&mut self, axis: usize, covariance: &Covariance) {
        let row = self.turn_by_parameter.get(axis);
        if let (Some(weights), Some(turn)) = (row, self.turns.get_mut(axis)) {
            for (to, row) in turn.iter_mut().zip(&covariance.rows) {
                *to = rows::product(weights, parameters(row));
            }
        }
    }

    pub fn carry_rows(&self, covariance: &mut Covariance) {
        self.turn_halfway(covariance);
        let [x, y, z, speeds @ ..] = &mut covariance.rows;
        for (speed, by_angle) in speeds.iter_mut().zip(&self.speed_by_angle) {
            let before = *speed;
            rows::add(speed, self.kept - 1.0, &before);
            for (angle, factor) in [&*x, y, z].into_iter().zip(by_angle) {
                rows::add(speed, *factor, angle);
            }
        }
        self.turn_halfway(covariance);
    }

    #[inline(never)]
    fn turn_halfway(&self, covariance: &mut Covariance) {
        for (angle, turn) in covariance.rows.iter_mut().zip(&self.turns) {
            rows::add(angle, 0.5, turn);
        }
    }

    pub fn carry_columns(&self, covariance: &mut Covariance) {
        for row in covariance.rows.iter_mut().take(BIAS) {
            let turned = self
                .turn_by_parameter
                .each_ref()
                .map(|weights| rows::product(weights, parameters(row)));
            let [x, y, z, east, north, ..] = row;
            let halfway = vector::scale(turned, 0.5);
            let angles = vector::add([*x, *y, *z], halfway);
            let [by_east, by_north] = self.speed_by_angle;
            *east = self.kept * *east + vector::dot(by_east, angles);
            *north = self.kept * *north + vector::dot(by_north, angles);
            [*x, *y, *z] = vector::add(angles, halfway);
        }
    }

    pub fn add_noise(&self, covariance: &mut Covariance) {
        covariance.mirror();
        let (turn, speed) = (self.turn_noise, self.speed_noise);
        covariance.doubt(0, &[turn, turn, turn, speed, speed]);
        covariance.wander(self.bias_noise);
    }
}
