//! Position and speeds of everything, and how they move on.

use super::{
    FreeState, Hold, Vec3,
    dynamics::{Coordinates, Rates},
    five_bar::HIPS,
    model::{Model, SIDES},
};
use crate::{attitude::normalised, physics::STANDARD_GRAVITY_MPS2};
use nalgebra::{Quaternion, UnitQuaternion};

/// Speeds beyond are cut: far above what any motor reaches, and low enough to stay finite.
const MOST_MPS: f64 = 100.0;
const MOST_RPS: f64 = 1_000.0;
/// A hip that is forced through its stop by more than this is set back.
const MOST_BEYOND_RAD: f64 = 0.2;

#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub position: Vec3,
    /// Body → world.
    pub attitude: UnitQuaternion<f64>,
    /// In world axes.
    pub velocity: Vec3,
    /// In body axes.
    pub rate: Vec3,
    pub hip_rad: [[f64; HIPS]; SIDES],
    pub hip_rps: [[f64; HIPS]; SIDES],
    pub wheel_rad: [f64; SIDES],
    pub wheel_rps: [f64; SIDES],
}

impl Motion {
    pub fn of(state: &FreeState, hold: Hold) -> Self {
        let moving = if hold == Hold::Clamped { 0.0 } else { 1.0 };
        let [w, x, y, z] = normalised(state.attitude).unwrap_or([1.0, 0.0, 0.0, 0.0]);
        let pairs = |[a, b, c, d]: [f64; 4]| [[a, b], [c, d]];
        Self {
            position: state.position_m.into(),
            attitude: UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z)),
            velocity: Vec3::from(state.velocity_mps) * moving,
            rate: Vec3::from(state.rate_rps) * moving,
            hip_rad: pairs(state.joint_rad),
            hip_rps: pairs(state.joint_rps),
            wheel_rad: state.wheel_rad,
            wheel_rps: state.wheel_rps,
        }
    }

    pub fn state(&self) -> FreeState {
        let flat = |[[a, b], [c, d]]: [[f64; HIPS]; SIDES]| [a, b, c, d];
        let q = self.attitude.quaternion();
        FreeState {
            position_m: self.position.into(),
            attitude: [q.w, q.i, q.j, q.k],
            velocity_mps: self.velocity.into(),
            rate_rps: self.rate.into(),
            joint_rad: flat(self.hip_rad),
            joint_rps: flat(self.hip_rps),
            wheel_rad: self.wheel_rad,
            wheel_rps: self.wheel_rps,
        }
    }

    pub fn rates(&self) -> Rates {
        Rates {
            body: self.rate,
            legs: std::array::from_fn(|side| {
                let [front, rear] = self.hip_rps[side];
                [front, rear, self.wheel_rps[side]]
            }),
        }
    }

    pub fn to_body(&self, world: Vec3) -> Vec3 {
        self.attitude.inverse_transform_vector(&world)
    }

    pub fn to_world(&self, body: Vec3) -> Vec3 {
        self.attitude.transform_vector(&body)
    }

    /// Takes away all speed.
    pub fn stop(&mut self) {
        self.velocity = Vec3::zeros();
        self.rate = Vec3::zeros();
        self.hip_rps = Default::default();
        self.wheel_rps = Default::default();
    }

    /// The largest of all speeds, whatever their unit.
    pub fn fastest(&self) -> f64 {
        let joints = self.hip_rps.as_flattened().iter().chain(&self.wheel_rps);
        let body = self.velocity.iter().chain(&self.rate);
        joints.chain(body).fold(0.0, |most, it| it.abs().max(most))
    }

    /// Moves on at constant speeds.
    pub fn drift(&mut self, dt_s: f64, hold: Hold) {
        if hold == Hold::Free {
            self.position += self.velocity * dt_s;
            self.attitude *= UnitQuaternion::from_scaled_axis(self.rate * dt_s);
            self.attitude.renormalize_fast();
        }
        for side in 0..SIDES {
            for hip in 0..HIPS {
                self.hip_rad[side][hip] += self.hip_rps[side][hip] * dt_s;
            }
            self.wheel_rad[side] += self.wheel_rps[side] * dt_s;
        }
    }

    /// Changes the speeds.
    pub fn accelerate(&mut self, by: &Coordinates, dt_s: f64, hold: Hold) {
        if hold == Hold::Free {
            let gravity = Vec3::new(0.0, 0.0, -STANDARD_GRAVITY_MPS2);
            self.velocity += (self.to_world(by.linear()) + gravity) * dt_s;
            self.rate += by.angular() * dt_s;
        }
        for side in 0..SIDES {
            for hip in 0..HIPS {
                self.hip_rps[side][hip] += by.legs[side][hip] * dt_s;
            }
            self.wheel_rps[side] += by.legs[side][HIPS] * dt_s;
        }
    }

    /// Keeps the state finite, whatever acted.
    pub fn limit(&mut self, model: &Model) {
        self.velocity = self.velocity.map(|it| it.clamp(-MOST_MPS, MOST_MPS));
        self.rate = self.rate.map(|it| it.clamp(-MOST_RPS, MOST_RPS));
        for side in 0..SIDES {
            self.wheel_rps[side] = self.wheel_rps[side].clamp(-MOST_RPS, MOST_RPS);
            for hip in 0..HIPS {
                let [lower, upper] = model.hip_range_rad[hip];
                let (angle_rad, rps) = (&mut self.hip_rad[side][hip], &mut self.hip_rps[side][hip]);
                *rps = rps.clamp(-MOST_RPS, MOST_RPS);
                let kept = angle_rad.clamp(lower - MOST_BEYOND_RAD, upper + MOST_BEYOND_RAD);
                if kept != *angle_rad {
                    (*angle_rad, *rps) = (kept, 0.0);
                }
            }
        }
    }
}
