//! Equations of motion: mass matrix, bias forces, and the accelerations that follow.
//!
//! Coordinates are the specific force at the body's origin and the angular acceleration of the body, both in body axes, and
//! three of each leg: front hip, rear hip, wheel against its shank. Gravity is a uniform acceleration: with the specific force
//! as unknown it needs no term. Legs meet in the body only, so the matrix is an arrow: a leg's block is eliminated by its own 3 × 3
//! inverse, and 6 × 6 remain.

use super::{
    Vec3,
    model::{Model, SIDES},
    parts::{LEG_COORDINATES, Leg, Part, lift},
};
use nalgebra::{Cholesky, Const, Matrix3, Matrix6, Matrix6x3, Vector3, Vector6};

/// Forces along the coordinates, or accelerations of them: body first, then each leg.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinates {
    /// Linear, then angular.
    pub body: Vector6<f64>,
    pub legs: [Vector3<f64>; SIDES],
}

impl Coordinates {
    pub fn zeros() -> Self {
        Self {
            body: Vector6::zeros(),
            legs: [Vector3::zeros(); SIDES],
        }
    }

    pub fn linear(&self) -> Vec3 {
        self.body.fixed_rows::<3>(0).into_owned()
    }

    pub fn angular(&self) -> Vec3 {
        self.body.fixed_rows::<3>(3).into_owned()
    }

    /// Adds a force at a place of the body, both in body axes.
    pub fn push_body(&mut self, force: Vec3, at: Vec3) {
        self.turn_body(at.cross(&force));
        self.body[0] += force.x;
        self.body[1] += force.y;
        self.body[2] += force.z;
    }

    pub fn turn_body(&mut self, torque: Vec3) {
        self.body[3] += torque.x;
        self.body[4] += torque.y;
        self.body[5] += torque.z;
    }

    /// Adds a force on a part of a leg at a place, both in body axes.
    pub fn push_part(&mut self, side: usize, part: &Part, force: Vec3, at: Vec3) {
        self.push_body(force, at);
        let turning_nm = (at - part.place).cross(&force).y;
        for (hip, slope) in part.slope.iter().enumerate() {
            self.legs[side][hip] += slope.x * force.x + slope.y * force.z;
        }
        for (coordinate, share) in part.turn.iter().enumerate() {
            self.legs[side][coordinate] += share * turning_nm;
        }
    }

    /// Adds a torque on a part of a leg, in body axes.
    pub fn twist_part(&mut self, side: usize, part: &Part, torque: Vec3) {
        self.turn_body(torque);
        for (coordinate, share) in part.turn.iter().enumerate() {
            self.legs[side][coordinate] += share * torque.y;
        }
    }

    /// Adds a multiple of other forces.
    pub fn add(&mut self, other: &Self, times: f64) {
        self.body += other.body * times;
        for (leg, other) in self.legs.iter_mut().zip(&other.legs) {
            *leg += other * times;
        }
    }

    /// Power of these forces at speeds, or its like at accelerations.
    pub fn dot(&self, other: &Self) -> f64 {
        let legs = self.legs.iter().zip(&other.legs);
        self.body.dot(&other.body) + legs.map(|(a, b)| a.dot(b)).sum::<f64>()
    }

    fn minus(&self, other: &Self) -> Self {
        Self {
            body: self.body - other.body,
            legs: [self.legs[0] - other.legs[0], self.legs[1] - other.legs[1]],
        }
    }
}

/// Speeds that the bias depends on. The body's own velocity is none of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    /// Of the body, in body axes.
    pub body: Vec3,
    pub legs: [[f64; LEG_COORDINATES]; SIDES],
}

impl Rates {
    /// The rates after some time at given accelerations.
    pub fn after(&self, dt_s: f64, by: &Coordinates) -> Self {
        Self {
            body: self.body + by.angular() * dt_s,
            legs: std::array::from_fn(|side| {
                std::array::from_fn(|i| self.legs[side][i] + by.legs[side][i] * dt_s)
            }),
        }
    }
}

/// Mass matrix at one pose of both legs, factored.
pub(super) struct Dynamics {
    /// Of the body with both legs, before the legs are eliminated.
    pub rigid: Matrix6<f64>,
    /// Rows: body. Columns: leg.
    pub coupling: [Matrix6x3<f64>; SIDES],
    pub legs: [Matrix3<f64>; SIDES],
    inverse: [Matrix3<f64>; SIDES],
    /// coupling · inverse.
    lever: [Matrix6x3<f64>; SIDES],
    /// `None` where the body is clamped.
    body: Option<Cholesky<f64, Const<6>>>,
}

impl Dynamics {
    pub fn new(model: &Model, legs: &[Leg; SIDES], clamped: bool) -> Self {
        let mut rigid = RigidSum::of_body(model);
        let mut blocks = [Matrix3::zeros(); SIDES];
        let mut coupling = [Matrix6x3::zeros(); SIDES];
        for (side, leg) in legs.iter().enumerate() {
            let rotors = [
                model.armature_kgm2,
                model.armature_kgm2,
                model.disc.rotor_kgm2,
            ];
            blocks[side] = Matrix3::from_diagonal(&Vector3::from(rotors));
            for part in &leg.parts {
                rigid.add(part);
                couple(part, &mut coupling[side], &mut blocks[side]);
            }
        }
        let rigid = rigid.matrix();
        let inverse = blocks.map(|it| it.try_inverse().unwrap_or_else(Matrix3::zeros));
        let lever = [coupling[0] * inverse[0], coupling[1] * inverse[1]];
        let body = (!clamped)
            .then(|| {
                let legs = lever[0] * coupling[0].transpose() + lever[1] * coupling[1].transpose();
                Cholesky::new(rigid - legs)
            })
            .flatten();
        Self {
            rigid,
            coupling,
            legs: blocks,
            inverse,
            lever,
            body,
        }
    }

    /// Accelerations under the given forces. The body's linear one is the specific force at its origin; a clamped body has that of
    /// `held`.
    pub fn accelerations(
        &self,
        forces: &Coordinates,
        bias: &Coordinates,
        held: Vec3,
    ) -> Coordinates {
        let mut result = forces.minus(bias);
        match &self.body {
            Some(body) => {
                result.body -= self.lever[0] * result.legs[0] + self.lever[1] * result.legs[1];
                body.solve_mut(&mut result.body);
            }
            None => result.body = Vector6::new(held.x, held.y, held.z, 0.0, 0.0, 0.0),
        }
        for side in 0..SIDES {
            let pulled = self.coupling[side].transpose() * result.body;
            result.legs[side] = self.inverse[side] * (result.legs[side] - pulled);
        }
        result
    }

    /// Kinetic energy less that of the origin's own motion: `velocity` is in body axes.
    pub fn kinetic_j(&self, velocity: Vec3, rates: &Rates) -> f64 {
        let body = Vector6::new(
            velocity.x,
            velocity.y,
            velocity.z,
            rates.body.x,
            rates.body.y,
            rates.body.z,
        );
        let mut double = (self.rigid * body).dot(&body);
        for side in 0..SIDES {
            let leg = Vector3::from(rates.legs[side]);
            double +=
                (self.legs[side] * leg).dot(&leg) + 2.0 * (self.coupling[side] * leg).dot(&body);
        }
        double / 2.0
    }

    /// Linear and angular momentum about the body's origin, in body axes. Rotors count as their reflected inertia does: not.
    pub fn momentum(&self, velocity: Vec3, rates: &Rates) -> Vector6<f64> {
        let body = Vector6::new(
            velocity.x,
            velocity.y,
            velocity.z,
            rates.body.x,
            rates.body.y,
            rates.body.z,
        );
        (0..SIDES).fold(self.rigid * body, |sum, side| {
            sum + self.coupling[side] * Vector3::from(rates.legs[side])
        })
    }
}

/// Forces that keep all accelerations at zero, specific force included: what turning frames and links cost.
pub(super) fn bias(model: &Model, legs: &[Leg; SIDES], rates: &Rates) -> Coordinates {
    let mut bias = Coordinates::zeros();
    let omega = rates.body;
    let accel = omega.cross(&omega.cross(&model.body_com));
    bias.push_body(accel * model.body_kg, model.body_com);
    bias.turn_body(omega.cross(&(model.body_inertia * omega)));
    for (side, leg) in legs.iter().enumerate() {
        let leg_rps = rates.legs[side];
        let [front_rps, rear_rps, _] = leg_rps;
        let terms = leg.centripetal(model, [front_rps, rear_rps]);
        for (part, terms) in leg.parts.iter().zip(terms) {
            let coriolis = part.velocity(leg_rps) * 2.0;
            let accel = omega.cross(&(omega.cross(&part.place) + coriolis)) + lift(terms.place);
            let turn_rps = part.turn_rps(leg_rps);
            let total = omega + Vec3::new(0.0, turn_rps, 0.0);
            // The turn's own acceleration, and that of its axis with the body.
            let angular = Vec3::new(-omega.z * turn_rps, terms.turn, omega.x * turn_rps);
            let torque = part.inertia.times(angular) + total.cross(&part.inertia.times(total));
            bias.push_part(side, part, accel * part.mass_kg, part.place);
            bias.twist_part(side, part, torque);
        }
    }
    bias
}

/// Adds a part to its leg's block and to the coupling between leg and body.
fn couple(part: &Part, coupling: &mut Matrix6x3<f64>, block: &mut Matrix3<f64>) {
    let [x, y, z] = part.place.into();
    let spin = part.inertia.yy;
    for (i, slope) in part.slope.iter().enumerate() {
        let force = slope * part.mass_kg;
        coupling[(0, i)] += force.x;
        coupling[(2, i)] += force.y;
        coupling[(3, i)] += y * force.y;
        coupling[(4, i)] += z * force.x - x * force.y;
        coupling[(5, i)] -= y * force.x;
        for (j, other) in part.slope.iter().enumerate() {
            block[(i, j)] += force.dot(other);
        }
    }
    for (i, turn) in part.turn.iter().enumerate() {
        coupling[(4, i)] += turn * spin;
        for (j, other) in part.turn.iter().enumerate() {
            block[(i, j)] += turn * spin * other;
        }
    }
}

/// Mass, first and second moments about the body's origin.
struct RigidSum {
    mass_kg: f64,
    first: Vec3,
    second: Matrix3<f64>,
}

impl RigidSum {
    fn of_body(model: &Model) -> Self {
        Self {
            mass_kg: model.body_kg,
            first: model.body_com * model.body_kg,
            second: model.body_inertia + about_origin(model.body_com) * model.body_kg,
        }
    }

    fn add(&mut self, part: &Part) {
        self.mass_kg += part.mass_kg;
        self.first += part.place * part.mass_kg;
        self.second += about_origin(part.place) * part.mass_kg;
        let inertia = part.inertia;
        self.second[(0, 0)] += inertia.xx;
        self.second[(1, 1)] += inertia.yy;
        self.second[(2, 2)] += inertia.zz;
        self.second[(0, 2)] += inertia.xz;
        self.second[(2, 0)] += inertia.xz;
    }

    fn matrix(&self) -> Matrix6<f64> {
        let mut matrix = Matrix6::zeros();
        let cross = self.first.cross_matrix();
        matrix
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(Matrix3::identity() * self.mass_kg));
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&-cross);
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&cross);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.second);
        matrix
    }
}

/// Inertia of a unit mass at a place.
fn about_origin(place: Vec3) -> Matrix3<f64> {
    let [x, y, z] = place.into();
    Matrix3::new(
        y * y + z * z,
        -x * y,
        -x * z,
        -x * y,
        x * x + z * z,
        -y * z,
        -x * z,
        -y * z,
        x * x + y * y,
    )
}
