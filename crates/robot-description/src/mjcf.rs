//! The robot for MuJoCo.
//!
//! Bodies, joints and places are those of the plant. The rotors of the motors are armatures: their inertia counts for
//! the motion of a joint alone. The five-bars are closed by `connect` constraints at the axles.

mod scene;
mod tree;

use crate::{
    Carrier, Robot,
    figures::GRAVITY_MPS2,
    parts::{SIDES, Side, limbs, part, wheel_name},
    stance::Stance,
    xml::Element,
};

/// How the body of the robot is held in MuJoCo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// It moves freely and starts with its wheels on the floor.
    Free,
    /// It is clamped, with its wheels in the air.
    Clamped,
}

/// A step at which the loops and contacts below are stable.
const STEP_S: f64 = 0.0005;
/// The loops are as stiff as the step allows (MuJoCo's documentation: a time constant of two steps).
const LOOP_SOLREF: [f64; 2] = [2.0 * STEP_S, 1.0];
const LOOP_SOLIMP: [f64; 5] = [0.9999, 0.9999, 0.001, 0.5, 2.0];
/// Coefficient of sliding: rubber on a clean floor, an assumption.
const SLIDING: f64 = 0.8;
/// Rolling resistance per newton of load, as a share of the radius. An assumption.
const ROLLING: f64 = 0.015;
/// Of two geoms the larger friction counts: what is no tyre has the least of MuJoCo's.
const LEAST_FRICTION: f64 = 1e-5;
const CLAMPED_HEIGHT_M: f64 = 1.0;

/// Bits of what touches what: the floor touches the robot, and the robot not itself.
const FLOOR: [&str; 2] = ["2", "1"];
const ROBOT: [&str; 2] = ["1", "2"];
const NOTHING: [&str; 2] = ["0", "0"];

impl Robot {
    /// The robot as MJCF, in the middle of its leg lengths. Names of bodies, joints and motors start with `left_` or
    /// `right_`. A hip's position is its joint coordinate; a knee is at 0 where the shank continues the thigh.
    pub fn mjcf(&self, hold: Hold) -> String {
        let length_m = f64::midpoint(self.legs.min_m, self.legs.max_m);
        let stance = Stance::of_length(&self.legs, length_m);
        let height_m = match hold {
            Hold::Free => length_m + self.wheels.radius_m,
            Hold::Clamped => CLAMPED_HEIGHT_M,
        };
        Element::new("mujoco")
            .text("model", self.name.as_str())
            .child(Element::new("compiler").text("angle", "radian"))
            .child(option())
            .child(default_contact())
            .child(scene::visual())
            .child(scene::assets())
            .child(
                Element::new("worldbody")
                    .children(scene::surroundings())
                    .child(self.body_element(hold, height_m, &stance)),
            )
            .child(Element::new("equality").children(SIDES.map(loop_element)))
            .child(self.actuators())
            .child(sensors())
            .child(Element::new("keyframe").child(named("key", "stand")))
            .document()
    }

    fn actuators(&self) -> Element {
        let hips = limbs().map(|(side, end)| drive(&part(side, end, "hip"), self.joints.peak_nm));
        let wheels = SIDES.map(|side| drive(&wheel_name(side), self.wheels.peak_nm()));
        Element::new("actuator").children(hips).children(wheels)
    }
}

fn default_contact() -> Element {
    let friction = [SLIDING, LEAST_FRICTION, LEAST_FRICTION];
    let geom = Element::new("geom").numbers("friction", &friction);
    Element::new("default").child(geom)
}

fn option() -> Element {
    Element::new("option")
        .numbers("timestep", &[STEP_S])
        .numbers("gravity", &[0.0, 0.0, -GRAVITY_MPS2])
        .text("integrator", "implicitfast")
        .text("cone", "elliptic")
        .numbers("impratio", &[10.0])
}

/// Both shanks of a leg hang on one axle.
fn loop_element(side: Side) -> Element {
    named("connect", &format!("{}_axle", side.name))
        .text("site1", part(side, Carrier::Front, "axle"))
        .text("site2", part(side, Carrier::Rear, "axle"))
        .numbers("solref", &LOOP_SOLREF)
        .numbers("solimp", &LOOP_SOLIMP)
}

fn sensors() -> Element {
    let at_imu = |kind, name| named(kind, name).text("site", "imu");
    let attitude = named("framequat", "attitude")
        .text("objtype", "body")
        .text("objname", "body");
    let joints = SIDES.into_iter().flat_map(|side| {
        let names = [
            part(side, Carrier::Front, "hip"),
            part(side, Carrier::Rear, "hip"),
            wheel_name(side),
        ];
        names.into_iter().flat_map(|joint| {
            let sense = |kind, what| named(kind, &format!("{joint}_{what}")).text("joint", &*joint);
            [sense("jointpos", "rad"), sense("jointvel", "rps")]
        })
    });
    Element::new("sensor")
        .child(at_imu("gyro", "gyro"))
        .child(at_imu("accelerometer", "accelerometer"))
        .child(attitude)
        .children(joints)
}

fn drive(joint: &str, peak_nm: f64) -> Element {
    named("motor", joint)
        .text("joint", joint)
        .numbers("ctrlrange", &[-peak_nm, peak_nm])
        .text("ctrllimited", "true")
}

fn touching(geom: Element, [kind, partners]: [&str; 2]) -> Element {
    geom.text("contype", kind).text("conaffinity", partners)
}

fn named(element: &'static str, name: &str) -> Element {
    Element::new(element).text("name", name)
}
