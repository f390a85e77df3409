//! What a robot's file says.

use serde::Deserialize;

use crate::{JointMotor, Mounting};

/// A two-wheeled robot on five-bar legs.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Robot {
    /// Name, as in `ROBOT=name`.
    pub name: String,
    /// What sits between the legs, with the hip motors.
    pub body: Body,
    /// Both legs, mirror images of each other.
    pub legs: Legs,
    /// Both wheels and their motors.
    pub wheels: Wheels,
    /// The four hip joints and their motors.
    pub joints: Joints,
    /// Place of the board.
    pub imu: Imu,
    /// Wishes to the controller.
    pub control: Control,
}

impl Robot {
    /// Mass of everything in kg.
    pub fn total_mass_kg(&self) -> f64 {
        let links_kg = self.legs.thigh.mass_kg + self.legs.shank.mass_kg;
        let leg_kg = 2.0 * links_kg + self.wheels.motor_mass_kg;
        self.body.mass_kg + 2.0 * leg_kg + 2.0 * self.wheels.mass_kg
    }
}

/// The body with everything that is fixed to it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Mass in kg.
    pub mass_kg: f64,
    /// Centre of mass in body axes, m.
    pub com_m: [f64; 3],
    /// Moments of inertia in kg·m² about the centre of mass, about axes parallel to x, y, z.
    pub inertia_kgm2: [f64; 3],
    /// Full size in m of the box that hits the ground in a fall.
    pub box_m: [f64; 3],
    /// Centre of that box in body axes, m.
    pub box_centre_m: [f64; 3],
}

/// The legs: five-bars in planes parallel to the x and z axes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Legs {
    /// Distance in m between the front and the rear hip axis.
    pub hip_gap_m: f64,
    /// Distance in m of each leg's plane from the body's middle plane.
    pub plane_y_m: f64,
    /// Upper link, from hip to knee.
    pub thigh: Link,
    /// Lower link, from knee to wheel axle.
    pub shank: Link,
    /// Shortest usable distance in m from the hip centre to the axle.
    pub min_m: f64,
    /// Longest usable distance in m from the hip centre to the axle.
    pub max_m: f64,
}

/// A link of a leg: a slender rod with its mass at any place along it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Link {
    /// Distance in m between its two axes.
    pub length_m: f64,
    /// Mass in kg. A shank's mass does not include the wheel's motor.
    pub mass_kg: f64,
    /// Distance in m of its centre of mass from its upper axis.
    pub com_m: f64,
    /// Moment of inertia in kg·m² about an axis through its centre of mass, across the link. It is 0 along the link.
    pub inertia_kgm2: f64,
}

/// The shank that carries the wheel's motor. The motor's reaction acts on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Carrier {
    /// The shank under the front knee.
    Front,
    /// The shank under the rear knee.
    Rear,
}

/// One of the board's CAN buses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Bus {
    /// CAN1.
    Can1,
    /// CAN2.
    Can2,
}

/// The wheels with M3508 motors on C620 speed controllers.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wheels {
    /// Radius in m under load.
    pub radius_m: f64,
    /// Distance in m between the two contact points.
    pub track_m: f64,
    /// Width in m of the tyre.
    pub width_m: f64,
    /// The shank that carries the motor.
    pub carrier: Carrier,
    /// Mass in kg of what turns with the wheel: tyre, hub, output shaft.
    pub mass_kg: f64,
    /// Moment of inertia in kg·m² of what turns with the wheel about the axle, without the rotor.
    pub inertia_kgm2: f64,
    /// Mass in kg of the motor, which does not turn. Its centre is on the axle.
    pub motor_mass_kg: f64,
    /// Moment of inertia in kg·m² of the rotor, seen at the axle: that of the rotor times `gear_ratio` squared.
    pub rotor_inertia_kgm2: f64,
    /// Rotor turns per wheel turn.
    pub gear_ratio: f64,
    /// Torque in N·m at the wheel for a current of 1 A.
    pub torque_nm_per_a: f64,
    /// Speed in rad/s of the unloaded wheel on this robot's battery.
    pub no_load_rps: f64,
    /// Current limit in A of each motor while the wheel speed controller drives, as delivered.
    pub current_limit_a: f64,
    /// Upper limit in A of each motor's current, whatever the settings say. Balance takes it for a moment.
    pub max_current_a: f64,
    /// The bus of both speed controllers.
    pub bus: Bus,
    /// Numbers of the left and the right speed controller, 1…4.
    pub escs: [u8; 2],
    /// Rotor direction that drives the robot forward, left and right, +1 or −1.
    pub signs: [i8; 2],
}

/// The hip joints: left front, left rear, right front, right rear.
///
/// A joint's angle is that of the thigh. It is 0 with the thigh level, pointing away from the other one, and grows as
/// the link turns about −y: the front thigh up, the rear thigh down.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joints {
    /// Make of the motors.
    pub motor: JointMotor,
    /// Moment of inertia in kg·m² of the rotor, seen at the joint.
    pub armature_kgm2: f64,
    /// Torque in N·m that the motor gives for ever.
    pub continuous_nm: f64,
    /// Torque in N·m that the motor gives for a moment, whatever the settings say.
    pub peak_nm: f64,
    /// Speed in rad/s of the unloaded joint on this robot's battery.
    pub no_load_rps: f64,
    /// Torque limit in N·m as delivered.
    pub torque_limit_nm: f64,
    /// Limit of commanded speed in rad/s as delivered.
    pub speed_limit_rps: f64,
    /// Largest stiffness in N·m/rad as delivered.
    pub max_kp: f64,
    /// Largest damping in N·m·s/rad as delivered.
    pub max_kd: f64,
    /// Angles that the mechanics permit.
    pub range_rad: JointRanges,
    /// The bus of all four motors.
    pub bus: Bus,
    /// Numbers of the motors: `CAN_ID` of a DM4310, motor identifier of an RS00.
    pub ids: [u8; 4],
    /// Identifiers of their replies: `MST_ID` of a DM4310, host identifier of an RS00.
    pub replies: [u16; 4],
    /// Motor directions that turn the joints forward, +1 or −1.
    pub directions: [i8; 4],
    /// Motor angles in rad at joint angle 0.
    pub zeros_rad: [f64; 4],
    /// Ticks of 1 ms from one command to the next: 1, 2, 4 or 8.
    pub period_ticks: u8,
    /// The tick of its period in which each motor gets its command.
    pub phases: [u8; 4],
}

/// Soft limits of the joints.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointRanges {
    /// Lower and upper limit in rad of the front joints.
    pub front: HipRange,
    /// Lower and upper limit in rad of the rear joints.
    pub rear: HipRange,
}

/// Lower and upper limit of a joint in rad.
pub type HipRange = [f64; 2];

/// Place of the board with the IMU.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Imu {
    /// Place of the IMU in body axes, m.
    pub place_m: [f64; 3],
    /// Where the axes of the IMU point.
    pub mounting: Mounting,
    /// Where the axes of the magnetometer point relative to the IMU. Without it the heading does not use it.
    pub mag_mounting: Option<Mounting>,
}

/// Wishes to the balance controller.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// Time in s from the state being sampled to half of the torque being there: sensors, buses, motors.
    pub delay_s: f64,
    /// Weights of the quadratic cost.
    pub weights: Weights,
    /// Limits of what the pilot can ask for.
    pub limits: Limits,
}

/// Weights of the quadratic cost from which the gains are computed.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weights {
    /// Of the squared state: s, ṡ, ψ, ψ̇, θ left, its rate, θ right, its rate, φ, its rate, in SI units.
    pub q: [f64; 10],
    /// Of the squared inputs in N²·m²: wheel torque left, right, hip torque on the leg left, right.
    pub r: [f64; 4],
}

/// Limits of what the pilot can ask a balancing robot for.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Speed in m/s.
    pub max_speed_mps: f64,
    /// Turn rate in rad/s.
    pub max_yaw_rps: f64,
    /// Roll angle in rad.
    pub max_roll_rad: f64,
    /// Lowest and highest leg length in m while balancing.
    pub height_m: [f64; 2],
    /// Height in m by which a jump is to clear the ground under the wheels. The check compares it with what the hips give; a
    /// jump is always as high as they can.
    pub jump_m: f64,
}
