//! A robot that lies on a side or its top stays there, however its legs swing within the limits of standing up
//! (docs/balance.md#from-a-side-or-the-top).

use robot_plant::free::{FreeBody, FreeInputs, FreeSetup, Start};

/// Limits of standing up: torque of a hip in N·m and its speed in rad/s.
const HIP_NM: f64 = 5.0;
const HIP_RPS: f64 = 10.0;
/// Thighs of front and rear above the level in rad: legs back, forward, long, short.
const POSES: [[f64; 2]; 4] = [[-1.33, 0.73], [0.73, -1.33], [-1.33, -1.33], [0.73, 0.73]];
const STEP_S: f64 = 250e-6;

/// The vertical part of the body's z axis: its largest value while the legs swing from one pose to another.
fn highest(start: &FreeBody, from: [f64; 2], to: [f64; 2]) -> f64 {
    let mut body = start.clone();
    let mut highest = -1.0_f64;
    for step in 0..4_000 {
        let pose = if step < 1_600 { from } else { to };
        let state = body.state();
        let mut inputs = FreeInputs {
            joint_dry_nm: 0.15,
            joint_viscous_nm_per_rps: 0.1,
            ..FreeInputs::default()
        };
        for (joint, (rad, rps)) in state.joint_rad.iter().zip(state.joint_rps).enumerate() {
            let (up, wanted_rad) = if joint % 2 == 0 {
                (1.0, pose[0])
            } else {
                (-1.0, pose[1])
            };
            let wanted_nm = 120.0 * (wanted_rad - up * rad) - 1.5 * up * rps;
            let too_fast = rps.abs() > HIP_RPS && wanted_nm * up * rps > 0.0;
            if !too_fast {
                inputs.joint_nm[joint] = up * wanted_nm.clamp(-HIP_NM, HIP_NM);
            }
        }
        body.step(&inputs, STEP_S);
        let [_, x, y, _] = body.state().attitude;
        highest = highest.max(1.0 - 2.0 * (x * x + y * y));
    }
    highest
}

fn highest_of_all(start: Start) -> f64 {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/fivebar.toml");
    let robot = robot_description::Robot::read(file.as_ref()).expect("a valid file");
    let setup = FreeSetup {
        start,
        ..FreeSetup::default()
    };
    let body = FreeBody::new(&robot, &setup);
    let pairs = POSES
        .iter()
        .flat_map(|from| POSES.map(|to| highest(&body, *from, to)));
    pairs.fold(-1.0, f64::max)
}

#[test]
fn a_robot_on_its_top_does_not_turn_over() {
    // Its edge is passed at some 45°, where this is −0.7.
    let highest = highest_of_all(Start::UpsideDown);
    assert!((-0.999..-0.8).contains(&highest), "{highest}");
}

#[test]
fn a_robot_on_its_side_does_not_come_up() {
    let highest = highest_of_all(Start::Left);
    assert!((-0.6..0.3).contains(&highest), "{highest}");
}
