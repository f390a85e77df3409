//! Motors.

use super::{Case, assert_refused};

const REFUSED: &[Case] = &[
    Case {
        changes: &[("joints.continuous_nm", "4.0")],
        says: &[
            "joints.continuous_nm: 4 N m; allowed: more than 0, at most 3.5 N m, the continuous torque of a DM4310. Take the figure of your version's datasheet.",
        ],
    },
    Case {
        changes: &[("joints.peak_nm", "12.5")],
        says: &[
            "joints.peak_nm: 12.5 N m; allowed: more than 0, at most 10 N m, the peak torque of a DM4310. Take the figure of your version's datasheet.",
        ],
    },
    Case {
        changes: &[("joints.peak_nm", "2.5"), ("joints.torque_limit_nm", "2.0")],
        says: &[
            "joints.continuous_nm: 3 N m; allowed: at most peak_nm, 2.5 N m. Take both figures from the same datasheet.",
        ],
    },
    Case {
        changes: &[("joints.torque_limit_nm", "7.5")],
        says: &[
            "joints.torque_limit_nm: 7.5 N m; allowed: more than 0, at most peak_nm, 7 N m. Lower the limit.",
        ],
    },
    Case {
        changes: &[("joints.no_load_rps", "200.0")],
        says: &[
            "joints.no_load_rps: 200 rad/s; allowed: more than 0, at most 24 rad/s, which a DM4310 reaches at its highest voltage. Scale the datasheet's speed by your battery's voltage, and enter rad/s: rpm times 0.1047.",
        ],
    },
    Case {
        changes: &[("joints.speed_limit_rps", "31.0")],
        says: &[
            "joints.speed_limit_rps: 31 rad/s; allowed: more than 0, at most 30 rad/s, full scale of its frames. Lower the limit.",
        ],
    },
    Case {
        changes: &[("joints.max_kp", "501.0")],
        says: &[
            "joints.max_kp: 501; allowed: 0 to 500, full scale of its frames. Lower the limit.",
        ],
    },
    Case {
        changes: &[("joints.max_kd", "6.0")],
        says: &["joints.max_kd: 6; allowed: 0 to 5, full scale of its frames. Lower the limit."],
    },
    Case {
        changes: &[("joints.range_rad.front", "[0.75, -1.35]")],
        says: &[
            "joints.range_rad.front: 0.75 to -1.35 rad; allowed: a lower and an upper limit between -3.14 and 3.14 rad. Turn the joint to both stops and enter the angles, the lower one first.",
        ],
    },
    Case {
        changes: &[("joints.range_rad.rear", "[-0.75, 77.0]")],
        says: &[
            "joints.range_rad.rear: -0.75 to 77 rad; allowed: a lower and an upper limit between -3.14 and 3.14 rad. Turn the joint to both stops and enter the angles, the lower one first.",
        ],
    },
    Case {
        changes: &[("joints.zeros_rad", "[0.0, 90.0, 0.0, 0.0]")],
        says: &[
            "joints.zeros_rad: [0.0, 90.0, 0.0, 0.0] rad; allowed: within 12.5 rad, full scale of the motor's frames. Set the motor's zero with the thigh level, then enter what is left.",
        ],
    },
    Case {
        changes: &[("joints.directions", "[1, 1, -1, 0]")],
        says: &[
            "joints.directions: [1, 1, -1, 0]; allowed: 1 or -1 for each motor. Lift each front thigh, lower each rear thigh: 1 if the motor's angle grows.",
        ],
    },
    Case {
        changes: &[("wheels.signs", "[2, -1]")],
        says: &[
            "wheels.signs: [2, -1]; allowed: 1 or -1 for each motor. Roll each wheel forward: 1 if the rotor's speed is positive.",
        ],
    },
    Case {
        changes: &[("wheels.gear_ratio", "0.05")],
        says: &[
            "wheels.gear_ratio: 0.05; allowed: 1 to 100 rotor turns for one of the wheel. Enter 19.2 for an M3508 with its gear.",
        ],
    },
    Case {
        changes: &[("wheels.max_current_a", "10000.0")],
        says: &[
            "wheels.max_current_a: 10000 A; allowed: more than 0, at most 20 A, what a C620 gives. Lower the limit.",
        ],
    },
    Case {
        changes: &[("wheels.current_limit_a", "16.0")],
        says: &[
            "wheels.current_limit_a: 16 A; allowed: more than 0, at most max_current_a, 15 A. Lower the limit.",
        ],
    },
    Case {
        changes: &[("wheels.torque_nm_per_a", "0.0156")],
        says: &[
            "wheels.torque_nm_per_a: 0.0156 N m/A; allowed: 0.300 N m/A within 20 %, an M3508 behind this gear. Multiply 0.01562 by the gear ratio.",
        ],
    },
    Case {
        changes: &[("wheels.no_load_rps", "970.0")],
        says: &[
            "wheels.no_load_rps: 970 rad/s; allowed: more than 0, at most 55.5 rad/s, an M3508 behind this gear at 26 V. Scale 970 rad/s of the rotor by your voltage / 24 V and divide it by the gear ratio.",
        ],
    },
];

#[test]
fn files_are_refused() {
    assert_refused(REFUSED);
}
