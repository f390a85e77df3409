//! The free robot: body, two five-bar legs and two wheels as rigid bodies in space, on the ground or in the air.
//!
//! [`FreeBody`] knows mechanics only. Motors, sensors and wires are around it in [`crate::world`].
//!
//! ```
//! use robot_plant::free::{FreeBody, FreeInputs, FreeSetup, Start};
//!
//! # let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/fivebar.toml");
//! let robot = robot_description::Robot::read(file.as_ref())?;
//! let setup = FreeSetup { start: Start::Dropped { height_m: 0.1 }, ..FreeSetup::default() };
//! let mut body = FreeBody::new(&robot, &setup);
//! for _ in 0..200 {
//!     body.step(&FreeInputs::default(), 250e-6);
//! }
//! // It falls freely for 50 ms.
//! assert!((body.state().velocity_mps[2] + 9.80665 * 0.05).abs() < 1e-9);
//! # Ok::<(), robot_description::RobotError>(())
//! ```

mod contacts;
mod dynamics;
mod five_bar;
mod grip;
mod ground;
mod joint_forces;
mod model;
mod motion;
mod parts;
mod rolling;
mod setup;
mod start;
mod state;
mod terrain;
mod tyre;

use crate::physics::STANDARD_GRAVITY_MPS2;
use contacts::{Contacts, Moment};
use dynamics::{Coordinates, Dynamics, Rates, bias};
use five_bar::HIPS;
use ground::Ground;
use joint_forces::{DryFriction, stop_torque_nm};
use model::{Model, SIDES};
use motion::Motion;
use nalgebra::{Matrix2, Vector2, Vector3};
use parts::Leg;
use robot_description::Robot;

pub use rolling::FreeAccelerations;
pub use setup::{FreeSetup, Hold, Start, Variation};
pub use state::{FreeInputs, FreeState, Push};
pub use terrain::{Corners, Terrain};

type Vec2 = Vector2<f64>;
type Vec3 = Vector3<f64>;

/// Inputs beyond are cut.
const MOST_NM: f64 = 500.0;
const MOST_N: f64 = 50_000.0;
const MOST_M: f64 = 10.0;

/// A robot in space.
///
/// Legs and wheels: 0 = left, 1 = right; hips: left front, left rear, right front, right rear. [`FreeState`] has frames and
/// senses.
#[derive(Clone, Debug)]
pub struct FreeBody {
    model: Model,
    hold: Hold,
    motion: Motion,
    /// Accelerations over the last step.
    accelerations: Coordinates,
    hip_friction: [[DryFriction; HIPS]; SIDES],
    wheel_friction: [DryFriction; SIDES],
    ground: Ground,
    contacts: Contacts,
    /// Torque of motors, friction and stops on the hips over the last step.
    hip_nm: [[f64; HIPS]; SIDES],
}

impl FreeBody {
    /// A robot at its start. Starts at rest are found by letting the robot come to rest, which takes some 20 ms.
    pub fn new(robot: &Robot, setup: &FreeSetup) -> Self {
        let model = Model::new(robot, &setup.variation);
        let mut body = Self {
            model,
            hold: setup.hold,
            motion: start::upright(&model, 0.0, (model.leg_m[0] + model.leg_m[1]) / 2.0),
            accelerations: Coordinates::zeros(),
            hip_friction: Default::default(),
            wheel_friction: Default::default(),
            ground: Ground::new(&setup.terrain),
            contacts: Contacts::default(),
            hip_nm: Default::default(),
        };
        start::place(&mut body, setup.start);
        body
    }

    /// Advances by `dt_s`, of which the accuracy is known up to 1 ms.
    ///
    /// Positions move half a step with the old speeds and half a step with the new ones. In between mass matrix and forces are
    /// found once, and the bias twice: at the old speeds and at those half a step later.
    pub fn step(&mut self, inputs: &FreeInputs, dt_s: f64) {
        self.motion.drift(dt_s / 2.0, self.hold);
        let legs = self.legs();
        let clamped = self.hold == Hold::Clamped;
        let dynamics = Dynamics::new(&self.model, &legs, clamped);
        let forces = self.forces(inputs, &legs, dt_s);
        let held = self.motion.to_body(Vec3::z() * STANDARD_GRAVITY_MPS2);
        let accelerations_at = |rates: &Rates| {
            let bias = bias(&self.model, &legs, rates);
            dynamics.accelerations(&forces, &bias, held)
        };
        let rates = self.motion.rates();
        // A clamped body's angular acceleration is zero, so that its rate stays so.
        let early = accelerations_at(&rates);
        let accelerations = accelerations_at(&rates.after(dt_s / 2.0, &early));
        self.motion.accelerate(&accelerations, dt_s, self.hold);
        self.motion.drift(dt_s / 2.0, self.hold);
        self.motion.limit(&self.model);
        self.accelerations = accelerations;
    }

    /// Configuration and speeds.
    pub fn state(&self) -> FreeState {
        self.motion.state()
    }

    /// Puts the robot into a state, with friction and tyres relaxed. A clamped body takes no speed.
    pub fn set_state(&mut self, state: &FreeState) {
        self.motion = Motion::of(state, self.hold);
        self.hip_friction = Default::default();
        self.wheel_friction = Default::default();
        self.contacts = Contacts::default();
    }

    /// Holds the body from now on, or lets go of it.
    pub fn set_hold(&mut self, hold: Hold) {
        self.hold = hold;
    }

    /// Mass of everything.
    pub fn mass_kg(&self) -> f64 {
        self.dynamics().rigid[(0, 0)]
    }

    /// Hip angles: left front, left rear, right front, right rear.
    pub fn joint_pos_rad(&self) -> [f64; 4] {
        self.state().joint_rad
    }

    /// Hip speeds.
    pub fn joint_vel_rps(&self) -> [f64; 4] {
        self.state().joint_rps
    }

    /// Speed of each wheel against the shank that carries its motor, which is what the motor measures.
    pub fn wheel_rel_rps(&self) -> [f64; 2] {
        self.motion.wheel_rps
    }

    /// Speed of each wheel about the body's y axis against the world: times the radius it is the speed of the axle while rolling.
    pub fn wheel_abs_rps(&self) -> [f64; 2] {
        let legs = self.legs();
        std::array::from_fn(|side| {
            let turn = legs[side].wheel().turn_rps(self.motion.rates().legs[side]);
            self.motion.rate.y + turn
        })
    }

    /// Distance from the hip centre to each axle, in the leg's plane.
    pub fn leg_length_m(&self) -> [f64; 2] {
        self.legs().map(|leg| leg.linkage.axle.norm())
    }

    /// Angle of the line from hip centre to axle, in body axes: zero straight down, forward positive.
    pub fn leg_angle_rad(&self) -> [f64; 2] {
        self.legs().map(|leg| {
            let axle = leg.linkage.axle;
            axle.x.atan2(-axle.y)
        })
    }

    /// Force with which the hips pushed each axle away from the body over the last step, along the line from hip centre to
    /// axle; zero for a leg so straight or folded that torque and force do not determine each other.
    pub fn leg_force_n(&self) -> [f64; 2] {
        let legs = self.legs();
        std::array::from_fn(|side| {
            let linkage = &legs[side].linkage;
            let [front, rear] = linkage.axle_slope;
            let slopes = Matrix2::new(front.x, front.y, rear.x, rear.y);
            let torques = Vec2::from(self.hip_nm[side]);
            let inverse = slopes.try_inverse().unwrap_or_else(Matrix2::zeros);
            (inverse * torques).dot(&linkage.axle.normalize())
        })
    }

    /// Normal force of the ground on each wheel over the last step.
    pub fn wheel_contact_n(&self) -> [f64; 2] {
        self.contacts.wheel_n
    }

    /// Sum of the normal forces of the ground on body and links over the last step.
    pub fn body_contact_n(&self) -> f64 {
        self.contacts.body_n
    }

    /// Specific force that an accelerometer at a place of the body measured over the last step, both in body axes.
    pub fn specific_force_at(&self, place_m: [f64; 3]) -> [f64; 3] {
        let (rate, place) = (self.motion.rate, Vec3::from(place_m));
        let turning = self.accelerations.angular().cross(&place);
        let force = self.accelerations.linear() + turning + rate.cross(&rate.cross(&place));
        force.into()
    }

    /// Kinetic and potential energy, the latter zero with the centre of mass at z = 0. What tyres and stops store is not in it.
    pub fn energy_j(&self) -> f64 {
        let dynamics = self.dynamics();
        let velocity = self.motion.to_body(self.motion.velocity);
        let mass_kg = dynamics.rigid[(0, 0)];
        let height_m = self.com_m()[2];
        dynamics.kinetic_j(velocity, &self.motion.rates())
            + mass_kg * STANDARD_GRAVITY_MPS2 * height_m
    }

    /// Centre of mass in the world.
    pub fn com_m(&self) -> [f64; 3] {
        let rigid = self.dynamics().rigid;
        // The block of first moments is the cross product matrix of mass times place.
        let place = Vec3::new(rigid[(5, 1)], rigid[(3, 2)], rigid[(4, 0)]) / rigid[(0, 0)];
        (self.motion.position + self.motion.to_world(place)).into()
    }

    /// Linear momentum, and angular momentum about the centre of mass, in world axes. Rotors are not in it: a reflected inertia
    /// has no momentum of its own.
    pub fn momentum(&self) -> ([f64; 3], [f64; 3]) {
        let velocity = self.motion.to_body(self.motion.velocity);
        let momentum = self.dynamics().momentum(velocity, &self.motion.rates());
        let linear = self
            .motion
            .to_world(momentum.fixed_rows::<3>(0).into_owned());
        let about_origin = self
            .motion
            .to_world(momentum.fixed_rows::<3>(3).into_owned());
        let arm = Vec3::from(self.com_m()) - self.motion.position;
        (linear.into(), (about_origin - arm.cross(&linear)).into())
    }

    /// Hip torques that hold both legs still in a level body, against their own weight and a force of the ground on each axle
    /// (forward, up).
    pub fn holding_torque_nm(&self, axle_force_n: [[f64; 2]; 2]) -> [f64; 4] {
        let legs = self.legs();
        std::array::from_fn(|joint| {
            let (side, hip) = (joint / HIPS, joint % HIPS);
            let leg = &legs[side];
            let weight: f64 = leg
                .parts
                .iter()
                .map(|part| part.mass_kg * part.slope[hip].y)
                .sum();
            let ground = leg.linkage.axle_slope[hip].dot(&Vec2::from(axle_force_n[side]));
            weight * STANDARD_GRAVITY_MPS2 - ground
        })
    }

    fn legs(&self) -> [Leg; SIDES] {
        std::array::from_fn(|side| Leg::at(&self.model, side, self.motion.hip_rad[side]))
    }

    fn dynamics(&self) -> Dynamics {
        Dynamics::new(&self.model, &self.legs(), self.hold == Hold::Clamped)
    }

    /// Forces along the coordinates, gravity apart.
    fn forces(&mut self, inputs: &FreeInputs, legs: &[Leg; SIDES], dt_s: f64) -> Coordinates {
        let mut forces = self.outer_forces(inputs);
        let moment = Moment {
            model: &self.model,
            ground: &self.ground,
            motion: &self.motion,
            legs,
            grip: inputs.grip,
            dt_s,
        };
        self.contacts.act(&moment, &mut forces);
        for side in 0..SIDES {
            for hip in 0..HIPS {
                let rps = self.motion.hip_rps[side][hip];
                let own_nm = stop_torque_nm(
                    self.motion.hip_rad[side][hip],
                    rps,
                    self.model.hip_range_rad[hip],
                ) + self.hip_friction[side][hip].torque_nm(
                    rps,
                    inputs.joint_dry_nm,
                    self.model.armature_kgm2,
                    dt_s,
                ) - inputs.joint_viscous_nm_per_rps * rps;
                let motor_nm = within(inputs.joint_nm[side * HIPS + hip], MOST_NM);
                self.hip_nm[side][hip] = motor_nm + own_nm;
                forces.legs[side][hip] += own_nm;
            }
            let rps = self.motion.wheel_rps[side];
            forces.legs[side][HIPS] += self.wheel_friction[side].torque_nm(
                rps,
                inputs.wheel_dry_nm,
                self.model.disc.rotor_kgm2,
                dt_s,
            ) - inputs.wheel_viscous_nm_per_rps * rps;
        }
        forces
    }

    /// Motor torques and pushes.
    fn outer_forces(&self, inputs: &FreeInputs) -> Coordinates {
        let mut forces = Coordinates::zeros();
        if let Some(push) = inputs.push {
            let force = Vec3::from(push.force_n.map(|it| within(it, MOST_N)));
            let at = Vec3::from(push.at_m.map(|it| within(it, MOST_M)));
            forces.push_body(self.motion.to_body(force), at);
        }
        for side in 0..SIDES {
            for hip in 0..HIPS {
                forces.legs[side][hip] = within(inputs.joint_nm[side * HIPS + hip], MOST_NM);
            }
            forces.legs[side][HIPS] = within(inputs.wheel_nm[side], MOST_NM);
        }
        forces
    }
}

/// A value within ± `most`; zero for what is not a number.
fn within(value: f64, most: f64) -> f64 {
    if value.is_nan() {
        0.0
    } else {
        value.clamp(-most, most)
    }
}

#[cfg(test)]
mod tests;
