//! How the errors grow over one window, in small pieces of work.
//!
//! Over a window of T seconds with mean specific force a the errors of angle θ, speed v and gyro parameters p go
//!
//! θ ← θ + u, v ← κ·v + C·(θ + u/2), u = Φ·p, C·θ = T·θ × a
//!
//! (only the level parts of v). Φ is [`Window::turn_by_parameter`], κ what is left of a speed. From these lines the blocks
//! of the covariance follow, of which the slow one stays; noise is added.

use super::{
    covariance::{Covariance, LEAST_VARIANCE},
    rows,
    strapdown::SPEED_MEMORY_S,
    window::{PARAMETERS, Parameters, Window},
};
use crate::math::{Matrix3, Vector3, matrix, scalar, vector};

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
#[derive(Clone, Debug)]
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
    /// Covariance of u with the slow errors, Φ·P.
    turn_slow: [Parameters; 3],
    /// … with the fast ones,
    turn_fast: [[f32; 5]; 3],
    /// … and with itself.
    turn_turn: Matrix3,
}

impl Forecast {
    pub fn new(window: &Window) -> Self {
        let t = window.duration_s;
        let [ax, ay, az] = window.accel_mps2();
        let blind_mps = BLIND_ACCEL_MPS2 * window.blind_s;
        let forgotten = t / SPEED_MEMORY_S;
        Self {
            turn_by_parameter: window.turn_by_parameter,
            speed_by_angle: [[0.0, az * t, -ay * t], [-az * t, 0.0, ax * t]],
            kept: 1.0 - forgotten + 0.5 * forgotten * forgotten,
            turn_noise: TURN_DENSITY * t
                + TURN_SHARE * window.turned_rad2_per_s
                + window.unseen_rad2,
            speed_noise: blind_mps * blind_mps,
            bias_noise: BIAS_DENSITY * t,
            turn_slow: [[0.0; PARAMETERS]; 3],
            turn_fast: [[0.0; 5]; 3],
            turn_turn: [[0.0; 3]; 3],
        }
    }

    /// One row of Φ·P. Work for one sample.
    pub fn turn_axis(&mut self, axis: usize, covariance: &Covariance) {
        let row = self.turn_by_parameter.get(axis);
        if let (Some(weights), Some(to)) = (row, self.turn_slow.get_mut(axis)) {
            rows::add_weighted(to, weights, &covariance.slow);
        }
    }

    /// How u goes with the fast errors and with itself.
    pub fn relate(&mut self, covariance: &Covariance) {
        let turns = self.turn_by_parameter.iter().zip(&self.turn_slow);
        let results = self.turn_fast.iter_mut().zip(&mut self.turn_turn);
        for ((turn, turn_slow), (with_fast, with_itself)) in turns.zip(results) {
            rows::products(turn, &covariance.cross, with_fast);
            rows::products(turn_slow, &self.turn_by_parameter, with_itself);
        }
    }

    pub fn carry_fast(&self, covariance: &mut Covariance) {
        let [px, py, pz, [.., ee, en], [.., nn]] = covariance.fast;
        let split = |[x, y, z, east, north]: [f32; 5]| ([x, y, z], [east, north]);
        let ((px, lx), (py, ly), (pz, lz)) = (split(px), split(py), split(pz));
        let angle = [px, py, pz];
        let [ux, uy, uz] = self.turn_fast;
        let ((ax, vx), (ay, vy), (az, vz)) = (split(ux), split(uy), split(uz));
        let turn = [ax, ay, az];
        let turned = matrix::transposed(turn);
        // Of θ + u/2 with itself, of θ + u with it, of θ + u with itself.
        let middle = matrix::add_scaled(&angle, 0.5, &turn);
        let middle = matrix::add_scaled(&middle, 0.5, &turned);
        let middle = matrix::add_scaled(&middle, 0.25, &self.turn_turn);
        let mixed = matrix::add_scaled(&middle, 0.5, &turn);
        let mixed = matrix::add_scaled(&mixed, 0.25, &self.turn_turn);
        let after = matrix::add_scaled(&mixed, 0.5, &turned);
        let after = matrix::add_scaled(&after, 0.5, &self.turn_turn);
        let [by_east, by_north] = self.speed_by_angle;
        let k = self.kept;
        let speed = |row: Vector3, [le, ln]: [f32; 2], [ue, un]: [f32; 2]| {
            [
                k * (le + ue) + vector::dot(row, by_east),
                k * (ln + un) + vector::dot(row, by_north),
            ]
        };
        let [mx, my, mz] = mixed;
        let [sx, sy, sz] = [speed(mx, lx, vx), speed(my, ly, vy), speed(mz, lz, vz)];
        let half = |[le, ln]: [f32; 2], [ue, un]: [f32; 2]| [le + 0.5 * ue, ln + 0.5 * un];
        let [[xe, xn], [ye, yn], [ze, zn]] = [half(lx, vx), half(ly, vy), half(lz, vz)];
        let (with_east, with_north) = ([xe, ye, ze], [xn, yn, zn]);
        let [wx, wy, wz] = middle;
        let times = |by: Vector3| {
            [
                vector::dot(wx, by),
                vector::dot(wy, by),
                vector::dot(wz, by),
            ]
        };
        let (middle_east, middle_north) = (times(by_east), times(by_north));
        let ee = k * k * ee
            + 2.0 * k * vector::dot(by_east, with_east)
            + vector::dot(by_east, middle_east)
            + self.speed_noise;
        let nn = k * k * nn
            + 2.0 * k * vector::dot(by_north, with_north)
            + vector::dot(by_north, middle_north)
            + self.speed_noise;
        let en = k * k * en
            + k * (vector::dot(by_east, with_north) + vector::dot(by_north, with_east))
            + vector::dot(by_east, middle_north);
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = after;
        let noise = |variance: f32| scalar::max(variance + self.turn_noise, LEAST_VARIANCE);
        let ([xe, xn], [ye, yn], [ze, zn]) = (sx, sy, sz);
        covariance.fast = [
            [noise(xx), xy, xz, xe, xn],
            [xy, noise(yy), yz, ye, yn],
            [xz, yz, noise(zz), ze, zn],
            [xe, ye, ze, scalar::max(ee, LEAST_VARIANCE), en],
            [xn, yn, zn, en, scalar::max(nn, LEAST_VARIANCE)],
        ];
    }

    /// The cross block; then noise on the slow one.
    pub fn carry_cross(&self, covariance: &mut Covariance) {
        let [x, y, z, speed @ ..] = &mut covariance.cross;
        for (row, by_angle) in speed.iter_mut().zip(&self.speed_by_angle) {
            let before = [*row];
            rows::add_weighted(row, &[self.kept - 1.0], &before);
            rows::add_weighted(row, by_angle, &[*x, *y, *z]);
            rows::add_weighted(row, &vector::scale(*by_angle, 0.5), &self.turn_slow);
        }
        for (row, turn_slow) in [x, y, z].into_iter().zip(&self.turn_slow) {
            rows::add_weighted(row, &[1.0], core::slice::from_ref(turn_slow));
        }
        covariance.wander(self.bias_noise);
    }
}
