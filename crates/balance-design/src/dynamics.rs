//! Masses, weights and inputs of the robot on flat ground, level across.
//!
//! Coordinates: distance s of the axles' middle, yaw ψ of the body, lean θ of the left and the right leg, pitch φ of the body,
//! turns of the left and the right wheel, length of the left and the right leg. Wheels may slip here; [`Dynamics::rolling`]
//! says how they turn when they do not.

use nalgebra::{SMatrix, SVector, Vector2};
use robot_description::{Carrier, Robot};

use crate::leg::{LegPose, LinkPose, Shape};

/// Standard gravity, m/s².
pub(crate) const GRAVITY_MPS2: f64 = 9.80665;
pub(crate) const COORDINATES: usize = 9;
/// Coordinates that are left while no wheel slips and the legs keep their lengths.
pub(crate) const ROLLING: usize = 5;
const S: usize = 0;
const YAW: usize = 1;
const LEAN: [usize; 2] = [2, 3];
const PITCH: usize = 4;
const WHEEL: [usize; 2] = [5, 6];
pub(crate) const LENGTH: [usize; 2] = [7, 8];

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

/// A point of the robot from the hip centre, forward and up, and its derivatives by [`own_coordinates`].
struct Point {
    place: Vector2<f64>,
    by: [Vector2<f64>; 3],
    by_two: [[Vector2<f64>; 3]; 3],
}

/// A mass, the leg that moves it, and how far left it is.
struct Mass {
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

    /// Returns how fast each tyre slips backwards on the ground, over the rates.
    pub fn slip(&self) -> [Vector; 2] {
        [0, 1].map(|leg| self.radius_m * unit(WHEEL[leg]) - self.axle[leg])
    }

    /// Returns how the coordinates follow (s, ψ, θ left, θ right, φ) while the wheels roll and the legs keep their lengths.
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
        let still = Shape {
            value: Vector2::new(forward, up),
            by: [Vector2::zeros(); 2],
            by_two: [[Vector2::zeros(); 2]; 2],
        };
        let place = Mass {
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
        let place = Mass {
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
        let down = Vector2::new(-lean.sin(), -lean.cos());
        let across = Vector2::new(-lean.cos(), lean.sin());
        let zero = Vector2::zeros();
        let point = Point {
            place: length_m * down,
            by: [length_m * across, zero, down],
            by_two: [
                [-length_m * down, zero, across],
                [zero; 3],
                [across, zero, zero],
            ],
        };
        let side = side_of(leg);
        let motor = Mass {
            leg,
            left_m: side * robot.legs.plane_y_m,
            mass_kg: wheels.motor_mass_kg,
        };
        self.add_mass(pose, rates, &motor, &point);
        let wheel = Mass {
            leg,
            left_m: side * wheels.track_m / 2.0,
            mass_kg: wheels.mass_kg,
        };
        self.axle[leg] = self.add_mass(pose, rates, &wheel, &point);
        let spin = unit(WHEEL[leg]);
        self.add_inertia(wheels.inertia_kgm2, &spin, 0.0);
        // A disc or hoop about a diameter, and a rod of the wheel's width.
        self.mass[(YAW, YAW)] +=
            wheels.inertia_kgm2 / 2.0 + wheels.mass_kg * wheels.width_m.powi(2) / 12.0;

        let carrier = match wheels.carrier {
            Carrier::Front => 0,
            Carrier::Rear => 1,
        };
        let (turn, bias) = pitch_of(&links.shanks[carrier], leg, rates);
        self.add_inertia(wheels.rotor_inertia_kgm2, &(spin - turn), -bias);
        for thigh in &links.thighs {
            let (turn, bias) = turn_of(&thigh.angle_rad, leg, rates);
            self.add_inertia(robot.joints.armature_kgm2, &turn, bias);
        }
    }

    /// Adds a body's mass and returns how far it moves ahead over the coordinates.
    fn add_mass(&mut self, pose: &Pose, rates: &Vector, body: &Mass, point: &Point) -> Vector {
        let mass_kg = body.mass_kg;
        let weight_n = mass_kg * GRAVITY_MPS2;
        let mut ahead = unit(S);
        let mut upward = Vector::zeros();
        let mut bias = Vector2::zeros();
        let mut axles_ahead = 0.0;
        let mut add = |by: Vector2<f64>, i: usize| {
            ahead[i] += by.x;
            upward[i] += by.y;
        };
        let mut add_two = |by: Vector2<f64>, i: usize, j: usize| {
            bias += by * rates[i] * rates[j];
            self.stiffness[(i, j)] += weight_n * by.y;
        };
        // The hips are ahead of and above the axles' middle by the mean of both legs.
        for leg in [0, 1] {
            let (lean, half_m) = (pose.lean_rad[leg], pose.length_m[leg] / 2.0);
            let up = Vector2::new(lean.sin(), lean.cos());
            let across = Vector2::new(lean.cos(), -lean.sin());
            let (turn, stretch) = (LEAN[leg], LENGTH[leg]);
            add(half_m * across, turn);
            add(up / 2.0, stretch);
            add_two(-half_m * up, turn, turn);
            add_two(across / 2.0, turn, stretch);
            add_two(across / 2.0, stretch, turn);
            axles_ahead -= half_m * up.x;
        }
        for (i, own) in own_coordinates(body.leg).into_iter().enumerate() {
            add(point.by[i], own);
            for (j, other) in own_coordinates(body.leg).into_iter().enumerate() {
                add_two(point.by_two[i][j], own, other);
            }
        }
        ahead[YAW] = -body.left_m;
        let sideways = (point.place.x - axles_ahead) * unit(YAW);

        for row in [&ahead, &upward, &sideways] {
            self.mass += mass_kg * row * row.transpose();
        }
        self.bias += mass_kg * (ahead * bias.x + upward * bias.y);
        self.slope += weight_n * upward;
        self.upward += mass_kg * upward;
        self.upward_bias += mass_kg * bias.y;
        self.total_mass_kg += mass_kg;
        ahead
    }

    fn add_inertia(&mut self, inertia_kgm2: f64, turn: &Vector, bias: f64) {
        self.mass += inertia_kgm2 * turn * turn.transpose();
        self.bias += inertia_kgm2 * bias * turn;
    }
}

/// Coordinates that move a point of this leg against the hip centre.
fn own_coordinates(leg: usize) -> [usize; 3] {
    [LEAN[leg], PITCH, LENGTH[leg]]
}

/// Returns the point of the body or of a leg, where β = φ − θ, as it is seen in the world.
fn turned(point: &Shape<Vector2<f64>>, pitch_rad: f64) -> Point {
    let (sin, cos) = pitch_rad.sin_cos();
    let world = |v: Vector2<f64>| Vector2::new(v.x * cos + v.y * sin, v.y * cos - v.x * sin);
    let across = |v: Vector2<f64>| Vector2::new(v.y, -v.x);
    let place = point.value;
    let [turn, stretch] = point.by;
    let [[turn_turn, turn_stretch], [_, stretch_stretch]] = point.by_two;
    let lean_pitch = -world(across(turn) + turn_turn);
    let lean_length = -world(turn_stretch);
    let pitch_length = world(across(stretch) + turn_stretch);
    let pitch_pitch = world(turn_turn + 2.0 * across(turn) - place);
    Point {
        place: world(place),
        by: [-world(turn), world(across(place) + turn), world(stretch)],
        by_two: [
            [world(turn_turn), lean_pitch, lean_length],
            [lean_pitch, pitch_pitch, pitch_length],
            [lean_length, pitch_length, world(stretch_stretch)],
        ],
    }
}

/// Returns how fast a link pitches over the coordinates' rates, and its acceleration by the rates alone.
fn pitch_of(link: &LinkPose, leg: usize, rates: &Vector) -> (Vector, f64) {
    let (turn, bias) = turn_of(&link.angle_rad, leg, rates);
    (unit(PITCH) - turn, -bias)
}

/// Returns the rate of an angle against the body over the coordinates' rates, and its acceleration by the rates alone.
fn turn_of(angle: &Shape<f64>, leg: usize, rates: &Vector) -> (Vector, f64) {
    let own = [unit(PITCH) - unit(LEAN[leg]), unit(LENGTH[leg])];
    let turn = angle.by[0] * own[0] + angle.by[1] * own[1];
    let own = own.map(|coordinate| coordinate.dot(rates));
    let mut bias = 0.0;
    for i in [0, 1] {
        for j in [0, 1] {
            bias += angle.by_two[i][j] * own[i] * own[j];
        }
    }
    (turn, bias)
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
