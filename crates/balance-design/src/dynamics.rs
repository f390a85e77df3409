//! Masses, weights and inputs of the robot on flat ground, level across, with legs of constant length.
//!
//! Coordinates: distance s of the axles' middle, yaw ψ of the body, lean θ of the left and the right leg, pitch φ of the body,
//! turns of the left and the right wheel. Wheels may slip here; [`Dynamics::rolling`] says how they turn when they do not.

use nalgebra::{SMatrix, SVector, Vector2};
use robot_description::{Carrier, Robot};

use crate::leg::{Along, LegPose, LinkPose};

/// Standard gravity, m/s².
pub(crate) const GRAVITY_MPS2: f64 = 9.80665;
pub(crate) const COORDINATES: usize = 7;
/// Coordinates that are left while no wheel slips.
pub(crate) const ROLLING: usize = 5;
const S: usize = 0;
const YAW: usize = 1;
const LEAN: [usize; 2] = [2, 3];
const PITCH: usize = 4;
const WHEEL: [usize; 2] = [5, 6];

pub(crate) type Vector = SVector<f64, COORDINATES>;
pub(crate) type Square = SMatrix<f64, COORDINATES, COORDINATES>;

/// Where the robot is, as far as its dynamics depend on it. Left before right.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub length_m: [f64; 2],
    pub lean_rad: [f64; 2],
    pub pitch_rad: f64,
}

/// The equations of motion in one pose: mass · acceleration + bias + slope = inputs · torques + traction.
#[derive(Clone, Debug)]
pub(crate) struct Dynamics {
    pub mass: Square,
    /// What accelerations that the rates alone cause ask for. It leaves out the yaw rate.
    pub bias: Vector,
    /// Derivative of the potential energy.
    pub slope: Vector,
    /// Second derivative of the potential energy.
    pub stiffness: Square,
    /// Work of the torques of the left wheel, the right wheel, the left leg and the right leg.
    pub inputs: SMatrix<f64, COORDINATES, 4>,
    /// Distance that each axle moves ahead.
    pub axle: [Vector; 2],
    /// Distance that the body's centre of mass moves ahead.
    pub body: Vector,
    /// Momentum upwards over the rates, and its change by rates alone.
    pub upward: Vector,
    pub upward_bias: f64,
    pub total_mass_kg: f64,
    radius_m: f64,
}

/// A point of the robot: its derivatives by lean of its leg and pitch, from the hip centre; forward and up.
struct Point {
    by: [Vector2<f64>; 2],
    by_two: [[Vector2<f64>; 2]; 2],
    place: Vector2<f64>,
}

/// A body's place in the sums: which leg, how far left, mass, inertia about the lateral and the vertical axis.
struct Body {
    leg: usize,
    left_m: f64,
    mass_kg: f64,
}

impl Dynamics {
    /// Returns `None` where the legs do not reach. `rates` are those of the coordinates.
    pub fn new(robot: &Robot, pose: &Pose, rates: &Vector) -> Option<Self> {
        let mut sums = Self::empty(robot);
        sums.add_body(robot, pose, rates);
        for leg in [0, 1] {
            let (lean, pitch) = (pose.lean_rad[leg], pose.pitch_rad);
            let links = LegPose::new(&robot.legs, pose.length_m[leg], pitch - lean)?;
            for link in links.links() {
                sums.add_link(robot, pose, rates, leg, link);
            }
            sums.add_wheel(robot, pose, rates, leg, &links);
        }
        Some(sums)
    }

    /// Returns how the coordinates follow (s, ψ, θ left, θ right, φ) while the wheels roll.
    pub fn rolling(&self) -> SMatrix<f64, COORDINATES, ROLLING> {
        let mut rolling = SMatrix::zeros();
        for i in 0..ROLLING {
            rolling[(i, i)] = 1.0;
            for leg in [0, 1] {
                rolling[(WHEEL[leg], i)] = self.axle[leg][i] / self.radius_m;
            }
        }
        rolling
    }

    fn empty(robot: &Robot) -> Self {
        let mut inputs = SMatrix::zeros();
        for leg in [0, 1] {
            inputs[(WHEEL[leg], leg)] = 1.0;
            inputs[(LEAN[leg], leg)] = -1.0;
            inputs[(LEAN[leg], leg + 2)] = 1.0;
            inputs[(PITCH, leg + 2)] = -1.0;
        }
        Self {
            mass: Square::zeros(),
            bias: Vector::zeros(),
            slope: Vector::zeros(),
            stiffness: Square::zeros(),
            inputs,
            axle: [Vector::zeros(); 2],
            upward: Vector::zeros(),
            upward_bias: 0.0,
            total_mass_kg: 0.0,
            body: Vector::zeros(),
            radius_m: robot.wheels.radius_m,
        }
    }

    fn add_body(&mut self, robot: &Robot, pose: &Pose, rates: &Vector) {
        let body = &robot.body;
        let [forward, left, up] = body.com_m;
        let still = Along {
            value: Vector2::new(forward, up),
            first: Vector2::zeros(),
            second: Vector2::zeros(),
        };
        let place = Body {
            leg: 0,
            left_m: left,
            mass_kg: body.mass_kg,
        };
        self.body = self.add_mass(pose, rates, &place, &turned(&still, pose.pitch_rad));
        let turn = unit(PITCH);
        self.add_inertia(body.inertia_kgm2[1], &turn, 0.0);
        self.mass[(YAW, YAW)] += body.inertia_kgm2[2];
    }

    fn add_link(
        &mut self,
        robot: &Robot,
        pose: &Pose,
        rates: &Vector,
        leg: usize,
        link: &LinkPose,
    ) {
        let place = Body {
            leg,
            left_m: side_of(leg) * robot.legs.plane_y_m,
            mass_kg: link.mass_kg,
        };
        self.add_mass(pose, rates, &place, &turned(&link.centre_m, pose.pitch_rad));
        let (turn, bias) = pitch_of(link, leg, rates);
        self.add_inertia(link.inertia_kgm2, &turn, bias);
        // A slender rod: nothing about its length.
        let level = (link.angle_rad.value - pose.pitch_rad).cos();
        self.mass[(YAW, YAW)] += link.inertia_kgm2 * level * level;
    }

    fn add_wheel(
        &mut self,
        robot: &Robot,
        pose: &Pose,
        rates: &Vector,
        leg: usize,
        links: &LegPose,
    ) {
        let wheels = &robot.wheels;
        let (lean, length_m) = (pose.lean_rad[leg], pose.length_m[leg]);
        let axle = length_m * Vector2::new(-lean.sin(), -lean.cos());
        let axle_turned = length_m * Vector2::new(-lean.cos(), lean.sin());
        let zero = Vector2::zeros();
        let point = Point {
            place: axle,
            by: [axle_turned, zero],
            by_two: [[-axle, zero], [zero, zero]],
        };
        let place = Body {
            leg,
            left_m: side_of(leg) * wheels.track_m / 2.0,
            mass_kg: wheels.mass_kg + wheels.motor_mass_kg,
        };
        self.axle[leg] = self.add_mass(pose, rates, &place, &point);
        let spin = unit(WHEEL[leg]);
        self.add_inertia(wheels.inertia_kgm2, &spin, 0.0);
        // A thin disc: half of it about a diameter.
        self.mass[(YAW, YAW)] += wheels.inertia_kgm2 / 2.0;

        let carrier = match wheels.carrier {
            Carrier::Front => 0,
            Carrier::Rear => 1,
        };
        let (turn, bias) = pitch_of(&links.shanks[carrier], leg, rates);
        self.add_inertia(wheels.rotor_inertia_kgm2, &(spin - turn), -bias);
        for thigh in &links.thighs {
            let turn = thigh.angle_rad.first * (unit(PITCH) - unit(LEAN[leg]));
            let bias = thigh.angle_rad.second * turning(leg, rates).powi(2);
            self.add_inertia(robot.joints.armature_kgm2, &turn, bias);
        }
    }

    /// Adds a body's mass and returns how far it moves ahead over the coordinates.
    fn add_mass(&mut self, pose: &Pose, rates: &Vector, body: &Body, point: &Point) -> Vector {
        let mass_kg = body.mass_kg;
        let own = [LEAN[body.leg], PITCH];
        let mut ahead = unit(S);
        let mut upward = Vector::zeros();
        let (mut ahead_bias, mut upward_bias) = (0.0, 0.0);
        let mut axles_ahead = 0.0;
        for leg in [0, 1] {
            // The hips are ahead of and above the axles' middle by the mean of both legs.
            let (lean, half_m) = (pose.lean_rad[leg], pose.length_m[leg] / 2.0);
            let rate = rates[LEAN[leg]];
            ahead[LEAN[leg]] += half_m * lean.cos();
            upward[LEAN[leg]] -= half_m * lean.sin();
            ahead_bias -= half_m * lean.sin() * rate * rate;
            upward_bias -= half_m * lean.cos() * rate * rate;
            axles_ahead -= half_m * lean.sin();
            self.stiffness[(LEAN[leg], LEAN[leg])] -= mass_kg * GRAVITY_MPS2 * half_m * lean.cos();
        }
        for i in [0, 1] {
            ahead[own[i]] += point.by[i].x;
            upward[own[i]] += point.by[i].y;
            for j in [0, 1] {
                let second = point.by_two[i][j];
                ahead_bias += second.x * rates[own[i]] * rates[own[j]];
                upward_bias += second.y * rates[own[i]] * rates[own[j]];
                self.stiffness[(own[i], own[j])] += mass_kg * GRAVITY_MPS2 * second.y;
            }
        }
        ahead[YAW] = -body.left_m;
        let sideways = (point.place.x - axles_ahead) * unit(YAW);

        for row in [&ahead, &upward, &sideways] {
            self.mass += mass_kg * row * row.transpose();
        }
        self.bias += mass_kg * (ahead * ahead_bias + upward * upward_bias);
        self.slope += mass_kg * GRAVITY_MPS2 * upward;
        self.upward += mass_kg * upward;
        self.upward_bias += mass_kg * upward_bias;
        self.total_mass_kg += mass_kg;
        ahead
    }

    fn add_inertia(&mut self, inertia_kgm2: f64, turn: &Vector, bias: f64) {
        self.mass += inertia_kgm2 * turn * turn.transpose();
        self.bias += inertia_kgm2 * bias * turn;
    }
}

/// Returns the point of a body-fixed curve over β as it is seen in the world, where β = φ − θ.
fn turned(point: &Along<Vector2<f64>>, pitch_rad: f64) -> Point {
    let (sin, cos) = pitch_rad.sin_cos();
    let world = |v: Vector2<f64>| Vector2::new(v.x * cos + v.y * sin, v.y * cos - v.x * sin);
    let across = |v: Vector2<f64>| Vector2::new(v.y, -v.x);
    let (first, second) = (point.first, point.second);
    let mixed = -world(across(first) + second);
    Point {
        place: world(point.value),
        by: [-world(first), world(across(point.value) + first)],
        by_two: [
            [world(second), mixed],
            [mixed, world(second + 2.0 * across(first) - point.value)],
        ],
    }
}

/// Returns how fast a link pitches over the coordinates' rates, and its acceleration by the rates alone.
fn pitch_of(link: &LinkPose, leg: usize, rates: &Vector) -> (Vector, f64) {
    let angle = &link.angle_rad;
    let turn = unit(PITCH) - angle.first * (unit(PITCH) - unit(LEAN[leg]));
    (turn, -angle.second * turning(leg, rates).powi(2))
}

/// Returns the rate of the leg's angle β.
fn turning(leg: usize, rates: &Vector) -> f64 {
    rates[PITCH] - rates[LEAN[leg]]
}

fn unit(index: usize) -> Vector {
    let mut unit = Vector::zeros();
    unit[index] = 1.0;
    unit
}

/// 1 on the left and −1 on the right.
fn side_of(leg: usize) -> f64 {
    if leg == 0 { 1.0 } else { -1.0 }
}
