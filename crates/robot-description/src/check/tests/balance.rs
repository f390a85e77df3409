//! What the robot can do.

use super::{Case, assert_refused, assert_warned};

const REFUSED: &[Case] = &[
    Case {
        changes: &[("body.mass_kg", "7.30")],
        says: &[
            "joints.continuous_nm: standing at 0.21 m needs 3.18 N m of each hip, 106 % of it; allowed: 100 %. Make the robot lighter, its thighs shorter, or take stronger motors.",
        ],
    },
    Case {
        changes: &[
            ("body.box_centre_m", "[0.0, 0.0, -0.15]"),
            ("body.com_m", "[0.0, 0.0, -0.12]"),
            ("imu.place_m", "[0.03, 0.0, -0.15]"),
            ("body.box_m", "[0.30, 0.24, 0.22]"),
        ],
        says: &[
            "control.limits.height_m: the body is -0.055 m above the ground at the lowest height; allowed: more than 0 m. Raise the lowest height.",
        ],
    },
    Case {
        changes: &[("body.com_m", "[0.06, 0.0, 0.02]")],
        says: &[
            "body.com_m: 0.06 m forward; with folded legs the legs would have to lean by 0.49 rad; allowed: -0.22 to 0.22 rad, so that the wheels come under it. Move the battery, or check the sign: forward is positive.",
        ],
    },
    Case {
        changes: &[("control.limits.max_speed_mps", "3.5")],
        says: &[
            "control.limits.max_speed_mps: 3.5 m/s; allowed: more than 0, at most 3.41 m/s, 90 % of the unloaded wheel's 3.79. Ask for less, or take larger wheels: at its top speed a motor has no torque left to balance.",
        ],
    },
    Case {
        changes: &[("control.limits.max_yaw_rps", "17.0")],
        says: &[
            "control.limits.max_yaw_rps: 17 rad/s; allowed: more than 0, at most 16.2 rad/s, 90 % of what unloaded wheels turn it. Ask for less.",
        ],
    },
    Case {
        changes: &[("control.limits.max_roll_rad", "12.0")],
        says: &[
            "control.limits.max_roll_rad: 12 rad; allowed: 0 to 0.42 rad, one leg folded and one stretched. Ask for less.",
        ],
    },
    Case {
        changes: &[("control.limits.jump_m", "0.5")],
        says: &[
            "control.limits.jump_m: 0.5 m; allowed: 0 to 0.24 m, which the hips' torque, speed and stroke give (1.97 m/s at take-off). Ask for less, raise torque_limit_nm, or make the robot lighter.",
        ],
    },
    Case {
        changes: &[("control.delay_s", "3.0")],
        says: &["control.delay_s: 3 s; allowed: 0 to 0.02 s. Enter seconds; 0.003 is usual here."],
    },
    Case {
        changes: &[(
            "control.weights.q",
            "[-1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]",
        )],
        says: &[
            "control.weights.q: [-1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]; allowed: ten figures of at least 0. A larger weight keeps that state smaller.",
        ],
    },
    Case {
        changes: &[("control.weights.r", "[0.0, 1.0, 1.0, 1.0]")],
        says: &[
            "control.weights.r: [0.0, 1.0, 1.0, 1.0]; allowed: four figures above 0. A larger weight spares that torque.",
        ],
    },
    Case {
        changes: &[("imu.place_m", "[30.0, 0.0, 50.0]")],
        says: &[
            "imu.place_m: 30, 0, 50 m; allowed: a place in the body's box. Measure from the hip centre to the board's middle.",
        ],
    },
];

#[test]
fn files_are_refused() {
    assert_refused(REFUSED);
}

const WARNED: &[Case] = &[
    Case {
        changes: &[("body.mass_kg", "5.30")],
        says: &[
            "joints.continuous_nm: standing at 0.21 m needs 2.38 N m of each hip, 79 % of it; allowed: 70 %, so that the motors stay cool on uneven ground. Make the robot lighter, its thighs shorter, or stand lower.",
        ],
    },
    Case {
        changes: &[
            ("joints.range_rad.front", "[-1.11, 0.75]"),
            ("joints.range_rad.rear", "[-0.75, 1.11]"),
            ("control.limits.height_m", "[0.25, 0.30]"),
        ],
        says: &[
            "joints.range_rad: at middle height the legs lean by -0.15 to 0.15 rad; allowed: 0.25 rad either way, for braking and pushes. Widen the ranges of the hips.",
        ],
    },
    Case {
        changes: &[("body.com_m", "[0.0, 0.05, 0.02]")],
        says: &["body.com_m: 0.05 m to the left; allowed: a tenth of the track. Move the battery."],
    },
];

#[test]
fn files_are_warned_of() {
    assert_warned(WARNED);
}
