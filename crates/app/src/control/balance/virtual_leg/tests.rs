use super::*;
use crate::domain::LegGeometry;

const GEOMETRY: LegGeometry = LegGeometry::EXAMPLE;

fn legs() -> impl Iterator<Item = Leg> {
    let angles = [-1.0_f32, -0.5, -0.1, 0.3, 0.6];
    angles
        .into_iter()
        .flat_map(move |front| angles.map(|rear| Leg::new(&GEOMETRY, [front, -rear], [0.8, -1.7])))
}

/// In any motion hips and leg do the same work.
#[test]
fn hip_torques_do_the_work_of_the_force() {
    for leg in legs() {
        let force = LegForce {
            push_n: 40.0,
            lean_nm: 3.0,
        };
        let [front_nm, rear_nm] = hip_torques_nm(&leg, force);
        let by_hips_w = front_nm * 0.8 - rear_nm * 1.7;
        // The body turns the leg about +y, and its angle counts the other way.
        let by_leg_w = 40.0 * leg.length_mps - 3.0 * leg.angle_rps;
        assert!((by_hips_w - by_leg_w).abs() < 1e-3, "{leg:?}");
    }
}

/// The motor's reaction on its shank and the added torques together do the work of a reaction on the virtual leg.
#[test]
fn the_reaction_of_the_wheel_acts_on_the_whole_leg() {
    for leg in legs() {
        let [front_nm, rear_nm] = reaction_nm(&leg, 1.5);
        let added_w = front_nm * 0.8 - rear_nm * 1.7;
        let on_shank_w = -1.5 * leg.carrier_rps;
        let on_leg_w = 1.5 * leg.angle_rps;
        assert!((added_w + on_shank_w - on_leg_w).abs() < 1e-4, "{leg:?}");
    }
}

#[test]
fn the_force_is_found_again_from_the_torques() {
    for leg in legs() {
        let force = LegForce {
            push_n: 31.0,
            lean_nm: -2.0,
        };
        let found = force_of(&leg, hip_torques_nm(&leg, force));
        assert!((found.push_n - 31.0).abs() < 0.01, "{leg:?} {found:?}");
        assert!((found.lean_nm + 2.0).abs() < 0.001, "{leg:?} {found:?}");
    }
}

/// By hand: each shank pushes its knee up with F/2, at the end of a level thigh of 0.12 m, and outward, along that thigh.
#[test]
fn level_thighs_carry_the_weight_on_their_length() {
    let leg = Leg::new(&GEOMETRY, [0.0, 0.0], [0.0; 2]);
    let force = LegForce {
        push_n: 30.0,
        lean_nm: 0.0,
    };
    let [front_nm, rear_nm] = hip_torques_nm(&leg, force);
    assert!((front_nm + 1.8).abs() < 1e-4 && (rear_nm - 1.8).abs() < 1e-4);
}
