//! Masses and moments of inertia.

use super::{Case, assert_refused};

const REFUSED: &[Case] = &[
    Case {
        changes: &[("body.mass_kg", "-4.30")],
        says: &["body.mass_kg: -4.3 kg; allowed: more than 0 kg. Weigh it."],
    },
    Case {
        changes: &[("legs.thigh.mass_kg", "0.0")],
        says: &["legs.thigh.mass_kg: 0 kg; allowed: more than 0 kg. Weigh it."],
    },
    Case {
        changes: &[("legs.shank.mass_kg", "nan")],
        says: &["legs.shank.mass_kg: NaN kg; allowed: more than 0 kg. Weigh it."],
    },
    Case {
        changes: &[("wheels.mass_kg", "0.0")],
        says: &["wheels.mass_kg: 0 kg; allowed: more than 0 kg. Weigh it."],
    },
    Case {
        changes: &[("wheels.motor_mass_kg", "0.0")],
        says: &["wheels.motor_mass_kg: 0 kg; allowed: more than 0 kg. Weigh it."],
    },
    Case {
        changes: &[("body.inertia_kgm2", "[0.042, 0.031, 0.085]")],
        says: &[
            "body.inertia_kgm2: 0.042, 0.031, 0.085 kg m2; allowed: three figures above 0, none above the sum of the other two. Swing the body about each axis again; no body has such moments.",
        ],
    },
    Case {
        changes: &[("body.inertia_kgm2", "[42.0, 31.0, 65.0]")],
        says: &[
            "body.inertia_kgm2: 65 kg m2; allowed: at most 0.217 kg m2, all of its mass at its corners. Enter kg m2, not kg mm2 or g m2.",
        ],
    },
    Case {
        changes: &[("body.box_m", "[0.30, 0.0, 0.12]")],
        says: &[
            "body.box_m: 0.3 x 0 x 0.12 m; allowed: three lengths above 0 m. Measure length, width and height of the body.",
        ],
    },
    Case {
        changes: &[("body.com_m", "[0.0, 0.0, 20.0]")],
        says: &[
            "body.com_m: 0, 0, 20 m; allowed: a place in the box of box_m and box_centre_m. Count from the hip centre, in m.",
        ],
    },
    Case {
        changes: &[("legs.thigh.com_m", "0.13")],
        says: &[
            "legs.thigh.com_m: 0.13 m; allowed: 0 to 0.12 m, its length. Balance the link on an edge and measure from its upper axis.",
        ],
    },
    Case {
        changes: &[("legs.shank.com_m", "-0.1")],
        says: &[
            "legs.shank.com_m: -0.1 m; allowed: 0 to 0.22 m, its length. Balance the link on an edge and measure from its upper axis.",
        ],
    },
    Case {
        changes: &[("legs.thigh.inertia_kgm2", "1.5e-3")],
        says: &[
            "legs.thigh.inertia_kgm2: 1.5e-3 kg m2; allowed: more than 0, at most 3.5e-4 kg m2, all of its mass at its axes. Swing the link as a pendulum again, and subtract mass times distance squared.",
        ],
    },
    Case {
        changes: &[("legs.shank.inertia_kgm2", "0.0")],
        says: &[
            "legs.shank.inertia_kgm2: 0.0e0 kg m2; allowed: more than 0, at most 1.4e-3 kg m2, all of its mass at its axes. Swing the link as a pendulum again, and subtract mass times distance squared.",
        ],
    },
    Case {
        changes: &[("wheels.radius_m", "0.0")],
        says: &["wheels.radius_m: 0 m; allowed: more than 0 m. Measure it."],
    },
    Case {
        changes: &[("wheels.track_m", "inf")],
        says: &["wheels.track_m: inf m; allowed: more than 0 m. Measure it."],
    },
    Case {
        changes: &[("wheels.width_m", "-0.03")],
        says: &["wheels.width_m: -0.03 m; allowed: more than 0 m. Measure it."],
    },
    Case {
        changes: &[("wheels.inertia_kgm2", "1.01e-2")],
        says: &[
            "wheels.inertia_kgm2: 1.0e-2 kg m2; allowed: more than 0, at most 1.8e-3 kg m2, all of its mass at the tyre. Leave out the rotor, which rotor_inertia_kgm2 tells.",
        ],
    },
    Case {
        changes: &[("wheels.rotor_inertia_kgm2", "-1.0")],
        says: &[
            "wheels.rotor_inertia_kgm2: -1 kg m2; allowed: 0 to 0.1 kg m2. Multiply that of the rotor by the gear ratio squared.",
        ],
    },
    Case {
        changes: &[("joints.armature_kgm2", "1.8")],
        says: &[
            "joints.armature_kgm2: 1.8 kg m2; allowed: 0 to 0.1 kg m2. Multiply that of the rotor by the gear ratio squared.",
        ],
    },
];

#[test]
fn files_are_refused() {
    assert_refused(REFUSED);
}
