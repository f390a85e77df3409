//! The robot as URDF.
//!
//! Links and joints have the names and places that they have in MuJoCo. URDF knows no loops and no inertia of rotors: the
//! five-bars are open at the axles, and the joints have the inertia of the links alone.

use std::f64::consts::FRAC_PI_2;

use crate::{
    Carrier, Link, Robot,
    parts::{
        BODY_COLOUR, LINK_RADIUS_M, MOTOR_COLOUR, NONE_KGM2, Side, TYRE_COLOUR,
        WHEEL_MOTOR_RADIUS_M, limbs, link_colour, out, part, wheel_name,
    },
    xml::Element,
};

const LOOPS: &str = " Each leg is a closed five-bar, which URDF cannot say. Close it in your simulator: the frames \
    left_front_axle and left_rear_axle are one point, and right_front_axle and right_rear_axle. Joint angles: a hip is at \
    0 with its thigh level and outward, a knee where the shank continues the thigh; both grow about -y. `cargo xtask robot \
    mjcf` writes the same robot with closed loops and with the inertia of its rotors. ";

impl Robot {
    /// The robot as URDF.
    pub fn urdf(&self) -> String {
        let root = Element::new("robot")
            .text("name", self.name.as_str())
            .comment(LOOPS)
            .child(self.body_link());
        limbs()
            .fold(root, |root, (side, end)| {
                root.children(self.thigh_link(side, end))
                    .children(self.shank_link(side, end))
            })
            .document()
    }

    fn body_link(&self) -> Element {
        let shape = Shape {
            geometry: Element::new("box").numbers("size", &self.body.box_m),
            place_m: self.body.box_centre_m,
            turn_rad: [0.0; 3],
            colour: BODY_COLOUR,
        };
        link("body")
            .child(inertial(
                self.body.mass_kg,
                self.body.com_m,
                self.body.inertia_kgm2,
            ))
            .children(shape.seen_and_touched())
    }

    fn thigh_link(&self, side: Side, end: Carrier) -> [Element; 2] {
        let name = part(side, end, "thigh");
        let [low, high] = self.joints.hip_range_rad(end);
        let limit = Element::new("limit")
            .numbers("lower", &[low])
            .numbers("upper", &[high])
            .numbers("effort", &[self.joints.peak_nm])
            .numbers("velocity", &[self.joints.no_load_rps]);
        let hip = joint("revolute", &part(side, end, "hip"), ["body", &*name])
            .child(origin(self.legs.hip_m(side, end), [0.0; 3]))
            .child(axis(-1.0))
            .child(limit);
        [rod(&name, &self.legs.thigh, end), hip]
    }

    /// A shank with what hangs on it.
    fn shank_link(&self, side: Side, end: Carrier) -> Vec<Element> {
        let [thigh, shank] = ["thigh", "shank"].map(|what| part(side, end, what));
        let [axle, knee] = ["axle", "knee"].map(|what| part(side, end, what));
        let at_knee = [out(end) * self.legs.thigh.length_m, 0.0, 0.0];
        let at_axle = [out(end) * self.legs.shank.length_m, 0.0, 0.0];
        let mut elements = vec![
            rod(&shank, &self.legs.shank, end),
            joint("continuous", &knee, [&thigh, &shank])
                .child(origin(at_knee, [0.0; 3]))
                .child(axis(-1.0)),
            link(&axle),
            joint("fixed", &axle, [&shank, &axle]).child(origin(at_axle, [0.0; 3])),
        ];
        if end == self.wheels.carrier {
            elements.extend(self.wheel_motor_link(side, &axle));
            elements.extend(self.wheel_link(side, &axle));
        }
        elements
    }

    fn wheel_motor_link(&self, side: Side, axle: &str) -> [Element; 2] {
        let name = format!("{}_wheel_motor", side.name);
        let outward = self.legs.wheel_outward_m(&self.wheels, side);
        let shape = Shape {
            geometry: cylinder(WHEEL_MOTOR_RADIUS_M, outward.abs()),
            place_m: [0.0, outward / 2.0, 0.0],
            turn_rad: ACROSS,
            colour: MOTOR_COLOUR,
        };
        let motor = link(&name)
            .child(inertial(
                self.wheels.motor_mass_kg,
                [0.0; 3],
                [NONE_KGM2; 3],
            ))
            .child(shape.seen());
        [motor, joint("fixed", &name, [axle, &*name])]
    }

    fn wheel_link(&self, side: Side, axle: &str) -> [Element; 2] {
        let name = wheel_name(side);
        let shape = Shape {
            geometry: cylinder(self.wheels.radius_m, self.wheels.width_m),
            place_m: [0.0; 3],
            turn_rad: ACROSS,
            colour: TYRE_COLOUR,
        };
        let wheel = link(&name)
            .child(inertial(
                self.wheels.mass_kg,
                [0.0; 3],
                self.wheels.turning_kgm2(),
            ))
            .children(shape.seen_and_touched());
        let outward = self.legs.wheel_outward_m(&self.wheels, side);
        let limit = Element::new("limit")
            .numbers("effort", &[self.wheels.peak_nm()])
            .numbers("velocity", &[self.wheels.no_load_rps]);
        let turns = joint("continuous", &name, [axle, &*name])
            .child(origin([0.0, outward, 0.0], [0.0; 3]))
            .child(axis(1.0))
            .child(limit);
        [wheel, turns]
    }
}

/// The turn that lays a cylinder, which stands along z, along y.
const ACROSS: [f64; 3] = [FRAC_PI_2, 0.0, 0.0];
/// The turn that lays it along x.
const ALONG: [f64; 3] = [0.0, FRAC_PI_2, 0.0];

/// What a link looks like.
struct Shape {
    geometry: Element,
    place_m: [f64; 3],
    turn_rad: [f64; 3],
    colour: [f64; 4],
}

impl Shape {
    fn seen(&self) -> Element {
        let colour = Element::new("color").numbers("rgba", &self.colour);
        self.placed("visual")
            .child(Element::new("material").text("name", "").child(colour))
    }

    fn seen_and_touched(&self) -> [Element; 2] {
        [self.seen(), self.placed("collision")]
    }

    fn placed(&self, kind: &'static str) -> Element {
        Element::new(kind)
            .child(origin(self.place_m, self.turn_rad))
            .child(Element::new("geometry").child(self.geometry.clone()))
    }
}

fn rod(name: &str, rod: &Link, end: Carrier) -> Element {
    let shape = Shape {
        geometry: cylinder(LINK_RADIUS_M, rod.length_m),
        place_m: [out(end) * rod.length_m / 2.0, 0.0, 0.0],
        turn_rad: ALONG,
        colour: link_colour(end),
    };
    let centre_m = [out(end) * rod.com_m, 0.0, 0.0];
    link(name)
        .child(inertial(rod.mass_kg, centre_m, rod.rod_kgm2()))
        .children(shape.seen_and_touched())
}

fn cylinder(radius_m: f64, length_m: f64) -> Element {
    Element::new("cylinder")
        .numbers("radius", &[radius_m])
        .numbers("length", &[length_m])
}

fn link(name: &str) -> Element {
    Element::new("link").text("name", name)
}

fn joint(kind: &'static str, name: &str, [parent, child]: [&str; 2]) -> Element {
    Element::new("joint")
        .text("name", name)
        .text("type", kind)
        .child(Element::new("parent").text("link", parent))
        .child(Element::new("child").text("link", child))
}

/// The axis of a hinge along y.
fn axis(sign: f64) -> Element {
    Element::new("axis").numbers("xyz", &[0.0, sign, 0.0])
}

fn origin(place_m: [f64; 3], turn_rad: [f64; 3]) -> Element {
    Element::new("origin")
        .numbers("xyz", &place_m)
        .numbers("rpy", &turn_rad)
}

fn inertial(mass_kg: f64, centre_m: [f64; 3], [x, y, z]: [f64; 3]) -> Element {
    let zeros = ["ixy", "ixz", "iyz"];
    let inertia = Element::new("inertia")
        .numbers("ixx", &[x])
        .numbers("iyy", &[y])
        .numbers("izz", &[z]);
    let inertia = zeros
        .into_iter()
        .fold(inertia, |it, product| it.numbers(product, &[0.0]));
    Element::new("inertial")
        .child(origin(centre_m, [0.0; 3]))
        .child(Element::new("mass").numbers("value", &[mass_kg]))
        .child(inertia)
}
