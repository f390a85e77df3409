//! Masses, lengths and limits of one robot, as its equations of motion need them.

use super::{
    Variation, Vec3,
    five_bar::{FiveBar, HIPS},
    grip::Stiffness,
};
use crate::physics::STANDARD_GRAVITY_MPS2;
use nalgebra::Matrix3;
use robot_description::{Carrier, LINK_RADIUS_M, Link, Robot};

/// Left, right.
pub(super) const SIDES: usize = 2;

/// A slender rod with its mass anywhere along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rod {
    pub mass_kg: f64,
    /// Distance of its centre of mass from the upper end.
    pub com_m: f64,
    /// About each axis across the rod through its centre of mass.
    pub inertia_kgm2: f64,
}

impl Rod {
    fn of(link: &Link) -> Self {
        Self {
            mass_kg: link.mass_kg,
            com_m: link.com_m,
            inertia_kgm2: link.inertia_kgm2,
        }
    }
}

/// What turns about the axle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    pub mass_kg: f64,
    /// About the axle, without the rotor.
    pub spin_kgm2: f64,
    /// About a diameter.
    pub tilt_kgm2: f64,
    /// The rotor, seen at the axle.
    pub rotor_kgm2: f64,
    pub radius_m: f64,
    /// Radius of the tyre's round cross-section.
    pub tyre_m: f64,
    /// Torque against turning on the spot, for each newton of friction.
    pub twist_m: f64,
}

/// A ball on the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bumper {
    pub place: Vec3,
    pub radius_m: f64,
}

/// Corners of a box, and hips.
pub(super) const BUMPERS: usize = 8 + SIDES * HIPS;

#[derive(Clone, Copy, Debug)]
pub(super) struct Model {
    pub body_kg: f64,
    /// Centre of mass of the body, in body axes.
    pub body_com: Vec3,
    /// About that centre.
    pub body_inertia: Matrix3<f64>,
    /// What of the body hits the ground: the corners of its box, and the hips.
    pub bumpers: [Bumper; BUMPERS],
    /// Distance from the body's origin within which all of these and the knees are.
    pub reach_m: f64,
    pub bar: FiveBar,
    pub thigh: Rod,
    pub shank: Rod,
    pub motor_kg: f64,
    pub disc: Disc,
    /// The hip whose shank carries the wheel's motor.
    pub carrier: usize,
    /// Rotor of a hip motor, seen at the hip.
    pub armature_kgm2: f64,
    /// Place of the legs' planes along y.
    pub plane_y: [f64; SIDES],
    /// Place of the wheels' middle planes along y.
    pub wheel_y: [f64; SIDES],
    /// Lower and upper limit of the front and the rear hip.
    pub hip_range_rad: [[f64; 2]; 2],
    /// Usable leg lengths.
    pub leg_m: [f64; 2],
    pub ground_friction: f64,
    /// Of the tyres.
    pub tyre: Stiffness,
    /// Of body and links.
    pub shell: Stiffness,
}

/// How far a tyre gives under half of the robot's weight: hard rubber, an assumption.
const TYRE_GIVES_M: f64 = 0.8e-3;
/// Damping of the tyre's spring under the unsprung mass, as a share of the critical one. An assumption.
const TYRE_DAMPING: f64 = 0.15;
/// The same of the body's shell under a quarter of the robot's mass.
const SHELL_DAMPING: f64 = 0.3;
/// Stiffness along the ground as a share of that across it.
const TANGENT_SHARE: f64 = 0.5;

/// A contact with a spring of the given stiffness, damped as a share of critical under a mass.
fn stiffness(n_per_m: f64, damping: f64, mass_kg: f64) -> Stiffness {
    let n_per_mps = 2.0 * damping * (n_per_m * mass_kg).sqrt();
    Stiffness {
        normal_n_per_m: n_per_m,
        normal_n_per_mps: n_per_mps,
        tangent_n_per_m: TANGENT_SHARE * n_per_m,
        tangent_n_per_mps: n_per_mps,
    }
}

impl Model {
    pub fn new(robot: &Robot, variation: &Variation) -> Self {
        let (legs, wheels) = (&robot.legs, &robot.wheels);
        let added_kg = (variation.mass_factor - 1.0) * robot.total_mass_kg();
        let body_kg = (robot.body.mass_kg + added_kg).max(0.1 * robot.body.mass_kg);
        let load_n = robot.total_mass_kg() * STANDARD_GRAVITY_MPS2 / 2.0;
        let n_per_m = load_n / TYRE_GIVES_M;
        let growth = body_kg / robot.body.mass_kg;
        let bumpers = bumpers(robot);
        let knee_m = legs.hip_gap_m / 2.0 + legs.thigh.length_m;
        Self {
            body_kg,
            body_com: Vec3::from(robot.body.com_m) + Vec3::from(variation.com_offset_m),
            body_inertia: Matrix3::from_diagonal(&(Vec3::from(robot.body.inertia_kgm2) * growth)),
            bumpers,
            reach_m: LINK_RADIUS_M
                + bumpers
                    .iter()
                    .map(|it| it.place.norm())
                    .fold(knee_m.hypot(legs.plane_y_m), f64::max),
            bar: FiveBar {
                half_gap_m: legs.hip_gap_m / 2.0,
                thigh_m: legs.thigh.length_m,
                shank_m: legs.shank.length_m,
            },
            thigh: Rod::of(&legs.thigh),
            shank: Rod::of(&legs.shank),
            motor_kg: wheels.motor_mass_kg,
            disc: Disc {
                mass_kg: wheels.mass_kg,
                spin_kgm2: wheels.inertia_kgm2,
                // Half of that about the axle, as for a thin disc or hoop, and a rod of the wheel's width.
                tilt_kgm2: wheels.inertia_kgm2 / 2.0
                    + wheels.mass_kg * wheels.width_m.powi(2) / 12.0,
                rotor_kgm2: wheels.rotor_inertia_kgm2,
                radius_m: wheels.radius_m,
                tyre_m: (wheels.width_m / 2.0).min(wheels.radius_m / 2.0),
                twist_m: wheels.twist_lever_m(),
            },
            carrier: match wheels.carrier {
                Carrier::Front => 0,
                Carrier::Rear => 1,
            },
            armature_kgm2: robot.joints.armature_kgm2,
            plane_y: [legs.plane_y_m, -legs.plane_y_m],
            wheel_y: [wheels.track_m / 2.0, -wheels.track_m / 2.0],
            hip_range_rad: [robot.joints.range_rad.front, robot.joints.range_rad.rear],
            leg_m: [legs.min_m, legs.max_m],
            ground_friction: variation.ground_friction,
            tyre: stiffness(n_per_m, TYRE_DAMPING, wheels.mass_kg + wheels.motor_mass_kg),
            shell: stiffness(n_per_m, SHELL_DAMPING, robot.total_mass_kg() / 4.0),
        }
    }
}

fn bumpers(robot: &Robot) -> [Bumper; BUMPERS] {
    let (body, legs) = (&robot.body, &robot.legs);
    let half_gap_m = legs.hip_gap_m / 2.0;
    std::array::from_fn(|number| {
        let side = |axis: usize| if number >> axis & 1 == 0 { -1.0 } else { 1.0 };
        if number < 8 {
            let place = |axis| body.box_centre_m[axis] + side(axis) * body.box_m[axis] / 2.0;
            Bumper {
                place: Vec3::from_fn(|axis, _| place(axis)),
                radius_m: 0.0,
            }
        } else {
            Bumper {
                place: Vec3::new(side(0) * half_gap_m, side(1) * legs.plane_y_m, 0.0),
                radius_m: LINK_RADIUS_M,
            }
        }
    })
}
