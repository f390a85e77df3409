use super::*;
use crate::{
    control::balance::{measured::Thigh, tilt::Tilt, virtual_leg::LegForce},
    domain::robots::FIVEBAR,
    kinematics::Leg,
    math::Quaternion,
};

const TICK_S: f32 = 0.001;

/// Upright on legs that carry their share of this specific force, while the body pitches at this rate.
fn measured(up_mps2: f32, pitch_rps: f32) -> Measured {
    let profile = &FIVEBAR.balance;
    let leg = Leg::new(&profile.legs, [-0.4, 0.4], [0.0; 2]);
    let push_n = 0.5 * profile.mass.carried_kg * up_mps2;
    let force = LegForce {
        push_n,
        lean_nm: 0.0,
    };
    Measured {
        tilt: Tilt::new(Quaternion::IDENTITY, [0.0, pitch_rps, 0.0]),
        legs: [leg; 2],
        lean_rad: [0.0; 2],
        lean_rps: [0.0; 2],
        wheel_rps: [0.0; 2],
        gear_rps: [0.0; 2],
        speed_mps: 0.0,
        ground_mps: 0.0,
        up_mps2,
        hip_nm: [virtual_leg::hip_torques_nm(&leg, force); 2],
        thighs: [[Thigh {
            rad: -0.4,
            rps: 0.0,
        }; 2]; 2],
        known: true,
    }
}

/// Whether the robot counts as flying at the end of 25 ms, during which its IMU feels 1.0 m/s² and its pitch gains this.
fn flies(pitch_rpss: f32) -> bool {
    let mass = &FIVEBAR.balance.mass;
    let mut contact = Contact::standing(mass, &measured(GRAVITY_MPS2, 0.0));
    for tick in 0..25 {
        let now = Measured {
            up_mps2: 1.0,
            ..measured(GRAVITY_MPS2, pitch_rpss * TICK_S * tick as f32)
        };
        contact.step(mass, &now, [0.0; 2], TICK_S);
    }
    contact.airborne()
}

#[test]
fn a_struck_body_does_not_fly_though_its_imu_falls() {
    let mass = &FIVEBAR.balance.mass;
    assert!(flies(0.0));
    assert!(!flies((GRAVITY_MPS2 - 1.0) / mass.imu_ahead_m));
}
