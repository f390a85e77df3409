//! Draws what the program on the serial link sends.

use robot_plant::world::{PcInput, PcJoints};

use super::rng::Rng;

/// Rest, at some rate. A program that does not count looks frozen.
pub fn rest(rng: &mut Rng) -> PcInput {
    PcInput {
        rate_hz: Some(rng.between(50.0, 1_000.0)),
        counts: Some(rng.chance(0.9)),
        ..PcInput::rest()
    }
}

/// Speeds, angles and gains, gentle ones and any that a frame carries.
pub fn motion(rng: &mut Rng) -> PcInput {
    let most_rps = rng.pick(&[2.0, 20.0, 200.0]).copied().unwrap_or_default();
    let wheels_rps = [0; 2].map(|_| rng.between(-most_rps, most_rps));
    let angles = [0; 4].map(|_| rng.between(-1.0, 1.0));
    let [wheel_kd, joint_kp, joint_kd] = [0; 3].map(|_| {
        let most = rng.pick(&[1.0, 50.0, 1_000.0]).copied();
        rng.between(0.0, most.unwrap_or_default())
    });
    let joints = [PcJoints::Limp, PcJoints::Hold, PcJoints::At(angles)];
    PcInput {
        on: Some(true),
        wheels_rps: Some(wheels_rps),
        wheel_kd: Some(wheel_kd),
        joints: rng.pick(&joints).copied(),
        joint_kp: Some(joint_kp),
        joint_kd: Some(joint_kd),
        ..PcInput::default()
    }
}
