//! The bodies of the robot.

use super::{Hold, NOTHING, ROBOT, ROLLING, SLIDING, named, touching};
use crate::{
    Body, Carrier, Imu, Legs, Link, Robot, Wheels,
    parts::{
        ARROW_COLOUR, BODY_COLOUR, HIP_MOTOR_RADIUS_M, LINK_RADIUS_M, MARK_COLOUR, MOTOR_COLOUR,
        NONE_KGM2, Side, TYRE_COLOUR, WHEEL_MOTOR_RADIUS_M, limbs, link_colour, out, part,
        wheel_name,
    },
    stance::{Bend, Stance},
    xml::Element,
};

impl Robot {
    pub(super) fn body_element(&self, hold: Hold, height_m: f64, stance: &Stance) -> Element {
        let body = named("body", "body").numbers("pos", &[0.0, 0.0, height_m]);
        let body = match hold {
            Hold::Free => body.child(named("freejoint", "free")),
            Hold::Clamped => body,
        };
        let body = body.children(shell(&self.body)).child(imu_site(&self.imu));
        limbs().fold(body, |body, (side, end)| {
            body.child(self.hip_motor(side, end))
                .child(self.thigh(side, end, stance))
        })
    }

    /// A hip's motor to look at: its mass is the body's.
    fn hip_motor(&self, side: Side, end: Carrier) -> Element {
        let [x, y, z] = self.legs.hip_m(side, end);
        let wall = side.sign * self.body.box_m[1] / 2.0;
        let ends = [[x, wall, z], [x, y, z]];
        cylinder(&ends.concat(), HIP_MOTOR_RADIUS_M)
    }

    fn thigh(&self, side: Side, end: Carrier, stance: &Stance) -> Element {
        let Bend { hip_rad, .. } = stance.bend(end);
        named("body", &part(side, end, "thigh"))
            .numbers("pos", &self.legs.hip_m(side, end))
            .numbers("quat", &turned(hip_rad))
            .child(
                hinge(&part(side, end, "hip"), hip_rad)
                    .numbers("armature", &[self.joints.armature_kgm2])
                    .numbers("range", &self.joints.hip_range_rad(end))
                    .text("limited", "true"),
            )
            .children(rod(&self.legs.thigh, end))
            .child(self.shank(side, end, stance))
    }

    fn shank(&self, side: Side, end: Carrier, stance: &Stance) -> Element {
        let Bend { knee_rad, .. } = stance.bend(end);
        let Legs { thigh, shank, .. } = &self.legs;
        let axle = [out(end) * shank.length_m, 0.0, 0.0];
        let element = named("body", &part(side, end, "shank"))
            .numbers("pos", &[out(end) * thigh.length_m, 0.0, 0.0])
            .numbers("quat", &turned(knee_rad))
            .child(hinge(&part(side, end, "knee"), knee_rad))
            .children(rod(shank, end))
            .child(named("site", &part(side, end, "axle")).numbers("pos", &axle));
        if end == self.wheels.carrier {
            element
                .child(self.wheel_motor(side, axle))
                .child(self.wheel(side, axle))
        } else {
            element
        }
    }

    /// The still part of a wheel's motor.
    fn wheel_motor(&self, side: Side, axle: [f64; 3]) -> Element {
        let outward = self.legs.wheel_outward_m(&self.wheels, side);
        named("body", &format!("{}_wheel_motor", side.name))
            .numbers("pos", &axle)
            .child(inertial(
                self.wheels.motor_mass_kg,
                [0.0; 3],
                [NONE_KGM2; 3],
            ))
            .child(cylinder(
                &[0.0, 0.0, 0.0, 0.0, outward, 0.0],
                WHEEL_MOTOR_RADIUS_M,
            ))
    }

    fn wheel(&self, side: Side, [x, _, z]: [f64; 3]) -> Element {
        let Wheels {
            radius_m, width_m, ..
        } = self.wheels;
        let half_m = width_m / 2.0;
        let wheel = touching(Element::new("geom"), NOTHING)
            .text("type", "cylinder")
            .numbers("fromto", &[0.0, -half_m, 0.0, 0.0, half_m, 0.0])
            .numbers("size", &[radius_m])
            .numbers("rgba", &TYRE_COLOUR);
        // An ellipsoid rolls as a tyre with a round cross-section does, as long as it leans little. Viewers hide group 3.
        let across_m = (radius_m * self.wheels.cross_section_m()).sqrt();
        let friction = [
            SLIDING,
            SLIDING * self.wheels.twist_lever_m(),
            ROLLING * radius_m,
        ];
        let tyre = touching(named("geom", &wheel_name(side)), ROBOT)
            .text("type", "ellipsoid")
            .numbers("size", &[radius_m, across_m, radius_m])
            .text("condim", "6")
            .numbers("friction", &friction)
            .text("group", "3");
        let mark = touching(Element::new("geom"), NOTHING)
            .text("type", "box")
            .numbers("size", &[0.8 * radius_m, 1.02 * half_m, 0.1 * radius_m])
            .numbers("rgba", &MARK_COLOUR);
        named("body", &wheel_name(side))
            .numbers(
                "pos",
                &[x, self.legs.wheel_outward_m(&self.wheels, side), z],
            )
            .child(
                named("joint", &wheel_name(side))
                    .numbers("axis", &[0.0, 1.0, 0.0])
                    .numbers("armature", &[self.wheels.rotor_inertia_kgm2]),
            )
            .child(inertial(
                self.wheels.mass_kg,
                [0.0; 3],
                self.wheels.turning_kgm2(),
            ))
            .children([wheel, tyre, mark])
    }
}

/// What the body weighs and looks like, with an arrow that points forward.
fn shell(body: &Body) -> [Element; 3] {
    let [half_x, half_y, half_z] = body.box_m.map(|size| size / 2.0);
    let [x, y, z] = body.box_centre_m;
    let shell = touching(named("geom", "box"), ROBOT)
        .text("type", "box")
        .numbers("pos", &[x, y, z])
        .numbers("size", &[half_x, half_y, half_z])
        .numbers("rgba", &BODY_COLOUR);
    let top = z + half_z;
    let arrow = touching(named("geom", "forward"), NOTHING)
        .text("type", "capsule")
        .numbers("fromto", &[x, y, top, x + 0.9 * half_x, y, top])
        .numbers("size", &[LINK_RADIUS_M])
        .numbers("rgba", &ARROW_COLOUR);
    [
        inertial(body.mass_kg, body.com_m, body.inertia_kgm2),
        shell,
        arrow,
    ]
}

fn imu_site(imu: &Imu) -> Element {
    let [x, y, _] = imu.mounting.axes();
    named("site", "imu")
        .numbers("pos", &imu.place_m)
        .numbers("xyaxes", &[x, y].concat())
}

fn rod(link: &Link, end: Carrier) -> [Element; 2] {
    let centre = [out(end) * link.com_m, 0.0, 0.0];
    let end_x = out(end) * link.length_m;
    let shape = touching(Element::new("geom"), ROBOT)
        .text("type", "capsule")
        .numbers("fromto", &[0.0, 0.0, 0.0, end_x, 0.0, 0.0])
        .numbers("size", &[LINK_RADIUS_M])
        .numbers("rgba", &link_colour(end));
    [inertial(link.mass_kg, centre, link.rod_kgm2()), shape]
}

/// A hinge about −y that stands at `angle_rad` in the model as written.
fn hinge(name: &str, angle_rad: f64) -> Element {
    named("joint", name)
        .numbers("axis", &[0.0, -1.0, 0.0])
        .numbers("ref", &[angle_rad])
}

fn inertial(mass_kg: f64, centre_m: [f64; 3], inertia_kgm2: [f64; 3]) -> Element {
    Element::new("inertial")
        .numbers("pos", &centre_m)
        .numbers("mass", &[mass_kg])
        .numbers("diaginertia", &inertia_kgm2)
}

/// A part of a motor, to look at.
fn cylinder(fromto: &[f64], radius_m: f64) -> Element {
    touching(Element::new("geom"), NOTHING)
        .text("type", "cylinder")
        .numbers("fromto", fromto)
        .numbers("size", &[radius_m])
        .numbers("rgba", &MOTOR_COLOUR)
}

/// The quaternion, scalar first, of a turn about −y.
fn turned(angle_rad: f64) -> [f64; 4] {
    let (sin, cos) = (angle_rad / 2.0).sin_cos();
    [cos, 0.0, -sin, 0.0]
}
