//! The robot on ideal wheels, for linear models: tyres neither give nor slip.

use super::{
    FreeBody, FreeInputs, Vec3,
    dynamics::{Coordinates, bias},
    five_bar::HIPS,
    model::SIDES,
};
use crate::physics::STANDARD_GRAVITY_MPS2;
use nalgebra::{Matrix6, Vector6};

/// Forward, left and up at each wheel.
const CONSTRAINTS: usize = 3 * SIDES;
/// Both wheels forbid the same sideways motion, so that their two forces are not determined. A compliance this small
/// shares them.
const SHARING: f64 = 1e-9;

/// Accelerations of a [`FreeBody`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeAccelerations {
    /// Of the body's origin, in world axes.
    pub linear_mps2: [f64; 3],
    /// Of the body, in body axes.
    pub angular_rps2: [f64; 3],
    /// Of the hips.
    pub joint_rps2: [f64; 4],
    /// Of the wheels against their shanks.
    pub wheel_rps2: [f64; 2],
}

impl FreeBody {
    /// Accelerations of the robot on level ground if its wheels rolled ideally: no slip, no give, no friction in wheels and hips, no
    /// stops. Nothing moves. The state must be at rest, or so slow that products of two speeds do not count; where it
    /// is in z does not matter.
    pub fn rolling_accelerations(&self, inputs: &FreeInputs) -> FreeAccelerations {
        let (legs, dynamics) = (self.legs(), self.dynamics());
        let none = Coordinates::zeros();
        let gravity = self.motion.to_body(Vec3::z() * STANDARD_GRAVITY_MPS2);
        let mut forces = self.outer_forces(inputs);
        let free = dynamics.accelerations(
            &forces,
            &bias(&self.model, &legs, &self.motion.rates()),
            gravity,
        );
        let columns: [Coordinates; CONSTRAINTS] = std::array::from_fn(|constraint| {
            let (side, axis) = (constraint / 3, constraint % 3);
            let wheel = legs[side].wheel();
            let axle = self.motion.to_world(Vec3::y());
            let forward = axle.cross(&Vec3::z()).normalize();
            let [left, up] = [Vec3::z().cross(&forward), Vec3::z()];
            let into = (axle * axle.z - up).normalize();
            let disc = self.model.disc;
            let lever = into * (disc.radius_m - disc.tyre_m) - up * disc.tyre_m;
            let mut column = Coordinates::zeros();
            let direction = self.motion.to_body([forward, left, up][axis]);
            let at = wheel.place + self.motion.to_body(lever);
            column.push_part(side, wheel, direction, at);
            column
        });
        let answers = columns.map(|column| dynamics.accelerations(&column, &none, Vec3::zeros()));
        let mut matrix = Matrix6::from_fn(|row, column| columns[row].dot(&answers[column]));
        matrix += Matrix6::identity() * (SHARING * matrix.trace());
        let mut moving = free;
        moving.push_body(-gravity, Vec3::zeros());
        let wanted = Vector6::from_fn(|row, _| -columns[row].dot(&moving));
        let ground = matrix.lu().solve(&wanted).unwrap_or_else(Vector6::zeros);
        for (column, force) in columns.iter().zip(&ground) {
            forces.add(column, *force);
        }
        let bias = bias(&self.model, &legs, &self.motion.rates());
        let result = dynamics.accelerations(&forces, &bias, gravity);
        FreeAccelerations {
            linear_mps2: self.motion.to_world(result.linear() - gravity).into(),
            angular_rps2: result.angular().into(),
            joint_rps2: std::array::from_fn(|joint| result.legs[joint / HIPS][joint % HIPS]),
            wheel_rps2: [result.legs[0][HIPS], result.legs[1][HIPS]],
        }
    }
}
