//! Lengths and poses.

use super::{Case, assert_refused};

const REFUSED: &[Case] = &[
    Case {
        changes: &[("legs.hip_gap_m", "100.0")],
        says: &[
            "legs.hip_gap_m: 100 m; allowed: more than 0, less than 2 m. Measure from axis to axis, in m.",
        ],
    },
    Case {
        changes: &[("legs.max_m", "0.10")],
        says: &[
            "legs.max_m: 0.1 m; allowed: more than min_m, 0.11 m. Enter the longest usable leg.",
            "control.limits.height_m: 0.13 to 0.26 m; allowed: a range within the leg's 0.11 to 0.1 m. Leave some travel at both ends for bumps.",
        ],
    },
    Case {
        changes: &[("control.limits.height_m", "[0.13, 0.36]")],
        says: &[
            "control.limits.height_m: 0.13 to 0.36 m; allowed: a range within the leg's 0.11 to 0.3 m. Leave some travel at both ends for bumps.",
        ],
    },
    Case {
        changes: &[("wheels.track_m", "0.26")],
        says: &[
            "wheels.track_m: 0.26 m; allowed: more than 0.270 m, so that the wheels pass the body. Measure between the middles of the tyres.",
        ],
    },
    Case {
        changes: &[("legs.shank.length_m", "0.165")],
        says: &[
            "joints.range_rad: the shanks do not meet at some hip angles; allowed: shanks that meet at all hip angles. Narrow the ranges, or make the shanks longer.",
        ],
    },
    Case {
        changes: &[("legs.shank.length_m", "0.1705")],
        says: &[
            "joints.range_rad: the shanks come within 8.9 degrees of one line, where the axle gives way; allowed: 10 degrees. Narrow the ranges.",
            "joints.range_rad: a knee comes within -8.1 degrees of folded or straight, where its hip cannot move the axle; allowed: 3 degrees. Narrow the ranges, with a stop on each thigh.",
            "legs.max_m: 0.3 m is beyond what the links reach; allowed: a length with hips in [-1.35, 0.75] and [-0.75, 1.35] rad. Change the length or the ranges of the hips.",
        ],
    },
    Case {
        changes: &[
            ("joints.range_rad.front", "[-1.35, 1.2]"),
            ("joints.range_rad.rear", "[-1.2, 1.35]"),
        ],
        says: &[
            "joints.range_rad: a knee comes within -4.1 degrees of folded or straight, where its hip cannot move the axle; allowed: 3 degrees. Narrow the ranges, with a stop on each thigh.",
        ],
    },
    Case {
        changes: &[("legs.max_m", "0.33")],
        says: &[
            "legs.max_m: 0.33 m needs hips at -1.46 and 1.46 rad; allowed: a length with hips in [-1.35, 0.75] and [-0.75, 1.35] rad. Change the length or the ranges of the hips.",
        ],
    },
    Case {
        changes: &[("legs.min_m", "0.05")],
        says: &[
            "legs.min_m: 0.05 m is beyond what the links reach; allowed: a length with hips in [-1.35, 0.75] and [-0.75, 1.35] rad. Change the length or the ranges of the hips.",
        ],
    },
];

#[test]
fn files_are_refused() {
    assert_refused(REFUSED);
}
