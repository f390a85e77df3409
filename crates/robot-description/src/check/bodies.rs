//! Masses and moments of inertia.

use super::{Findings, Severity::Error};
use crate::{Link, Robot};

pub(super) fn check(robot: &Robot, findings: &mut Findings) {
    masses(robot, findings);
    wheel_lengths(robot, findings);
    if findings.has_errors() {
        return;
    }
    body(robot, findings);
    let fields = LinkFields {
        com_m: "legs.thigh.com_m",
        inertia_kgm2: "legs.thigh.inertia_kgm2",
    };
    link(&robot.legs.thigh, &fields, findings);
    let fields = LinkFields {
        com_m: "legs.shank.com_m",
        inertia_kgm2: "legs.shank.inertia_kgm2",
    };
    link(&robot.legs.shank, &fields, findings);
    wheel(robot, findings);
}

fn masses(robot: &Robot, findings: &mut Findings) {
    let Robot {
        body, legs, wheels, ..
    } = robot;
    for (field, mass_kg) in [
        ("body.mass_kg", body.mass_kg),
        ("legs.thigh.mass_kg", legs.thigh.mass_kg),
        ("legs.shank.mass_kg", legs.shank.mass_kg),
        ("wheels.mass_kg", wheels.mass_kg),
        ("wheels.motor_mass_kg", wheels.motor_mass_kg),
    ] {
        findings.note(
            Error,
            mass_kg > 0.0 && mass_kg.is_finite(),
            field,
            format!("{mass_kg} kg"),
            "more than 0 kg",
            "Weigh it.",
        );
    }
}

fn body(robot: &Robot, findings: &mut Findings) {
    let body = &robot.body;
    let [x, y, z] = body.inertia_kgm2;
    let largest = x.max(y).max(z);
    findings.note(
        Error,
        x.min(y).min(z) > 0.0 && 2.0 * largest <= x + y + z,
        "body.inertia_kgm2",
        format!("{x}, {y}, {z} kg m2"),
        "three figures above 0, none above the sum of the other two",
        "Swing the body about each axis again; no body has such moments.",
    );
    let [length, width, height] = body.box_m;
    findings.note(
        Error,
        length.min(width).min(height) > 0.0,
        "body.box_m",
        format!("{length} x {width} x {height} m"),
        "three lengths above 0 m",
        "Measure length, width and height of the body.",
    );
    // All of the mass at the farthest corner, or at the hip motors, which sit beside the body.
    let corner_m = (length.hypot(width).hypot(height) / 2.0).max(robot.legs.plane_y_m);
    let most_kgm2 = body.mass_kg * corner_m.powi(2);
    findings.note(
        Error,
        largest <= most_kgm2,
        "body.inertia_kgm2",
        format!("{largest} kg m2"),
        format!("at most {most_kgm2:.3} kg m2, all of its mass at its corners"),
        "Enter kg m2, not kg mm2 or g m2.",
    );
    let inside = (0..3)
        .all(|axis| (body.com_m[axis] - body.box_centre_m[axis]).abs() <= body.box_m[axis] / 2.0);
    let [x, y, z] = body.com_m;
    findings.note(
        Error,
        inside,
        "body.com_m",
        format!("{x}, {y}, {z} m"),
        "a place in the box of box_m and box_centre_m",
        "Count from the hip centre, in m.",
    );
}

struct LinkFields {
    com_m: &'static str,
    inertia_kgm2: &'static str,
}

fn link(link: &Link, fields: &LinkFields, findings: &mut Findings) {
    let Link {
        length_m,
        mass_kg,
        com_m,
        inertia_kgm2,
    } = link;
    let inside = (0.0..=*length_m).contains(com_m);
    findings.note(
        Error,
        inside,
        fields.com_m,
        format!("{com_m} m"),
        format!("0 to {length_m} m, its length"),
        "Balance the link on an edge and measure from its upper axis.",
    );
    if !inside {
        return;
    }
    // All of the mass at the two axes.
    let most_kgm2 = mass_kg * com_m * (length_m - com_m);
    findings.note(
        Error,
        *inertia_kgm2 > 0.0 && *inertia_kgm2 <= most_kgm2,
        fields.inertia_kgm2,
        format!("{inertia_kgm2:.1e} kg m2"),
        format!("more than 0, at most {most_kgm2:.1e} kg m2, all of its mass at its axes"),
        "Swing the link as a pendulum again, and subtract mass times distance squared.",
    );
}

fn wheel_lengths(robot: &Robot, findings: &mut Findings) {
    let wheels = &robot.wheels;
    for (field, length_m) in [
        ("wheels.radius_m", wheels.radius_m),
        ("wheels.track_m", wheels.track_m),
        ("wheels.width_m", wheels.width_m),
    ] {
        findings.note(
            Error,
            length_m > 0.0 && length_m.is_finite(),
            field,
            format!("{length_m} m"),
            "more than 0 m",
            "Measure it.",
        );
    }
}

fn wheel(robot: &Robot, findings: &mut Findings) {
    let wheels = &robot.wheels;
    let most_kgm2 = wheels.mass_kg * wheels.radius_m.powi(2);
    findings.note(
        Error,
        wheels.inertia_kgm2 > 0.0 && wheels.inertia_kgm2 <= most_kgm2,
        "wheels.inertia_kgm2",
        format!("{:.1e} kg m2", wheels.inertia_kgm2),
        format!("more than 0, at most {most_kgm2:.1e} kg m2, all of its mass at the tyre"),
        "Leave out the rotor, which rotor_inertia_kgm2 tells.",
    );
    for (field, inertia_kgm2) in [
        ("wheels.rotor_inertia_kgm2", wheels.rotor_inertia_kgm2),
        ("joints.armature_kgm2", robot.joints.armature_kgm2),
    ] {
        findings.note(
            Error,
            (0.0..=0.1).contains(&inertia_kgm2),
            field,
            format!("{inertia_kgm2} kg m2"),
            "0 to 0.1 kg m2",
            "Multiply that of the rotor by the gear ratio squared.",
        );
    }
}
